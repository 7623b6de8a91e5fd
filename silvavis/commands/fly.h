// silvavis fly: the frames of a flight, for a film.
//
// Each frame gets its name when it is whole. The stage is set once; all frames are shown with one exposure, which is taken
// from small pictures all along the flight, so that it is the same for every part of a flight that is spread over machines.
// Frame k has the noise of seed + k - 1: grain moves, plants do not.
#pragma once

#include <optional>
#include <string>

#include "silvavis/commands/render.h"

namespace silvavis::commands {

struct FlyOptions {
  RenderOptions picture;  // without its camera and output; fov_deg holds where the path says none
  Path path;
  std::string output;  // frames/%04d.png
  std::optional<double> fps, speed_m_s, duration_s, height_above_ground_m;
  bool fov_given = false;  // on the command line: then it goes before the path's
  double look_down_deg = 8;
  std::string frames;  // "1-250"; empty: all
  std::string sun_to;  // a moment: the sun moves from --sun to it
  bool overwrite = false, resume = false;
};

void fly(const FlyOptions& options);

// Names of frames: "frames/%04d.png" with numbers for %d. Errors: base::ConfigError that says how a pattern looks.
class FrameNames {
 public:
  explicit FrameNames(const std::string& pattern);
  Path operator()(int number) const;

 private:
  std::filesystem::path folder_;
  std::string before_, after_;
  std::size_t digits_ = 0;
};

}  // namespace silvavis::commands
