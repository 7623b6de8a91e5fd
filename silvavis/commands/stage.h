// What `render`, `fly` and `view` need before the first picture: the scene with its models, a tracer, the light of an hour.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/terminal/terminal.h"
#include "silvavis/accel/tracer.h"
#include "silvavis/render.h"
#include "silvavis/shade/camera.h"
#include "silvavis/shade/sun.h"

namespace silvavis::commands {

using Path = std::filesystem::path;
using silvasim::terminal::Common;

struct StageOptions {
  Path ecosystem;
  std::vector<std::string> layers;  // only these; empty: all
  std::optional<Path> models;       // folder of the models that plants.xml names; default: the ecosystem file's
  std::vector<std::string> model;   // "Picea abies=spruce.glb", "...=grown", "...=none"
  int triangles = 40000;
  int variants = 2;
  std::string backend = "nested";     // nested | embree
  std::string sun;                    // a moment; empty: 21 June, 10:00
  std::vector<double> sun_direction;  // azimuth, elevation in degrees; empty: from the moment and the place
  double visibility_km = 60;
  std::uint64_t seed = 1;
  Common common;
};

struct Stage {
  scene::Scene scene;
  std::unique_ptr<accel::Tracer> tracer;  // refers to the scene
  std::unique_ptr<Light> light;
  shade::Land land;
  shade::SunPosition sun;
  std::vector<std::string> warnings;
  struct Seconds {
    double read = 0, models = 0, scene = 0, tracer = 0, light = 0;
  } seconds;
};

// Prints warnings to standard error. The stage stays where it is made: its tracer refers to it.
std::unique_ptr<Stage> set_stage(const StageOptions& options, const silvasim::base::Progress& progress);

// "E,N,H" in the scene's frame to world space; H above the sea, or with a plus sign above the ground there.
V3d world_point(const scene::Scene& scene, const std::string& text, const char* option);

// A box around ground and plants in world space.
shade::SceneBox scene_box(const scene::Scene& scene);

// "1920x1080"
void parse_size(const std::string& text, int& width, int& height);

}  // namespace silvavis::commands
