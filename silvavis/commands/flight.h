// A flight as a function of time: where the eye is, and what it looks at.
//
// The eye follows a centripetal Catmull-Rom curve through the points, at constant speed, or as fast as the points' times ask
// (never backwards). Where all points count their heights from the ground it follows the ground's form, smoothed; elsewhere
// it is lifted where the ground would come nearer than `clearance_m`: smoothly, beginning about two seconds before.
// It looks as its points say, in smooth turns; where they say nothing, at the way ahead.
// Units: world space, seconds. Outside the terrain the ground is as at its nearest edge.
// Errors: base::ConfigError for more frames than most_frames. Threads: at() from any. Cost: 50 ms to make.
// Source: Yuksel, Schaefer and Keyser 2011 (centripetal); Fritsch and Carlson 1980 (times).
#pragma once

#include <vector>

#include "silvavis/commands/path.h"

namespace silvavis::commands {

struct FlightOptions {
  double fps = 25;
  double speed_m_s = 20;             // where neither times nor duration say otherwise
  std::optional<double> duration_s;  // instead
  double look_down_deg = 8;          // below the way ahead
  double clearance_m = 2;
};

class Flight {
 public:
  static constexpr int most_frames = 1'000'000;

  Flight(const FlightPath& path, const scene::Ground& ground, const FlightOptions& options);

  double fps() const { return options_.fps; }
  double duration_s() const { return duration_s_; }
  double length_m() const { return length_.back(); }
  int frames() const { return frames_; }  // the first at the first point, the last at the last one or just before

  struct View {
    V3d eye, look_at;
  };
  View at(double time_s) const;
  View frame(int number) const;  // 1 to frames()

 private:
  struct Key {
    double time_s = 0, length_m = 0;
  };
  double length_at(double time_s) const;
  V3d eye_at(double length_m) const;  // beyond the ends: straight on, or around

  void trace(const FlightPath& path, std::vector<std::size_t>& sample_of_point);
  void keep_off_the_ground(bool all_above_ground);
  void set_times(const FlightPath& path);
  void set_looks(const FlightPath& path);
  V3d look_ahead(double length_m) const;

  const scene::Ground& ground_;
  FlightOptions options_;
  bool closed_ = false;
  std::vector<V3d> way_;        // dense
  std::vector<double> length_;  // along it
  std::vector<Key> keys_;       // one a point
  std::vector<double> slope_;   // metres a second at the keys
  std::vector<V3d> looks_;      // at the keys: points to look at, or (heading, pitch, 0) in degrees; empty: ahead
  bool looks_are_points_ = false;
  double duration_s_ = 0;
  int frames_ = 0;
};

}  // namespace silvavis::commands
