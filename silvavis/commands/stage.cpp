#include "silvavis/commands/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <numeric>

#include "ghosttile/fill/file.h"
#include "silvasim/base/error.h"
#include "silvasim/base/words.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/fields/field_set.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/commands/detail_files.h"
#include "silvavis/flora.h"
#include "silvavis/ground_details.h"

namespace silvavis::commands {

namespace {

using silvasim::terminal::wrong_option;

double seconds_since(std::chrono::steady_clock::time_point& mark) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - mark).count();
  mark = now;
  return seconds;
}

std::map<std::string, std::string> overrides(const std::vector<std::string>& given) {
  std::map<std::string, std::string> models;
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      wrong_option("--model \"" + text + "\" should read \"Scientific name=file\", \"...=grown\" or \"...=none\"");
    models[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return models;
}

shade::SunPosition sun_for(const StageOptions& options, const Stage& stage) {
  if (!options.sun_direction.empty()) return {options.sun_direction[0], options.sun_direction[1]};
  const shade::Moment moment = moment_of("--sun", options.sun);
  return shade::sun_position(moment, stage.longitude_deg, stage.latitude_deg);
}

// The scene as it is before plants have models: its frame and its ground. The plants' part of the file is left alone.
scene::Scene bare_scene(const silvasim::ecosystem::Ecosystem& ecosystem) {
  silvasim::ecosystem::Ecosystem bare;
  bare.crs_wkt = ecosystem.crs_wkt;
  bare.extent = ecosystem.extent;
  bare.terrain = ecosystem.terrain;
  return scene::make_scene(std::move(bare), {});
}

shade::Overhead overhead_of(const Stage& stage, const shade::Land& land) {
  return {stage.scene, *stage.tracer, land, scene_box(stage.scene).greatest_z_m + 10};
}

// Files that hold the same Ghost Tile have models of their own each: few have more than one.
void add_details(Stage& stage, const StageOptions& options, std::vector<ghosttile::fill::DetailsFile> files) {
  DetailOptions how;
  how.fades = how.levels = options.lod == "auto" && options.backend == "nested";
  const silvasim::base::Box& land = stage.scene.extent;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const Path& file = files.size() > options.details.size() ? (k == 0 ? options.ecosystem : options.details[k - 1])
                                                             : options.details[k];
    const std::string name = file.filename().string();
    const scene::DetailKind kind = add_detail_kind(stage.scene, *files[k].tile, how);
    stage.scene.details.push_back(detail_layer(stage.scene, kind, files[k].details, name, how));
    files[k] = {};
    const scene::DetailLayer& layer = stage.scene.details.back();
    if (layer.count() == 0) {
      stage.warnings.push_back("\"" + file.string() + "\" holds no details");
    } else if (layer.most.x < land.west || layer.least.x > land.east || layer.most.y < land.south ||
               layer.least.y > land.north) {
      stage.warnings.push_back(
          fmt::format("the details of \"{}\" lie outside of the ecosystem: they begin at {:.0f} east, {:.0f} north",
                      file.string(), layer.least.x + stage.scene.origin.x, layer.least.y + stage.scene.origin.y));
    }
  }
  scene::number_details(stage.scene);
}

double mean_height(const scene::Ground& ground) {
  double sum = 0;
  for (const float height : ground.heights_m) sum += static_cast<double>(height - ground.pyramid.origin_m);
  return sum / static_cast<double>(ground.heights_m.size());
}

}  // namespace

shade::Moment moment_of(const char* option, const std::string& text) {
  try {
    return shade::parse_moment(text.empty() ? default_sun : text);
  } catch (const silvasim::base::Error& error) {
    wrong_option(fmt::format("{} {}", option, error.what()));
  }
}

