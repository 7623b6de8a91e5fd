// What `render`, `fly` and `view` need before the first picture: the scene with its models, a tracer, the light of an hour.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/terminal/terminal.h"
#include "silvavis/accel/tracer.h"
#include "silvavis/commands/land.h"
#include "silvavis/render.h"
#include "silvavis/shade/camera.h"
#include "silvavis/shade/overhead.h"
#include "silvavis/shade/sun.h"

namespace silvavis::commands {

using Path = std::filesystem::path;
using silvasim::terminal::Common;

inline constexpr const char* default_sun = "2026-06-21T10:00";

struct StageOptions {
  Path ecosystem;
  std::vector<std::string> layers;  // only these; empty: all
  std::optional<Path> models;       // folder of the models that plants.xml names; default: the ecosystem file's
  std::vector<std::string> model;   // "Picea abies=spruce.glb", "...=grown", "...=none"
  std::vector<Path> details;        // ground detail: files (.details), or scenes (.xml) to be filled around the eyes
  double details_radius_m = 40;     // of what is filled around each eye
  int triangles = 40000;
  int variants = 2;
  std::string backend = "nested";     // nested | embree
  std::string lod = "auto";           // auto | off
  std::string sun;                    // a moment; empty: 21 June, 10:00
  std::vector<double> sun_direction;  // azimuth, elevation in degrees; empty: from the moment and the place
  double visibility_km = 60;
  bool surroundings = true;  // land around the scene; false: the bare plain
  LandOptions land;
  std::uint64_t seed = 1;
  Common common;
};

struct Stage {
  scene::Scene scene;
  std::unique_ptr<accel::Tracer> tracer;  // refers to the scene
  std::unique_ptr<Light> light;
  shade::Land land;
  shade::SunPosition sun;
  std::vector<std::vector<std::string>> model_sources;  // Flora::sources
  Rgb albedo{0.08f, 0.11f, 0.05f};                      // of the scene as a whole, for the sky above it
  Rgb usual_albedo{0.08f, 0.11f, 0.05f};                // of its gentle land
  std::optional<shade::SentBack> sent_back;             // under this sun:
  V3 sent_back_sun{0, 0, 0};
  bool mapped = false;       // the land shows a map of classes
  double land_height_m = 0;  // mean height of the land above its lowest point
  // For the sun: where the scene's middle is, and how its grid is turned.
  double longitude_deg = 10, latitude_deg = 50, convergence_deg = 0;
  std::vector<std::string> warnings;
  struct Seconds {
    double read = 0, models = 0, scene = 0, details = 0, tracer = 0, light = 0;
  } seconds;
};

// The moment that an option like --sun names; empty: default_sun. Errors: UsageError.
shade::Moment moment_of(const char* option, const std::string& text);

// Is shown the scene's frame and ground before anyone waits for models, and throws where a camera or a path does not go with
// them. There are no layers in the scene yet, and it is gone afterwards.
// Says where the eyes will be, in world space: details are filled around them.
using Judge = std::function<std::vector<V3d>(const scene::Scene& bare)>;

// Prints warnings to standard error. The stage stays where it is made: its tracer refers to it.
std::unique_ptr<Stage> set_stage(const StageOptions& options, const silvasim::base::Progress& progress,
                                 const Judge& judge = {});

// The light of `stage.sun` for an eye at that height above the sea: beyond the scene it sees the ground of a round earth, as
// far below as the scene's lowest point. set_stage() makes the light for an eye on that ground.
void set_light(Stage& stage, const StageOptions& options, double eye_z_m, const shade::HazeOptions& haze = {});

// Files that no output may replace.
std::vector<Path> inputs_of(const StageOptions& options);

// "E,N,H" in the scene's frame to world space; H above the sea, or with a plus sign above the ground there.
V3d world_point(const scene::Scene& scene, const std::string& text, const char* option);

// A box around ground and plants in world space.
shade::SceneBox scene_box(const scene::Scene& scene);

// "1920x1080"
void parse_size(const std::string& text, int& width, int& height);

}  // namespace silvavis::commands
