#include "silvavis/commands/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/math.h"
#include "silvasim/base/parallel.h"
#include "silvavis/commands/cameras.h"
#include "silvavis/image/file.h"
#include "silvavis/image/tone.h"

namespace silvavis::commands {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

shade::Camera camera_for(const RenderOptions& options, const scene::Scene& scene) {
  shade::Camera camera;
  parse_size(options.size, camera.width, camera.height);
  if (!options.camera.empty()) {
    const shade::Camera named = camera_from(options.camera, scene);
    camera.eye = named.eye;
    camera.look_at = named.look_at;
    camera.fov_deg = named.fov_deg;
    return camera;
  }
  if (options.eye.empty()) {
    shade::FitOptions fit;
    fit.fov_deg = options.fov_deg;
    fit.width = camera.width;
    fit.height = camera.height;
    return shade::fitted_camera(scene_box(scene), fit);
  }
  camera.eye = world_point(scene, options.eye, "--eye");
  camera.look_at = world_point(scene, options.look_at, "--look-at");
  camera.fov_deg = options.fov_deg;
  return camera;
}

void check_camera(const RenderOptions& options) {
  shade::Camera camera;
  parse_size(options.size, camera.width, camera.height);
  if (options.eye.empty() != options.look_at.empty())
    silvasim::terminal::wrong_option("--eye and --look-at belong together");
}

shade::HazeOptions haze_for(const RenderOptions& options, const Stage& stage, const V3d& eye) {
  const shade::SceneBox box = scene_box(stage.scene);
  const silvasim::base::Box& ground = box.ground;
  shade::HazeOptions haze;
  for (int corner = 0; corner < 4; ++corner) {
    const V3d at(corner & 1 ? ground.east : ground.west, corner & 2 ? ground.north : ground.south, box.least_z_m);
    haze.clear_m = std::max(haze.clear_m, static_cast<float>((at - eye).length()));
  }
  if (options.haze) {
    haze.share = static_cast<float>(*options.haze);
    return haze;
  }
  // From outside the scene is a plan of the land and not what a traveller sees: as much haze as leaves its middle its colours.
  constexpr double most_taken = 0.025, none_within = 0.15, all_from = 0.4;  // the last two in sides of the scene
  const V3d nearest(std::clamp(eye.x, ground.west, ground.east), std::clamp(eye.y, ground.south, ground.north),
                    std::clamp(eye.z, box.least_z_m, box.greatest_z_m));
  const double side = std::max(ground.width(), ground.height());
  const double t = std::clamp(((eye - nearest).length() / side - none_within) / (all_from - none_within), 0.0, 1.0);
  const V3d middle((ground.west + ground.east) / 2, (ground.south + ground.north) / 2, box.least_z_m);
  const double depth =
      shade::haze_depth(options.stage.visibility_km, std::max(0.0, eye.z - box.least_z_m), 0, (eye - middle).length());
  const double clear = std::min(1.0, -std::log(1 - most_taken) / std::max(depth, 1e-9));
  haze.share = static_cast<float>(1 + (clear - 1) * t * t * (3 - 2 * t));
  return haze;
}

double metered_exposure(const Stage& stage, silvavis::RenderOptions settings) {
  constexpr int side_px = 64;
  const double shrink =
      std::min(1.0, static_cast<double>(side_px) / std::max(settings.camera.width, settings.camera.height));
  settings.camera.width = std::max(1, static_cast<int>(std::lround(settings.camera.width * shrink)));
  settings.camera.height = std::max(1, static_cast<int>(std::lround(settings.camera.height * shrink)));
  settings.samples = 2;
  settings.error = 0;
  settings.aovs = true;
  const image::Frame frame = silvavis::render(stage.scene, *stage.tracer, *stage.light, stage.land, settings);
  return image::automatic_exposure(image::land_of(frame));
}

// What was asked for stays; empty channels are not written.
void keep_asked(image::Frame& frame, const std::vector<std::string>& aovs) {
  const auto asked = [&](const char* name) { return std::find(aovs.begin(), aovs.end(), name) != aovs.end(); };
  if (!asked("depth")) frame.depth = {};
  if (!asked("normal")) frame.normal = {};
  if (!asked("species")) frame.species.clear();
  if (!asked("plant-id")) frame.plants.clear();
}

silvavis::RenderOptions settings_of(const RenderOptions& options) {
  silvavis::RenderOptions settings;
  settings.samples = options.samples;
  settings.error = options.error;
  if (options.exposure_stops)
    settings.brightening = silvasim::base::exp(0.5 * std::numbers::ln2 * *options.exposure_stops);
  settings.sky_rays = options.sky_rays;
  settings.sun_shadows = options.shadows;
  settings.lod = options.stage.lod == "auto";
  settings.aovs = !options.aovs.empty();
  settings.seed = options.stage.seed;
  return settings;
}

std::string place_text(const scene::Scene& scene, const V3d& p) {
  return fmt::format("{:.2f},{:.2f},{:.2f}", p.x + scene.origin.x, p.y + scene.origin.y, p.z);
}

std::map<std::string, std::string> metadata_of(const Stage& stage, const shade::Camera& camera) {
  return {{"Software", std::string("silvavis ") + SILVA_VERSION},
          {"silva:eye", place_text(stage.scene, camera.eye)},
          {"silva:look_at", place_text(stage.scene, camera.look_at)},
          {"silva:fov_deg", fmt::format("{}", camera.fov_deg)},
          {"silva:sun", fmt::format("{:.2f},{:.2f}", stage.sun.azimuth_deg, stage.sun.elevation_deg)}};
}

std::vector<V3d> eyes_of(const RenderOptions& options, const scene::Scene& scene) {
  const shade::Camera camera = camera_for(options, scene);
  shade::lens_of(camera);
  return {camera.eye};
}

void render(const RenderOptions& options) {
  const Common& common = options.stage.common;
  const silvasim::base::ThreadLimit threads(common.threads);
  check_camera(options);
  image::WriteOptions write;
  write.exposure_stops = options.exposure_stops;
  write.inputs = inputs_of(options.stage);
  if (!options.camera.empty()) write.inputs.push_back(camera_file(options.camera));
  image::check_writable(options.output, write);
  const silvasim::base::Progress progress = silvasim::terminal::console_progress(common);
  const std::unique_ptr<Stage> stage =
      set_stage(options.stage, progress, [&](const scene::Scene& bare) { return eyes_of(options, bare); });

  silvavis::RenderOptions settings = settings_of(options);
  settings.camera = camera_for(options, stage->scene);
  set_light(*stage, options.stage, settings.camera.eye.z, haze_for(options, *stage, settings.camera.eye));
  const auto begin = std::chrono::steady_clock::now();
  RenderStatistics statistics;
  image::Frame frame =
      silvavis::render(stage->scene, *stage->tracer, *stage->light, stage->land, settings, progress, &statistics);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  keep_asked(frame, options.aovs);
  if (!write.exposure_stops) write.exposure_stops = metered_exposure(*stage, settings);
  write.metadata = metadata_of(*stage, settings.camera);
  const std::size_t models = stage->scene.models.size(), tracer_bytes = stage->tracer->bytes();
  // Writing needs memory too, and plants no longer do.
  stage->tracer.reset();
  stage->scene.models.clear();
  image::write(options.output, frame, write);
  silvasim::terminal::end_progress(common);

  const double samples =
      static_cast<double>(statistics.eye_rays) / (static_cast<double>(settings.camera.width) * settings.camera.height);
  if (common.json) {
    const Stage::Seconds& s = stage->seconds;
    Json json;
    json["output"] = options.output.string();
    json["plants"] = stage->scene.plants;
    std::uint64_t details = 0;
    for (const scene::DetailLayer& layer : stage->scene.details) details += layer.count();
    json["details"] = details;
    json["models"] = models;
    json["eye"] = place_text(stage->scene, settings.camera.eye);
    json["look_at"] = place_text(stage->scene, settings.camera.look_at);
    json["fov_deg"] = settings.camera.fov_deg;
    json["size"] = {settings.camera.width, settings.camera.height};
    json["sun"] = {{"azimuth_deg", stage->sun.azimuth_deg}, {"elevation_deg", stage->sun.elevation_deg}};
    json["samples_a_pixel"] = samples;
    json["rays"] = {{"eye", statistics.eye_rays}, {"shadow", statistics.shadow_rays}};
    json["bytes"] = {{"plants", stage->scene.plant_bytes()},
                     {"tracer", tracer_bytes},
                     {"peak_rss", silvasim::base::peak_rss_bytes()}};
    json["seconds"] = {{"read", s.read},     {"models", s.models}, {"scene", s.scene}, {"details", s.details},
                       {"tracer", s.tracer}, {"light", s.light},   {"render", seconds}};
    json["threads"] = silvasim::base::thread_count();
    json["warnings"] = stage->warnings;
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  } else if (!common.quiet) {
    fmt::print(
        "{}: {} plants, {} x {} pixels, {:.1f} samples a pixel, sun {:.1f} degrees high in {:.0f} degrees; {:.2f} s, "
        "peak {}\n",
        options.output.string(), silvasim::terminal::grouped(stage->scene.plants), settings.camera.width,
        settings.camera.height, samples, stage->sun.elevation_deg, stage->sun.azimuth_deg, seconds,
        silvasim::terminal::bytes_text(silvasim::base::peak_rss_bytes()));
  }
}

}  // namespace silvavis::commands
