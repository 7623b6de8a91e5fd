// silvavis render: a picture of an ecosystem.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "silvavis/commands/stage.h"

namespace silvavis::commands {

struct RenderOptions {
  StageOptions stage;
  std::string eye, look_at;  // E,N,H; empty: the whole scene from the south
  double fov_deg = 50;
  std::string size = "1920x1080";
  int samples = 16;
  double error = 0.02;
  int sky_rays = 1;
  bool shadows = true;
  std::optional<double> exposure_stops;
  std::vector<std::string> aovs;  // depth, normal, species, plant-id
  Path output;
};

void render(const RenderOptions& options);

}  // namespace silvavis::commands