std::unique_ptr<Stage> set_stage(const StageOptions& options, const silvasim::base::Progress& progress,
                                 const Judge& judge) {
  auto stage = std::make_unique<Stage>();
  // What is wrong with the options is said before anyone waits for models.
  FloraOptions flora_options;
  flora_options.overrides = overrides(options.model);
  if (options.sun_direction.empty()) moment_of("--sun", options.sun);
  auto mark = std::chrono::steady_clock::now();
  if (options.details.size() > 254) wrong_option("--details was given more than 254 times");
  std::vector<ghosttile::fill::DetailsFile> details;
  const bool details_alone = options.ecosystem.extension() == ".details";
  if (details_alone) details.push_back(ghosttile::fill::read(options.ecosystem));
  silvasim::ecosystem::Ecosystem ecosystem =
      details_alone ? land_under(details[0]) : silvasim::ecosystem::read(options.ecosystem, progress);
  stage->seconds.read = seconds_since(mark);
  const silvasim::fields::FrameReport frame = silvasim::fields::report_frame({ecosystem.crs_wkt, "", ecosystem.extent});

  {
    const scene::Scene bare = bare_scene(ecosystem);
    std::vector<V3d> eyes = judge ? judge(bare) : std::vector<V3d>();
    for (V3d& eye : eyes) eye += V3d(bare.origin.x, bare.origin.y, 0);
    for (const Path& file : options.details)
      details.push_back(details_of(file, eyes, options.details_radius_m, progress));
    stage->land = land_of(options.land, bare, stage->warnings);
  }

  flora_options.folder = options.models ? *options.models : options.ecosystem.parent_path();
  flora_options.layers = options.layers;
  flora_options.triangles = options.triangles;
  flora_options.variants = options.variants;
  flora_options.seed = options.seed;
  flora_options.levels = options.lod == "auto" && options.backend == "nested";
  Flora flora = models_of(ecosystem, flora_options, progress);
  stage->warnings.insert(stage->warnings.begin(), flora.warnings.begin(), flora.warnings.end());
  stage->model_sources = std::move(flora.sources);
  stage->seconds.models = seconds_since(mark);

  stage->scene = scene::make_scene(std::move(ecosystem), flora.models);
  stage->scene.seed = options.seed;
  stage->seconds.scene = seconds_since(mark);
  add_details(*stage, options, std::move(details));
  stage->seconds.details = seconds_since(mark);
  stage->tracer = options.backend == "embree" ? accel::make_embree(stage->scene) : accel::make_nested(stage->scene);
  stage->seconds.tracer = seconds_since(mark);

  // Colours of classes are a map's, not the land's.
  stage->mapped = options.land.classes.has_value();
  const shade::Land plain;
  const shade::Overhead overhead = overhead_of(*stage, stage->mapped ? plain : stage->land);
  stage->albedo = shade::albedo_from_above(overhead, stage->albedo);
  stage->land_height_m = mean_height(stage->scene.ground);
  if (options.surroundings) {
    const std::vector<Rgb> usual = shade::usual_colours(overhead, stage->albedo);
    stage->usual_albedo = std::accumulate(usual.begin(), usual.end(), Rgb(0, 0, 0)) / static_cast<float>(usual.size());
    stage->land.around = shade::Surroundings(stage->scene.ground, stage->scene.extent,
                                             shade::border_colours(overhead, stage->albedo), usual);
  }

  // Land without a place on the earth lies in the middle of Europe.
  if (frame.centre) {
    stage->longitude_deg = frame.centre->longitude_deg;
    stage->latitude_deg = frame.centre->latitude_deg;
    stage->convergence_deg = frame.convergence_deg;
  }
  stage->sun = sun_for(options, *stage);
  set_light(*stage, options, static_cast<double>(stage->scene.ground.pyramid.origin_m));
  stage->seconds.light = seconds_since(mark);
  if (!options.common.quiet)
    for (const std::string& warning : stage->warnings)
      fmt::print(stderr, "silvavis: warning: {}\n", silvasim::base::printable(warning));
  return stage;
}

