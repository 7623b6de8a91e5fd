// silvavis render: a picture of an ecosystem.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "silvavis/commands/stage.h"

namespace silvavis::commands {

struct RenderOptions {
  StageOptions stage;
  std::string camera;        // cameras.xml#name
  std::string eye, look_at;  // E,N,H; empty: the whole scene from the south
  double fov_deg = 50;
  std::string size = "1920x1080";
  int samples = 16;
  double error = 0.02;
  int sky_rays = 1;
  bool shadows = true;
  std::optional<double> haze;  // share of the air before the scene; none: haze_for()
  std::optional<double> exposure_stops;
  std::vector<std::string> aovs;  // depth, normal, species, plant-id
  Path output;
};

void render(const RenderOptions& options);

// What `fly` and `view` share with it: where from and how a picture is sampled, which channels are kept, and what is written beside its pixels.
// What can be known of camera_for()'s options without the scene.
void check_camera(const RenderOptions& options);
shade::Camera camera_for(const RenderOptions& options, const scene::Scene& scene);
// The same camera's eye alone, as set_stage() asks for; throws where no picture can be made with it.
std::vector<V3d> eyes_of(const RenderOptions& options, const scene::Scene& scene);
// As asked for; else all of the air, and less of it the farther outside of the scene the eye is.
shade::HazeOptions haze_for(const RenderOptions& options, const Stage& stage, const V3d& eye);
// Stops for what a camera sees, by the land and not by the sky: image::automatic_exposure() of a small picture.
double metered_exposure(const Stage& stage, silvavis::RenderOptions settings);
silvavis::RenderOptions settings_of(const RenderOptions& options);
void keep_asked(image::Frame& frame, const std::vector<std::string>& aovs);
std::map<std::string, std::string> metadata_of(const Stage& stage, const shade::Camera& camera);
std::string place_text(const scene::Scene& scene, const V3d& world);  // E,N,H

}  // namespace silvavis::commands