std::vector<Path> inputs_of(const StageOptions& options) {
  std::vector<Path> inputs{options.ecosystem};
  inputs.insert(inputs.end(), options.details.begin(), options.details.end());
  for (const Path& file : files_of(options.land)) inputs.push_back(file);
  return inputs;
}

void set_light(Stage& stage, const StageOptions& options, double eye_z_m, const shade::HazeOptions& haze) {
  shade::SkyOptions sky;
  sky.sun_direction = shade::sun_direction(stage.sun, stage.convergence_deg);
  sky.visibility_km = options.visibility_km;
  sky.ground_albedo = stage.albedo;
  // Above 49 km next to no air is left, and the sky knows none.
  sky.eye_height_m = std::clamp(eye_z_m - static_cast<double>(stage.scene.ground.pyramid.origin_m), 2.0, 49e3);
  sky.land_height_m = std::min(sky.eye_height_m, stage.land_height_m);
  stage.light = std::make_unique<Light>(sky, haze);
  // What the land sends back changes with the sun alone.
  if (!stage.sent_back || sky.sun_direction != stage.sent_back_sun) {
    const shade::Land plain;
    stage.sent_back = shade::sent_back(overhead_of(stage, stage.mapped ? plain : stage.land), stage.light->over_land,
                                       stage.usual_albedo);
    stage.sent_back_sun = sky.sun_direction;
    stage.land.around.show_as(stage.sent_back->views);
  }
  stage.light->among = stage.sent_back->among;
}

V3d world_point(const scene::Scene& scene, const std::string& text, const char* option) {
  double numbers[3];
  bool above_ground = false;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (int i = 0; i < 3; ++i) {
    if (i == 2 && at < end && *at == '+') {
      above_ground = true;
      ++at;
    }
    const auto [rest, error] = std::from_chars(at, end, numbers[i]);
    const bool last = i == 2;
    if (error != std::errc() || !std::isfinite(numbers[i]) || (last ? rest != end : rest == end || *rest != ','))
      wrong_option(fmt::format(
          "{} \"{}\" should be easting, northing and height, like 572000,5726500,640, or +12 for 12 m above the ground",
          option, text));
    at = rest + 1;
  }
  V3d point(numbers[0] - scene.origin.x, numbers[1] - scene.origin.y, numbers[2]);
  if (above_ground) point.z += scene::ground_at(scene.ground, point.x, point.y).height_m;
  return point;
}

shade::SceneBox scene_box(const scene::Scene& scene) {
  const scene::Pyramid &ground = scene.ground.pyramid, &land = scene.land.pyramid;
  shade::SceneBox box{scene.extent, static_cast<double>(ground.origin_m),
                      static_cast<double>(land.origin_m + 65535 * land.step_m)};
  for (const scene::PlantLayer& layer : scene.layers)
    if (!layer.pyramid.levels.empty())
      box.greatest_z_m =
          std::max(box.greatest_z_m, static_cast<double>(layer.pyramid.origin_m + 65535 * layer.pyramid.step_m));
  for (const scene::DetailLayer& layer : scene.details)
    if (!layer.nodes.empty()) box.greatest_z_m = std::max(box.greatest_z_m, layer.most.z);
  return box;
}

void parse_size(const std::string& text, int& width, int& height) {
  const char* const end = text.data() + text.size();
  const auto [cross, first] = std::from_chars(text.data(), end, width);
  const bool crossed = first == std::errc() && cross != end && (*cross == 'x' || *cross == 'X');
  const auto [rest, second] =
      crossed ? std::from_chars(cross + 1, end, height) : std::from_chars_result{end, std::errc::invalid_argument};
  if (second != std::errc() || rest != end || width < 1 || height < 1 || width > shade::most_side_px ||
      height > shade::most_side_px)
    wrong_option(fmt::format("--size \"{}\" should be width and height in pixels, like 1920x1080, at most {} each",
                             text, shade::most_side_px));
}

}  // namespace silvavis::commands
