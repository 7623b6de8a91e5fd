#include "silvavis/commands/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <numbers>
#include <span>

#include "silvasim/base/error.h"
#include "silvasim/base/words.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/fields/field_set.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/flora.h"
#include "silvavis/shade/surface.h"

namespace silvavis::commands {

namespace {

using silvasim::base::ConfigError;

[[noreturn]] void wrong(const std::string& message) { throw ConfigError({"command line", 0, 0}, message); }

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
      wrong("--model \"" + text + "\" should read \"Scientific name=file\", \"...=grown\" or \"...=none\"");
    models[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return models;
}

shade::SunPosition sun_for(const StageOptions& options, const Stage& stage) {
  if (!options.sun_direction.empty()) return {options.sun_direction[0], options.sun_direction[1]};
  const shade::Moment moment = shade::parse_moment(options.sun.empty() ? default_sun : options.sun);
  return shade::sun_position(moment, stage.longitude_deg, stage.latitude_deg);
}

// What land throws back as a whole, seen from aslant under a sun half up the sky, from all sides: with the shade that plants cast on
// themselves and on the ground, in rays that are spread evenly (Roberts 2018).
class Overhead {
 public:
  Overhead(const Stage& stage, const shade::Land& land)
      : stage_(stage), land_(land), top_m_(scene_box(stage.scene).greatest_z_m + 10) {}

  struct Seen {
    Rgb colour{0, 0, 0};  // as an albedo
    bool land = false;    // no: nothing is seen, or water
  };
  std::vector<Seen> at(const std::vector<silvasim::base::Point>& places) const {
    constexpr float from_sun = 0.85f, from_sky = 0.15f;  // of the light on level land
    constexpr float half_up = 0.70710678f;
    const auto share = [](std::size_t i, double step) {
      const double x = step * static_cast<double>(i);
      return static_cast<float>(x - std::floor(x));
    };
    const auto direction = [](float turn, float sine) {
      const float angle = 2 * std::numbers::pi_v<float> * turn, level = std::sqrt(std::max(0.0f, 1 - sine * sine));
      return V3(std::cos(angle) * level, std::sin(angle) * level, sine);
    };
    std::vector<accel::Ray> rays(places.size()), to_sun, to_sky;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const V3 up = direction(share(i, 0.7548777), half_up);
      const double ground_m = scene::ground_at(stage_.scene.ground, places[i].x, places[i].y).height_m;
      rays[i].origin =
          V3d(places[i].x, places[i].y, ground_m) + V3d(up) * ((top_m_ - ground_m) / static_cast<double>(half_up));
      rays[i].direction = -up;
    }
    std::vector<accel::Hit> hits(rays.size());
    stage_.tracer->nearest(rays, hits);
    std::vector<Seen> seen(rays.size());
    std::vector<Rgb> by_sun, by_sky;
    std::vector<std::size_t> askers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].surface == accel::Surface::none) continue;
      const shade::SurfacePoint point = shade::surface_at(stage_.scene, land_, rays[i], hits[i]);
      if (point.water) continue;
      seen[i].land = true;
      const auto ask = [&](const V3& towards, float light, std::vector<accel::Ray>& asked, std::vector<Rgb>& shares) {
        accel::Ray ray;
        const bool open = shade::ray_from(point, hits[i], towards, 0.01, ray);
        const float facing = point.normal.dot(towards);
        const Rgb& part = facing > 0 ? point.reflectance : point.transmittance;
        asked.push_back(ray);
        shares.push_back(open ? part * (light * std::abs(facing)) : Rgb(0, 0, 0));
      };
      ask(direction(share(i, 0.5698403), half_up), from_sun / half_up, to_sun, by_sun);
      // Evenly over the upper half of all directions: 1 / (2 pi) for each, of a light of 1 / pi.
      ask(direction(share(i, 0.8191725), share(i, 0.6710436)), 2 * from_sky, to_sky, by_sky);
      askers.push_back(i);
    }
    const auto add = [&](const std::vector<accel::Ray>& asked, const std::vector<Rgb>& shares) {
      std::vector<std::uint8_t> shaded(asked.size());
      stage_.tracer->occluded(asked, shaded);
      for (std::size_t k = 0; k < askers.size(); ++k)
        if (!shaded[k]) seen[askers[k]].colour += shares[k];
    };
    add(to_sun, by_sun);
    add(to_sky, by_sky);
    return seen;
  }

  // Their mean, or `otherwise` where none shows land.
  static Rgb mean(std::span<const Seen> seen, const Rgb& otherwise) {
    Rgb sum(0, 0, 0);
    float count = 0;
    for (const Seen& one : seen) {
      sum += one.colour;
      count += one.land ? 1.0f : 0.0f;
    }
    if (count <= 0) return otherwise;
    sum /= count;
    return Rgb(std::clamp(sum.x, 0.0f, 1.0f), std::clamp(sum.y, 0.0f, 1.0f), std::clamp(sum.z, 0.0f, 1.0f));
  }

 private:
  const Stage& stage_;
  const shade::Land& land_;
  double top_m_;
};

// On an even grid, for the light that the land sends back to the sky.
Rgb albedo_from_above(const Overhead& overhead, const silvasim::base::Box& box, const Rgb& otherwise) {
  constexpr int side = 48;
  std::vector<silvasim::base::Point> places;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      places.push_back({box.west + (column + 0.5) * box.width() / side, box.south + (row + 0.5) * box.height() / side});
  return Overhead::mean(overhead.at(places), otherwise);
}

// Along the planted border, in as many parts as the land around has: each from an even pattern (Roberts 2018) over a strip.
std::vector<Rgb> border_colours(const Overhead& overhead, const silvasim::base::Box& box, const Rgb& otherwise) {
  constexpr int parts = shade::Surroundings::parts, a_part = 40;
  constexpr double depth = 0.05;  // of the side
  std::vector<silvasim::base::Point> places;
  for (int i = 0; i < 4 * parts; ++i) {
    for (int k = 0; k < a_part; ++k) {
      const double along = (i % parts + (k + 0.5) / a_part) / parts;
      const double in = depth * (0.618034 * k - std::floor(0.618034 * k));
      const int side = i / parts;
      const double u = side == 0 ? along : side == 1 ? 1 - in : side == 2 ? 1 - along : in;
      const double v = side == 0 ? in : side == 1 ? along : side == 2 ? 1 - in : 1 - along;
      places.push_back({box.west + u * box.width(), box.south + v * box.height()});
    }
  }
  const std::vector<Overhead::Seen> seen = overhead.at(places);
  std::vector<Rgb> colours;
  for (std::size_t i = 0; i < seen.size(); i += a_part)
    colours.push_back(Overhead::mean(std::span(seen).subspan(i, a_part), otherwise));
  return colours;
}

double mean_height(const scene::Ground& ground) {
  double sum = 0;
  for (const float height : ground.heights_m) sum += static_cast<double>(height - ground.pyramid.origin_m);
  return sum / static_cast<double>(ground.heights_m.size());
}

}  // namespace

std::unique_ptr<Stage> set_stage(const StageOptions& options, const silvasim::base::Progress& progress) {
  auto stage = std::make_unique<Stage>();
  // What is wrong with the options is said before anyone waits for models.
  FloraOptions flora_options;
  flora_options.overrides = overrides(options.model);
  if (options.sun_direction.empty() && !options.sun.empty()) shade::parse_moment(options.sun);
  auto mark = std::chrono::steady_clock::now();
  silvasim::ecosystem::Ecosystem ecosystem = silvasim::ecosystem::read(options.ecosystem, progress);
  stage->seconds.read = seconds_since(mark);
  const silvasim::fields::FrameReport frame = silvasim::fields::report_frame({ecosystem.crs_wkt, "", ecosystem.extent});

  flora_options.folder = options.models ? *options.models : options.ecosystem.parent_path();
  flora_options.layers = options.layers;
  flora_options.triangles = options.triangles;
  flora_options.variants = options.variants;
  flora_options.seed = options.seed;
  flora_options.levels = options.lod == "auto" && options.backend == "nested";
  Flora flora = models_of(ecosystem, flora_options, progress);
  stage->warnings = std::move(flora.warnings);
  stage->model_sources = std::move(flora.sources);
  stage->seconds.models = seconds_since(mark);

  stage->scene = scene::make_scene(std::move(ecosystem), flora.models);
  stage->scene.seed = options.seed;
  stage->seconds.scene = seconds_since(mark);
  stage->tracer = options.backend == "embree" ? accel::make_embree(stage->scene) : accel::make_nested(stage->scene);
  stage->seconds.tracer = seconds_since(mark);

  stage->land = land_of(options.land, stage->scene, stage->warnings);

  // Colours of classes are a map's, not the land's.
  const shade::Land plain;
  const Overhead overhead(*stage, options.land.classes ? plain : stage->land);
  stage->albedo = albedo_from_above(overhead, stage->scene.extent, stage->albedo);
  stage->land_height_m = mean_height(stage->scene.ground);
  if (options.surroundings)
    stage->land.around =
        shade::Surroundings(stage->scene.ground, border_colours(overhead, stage->scene.extent, stage->albedo));

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
      wrong(fmt::format(
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
    wrong(fmt::format("--size \"{}\" should be width and height in pixels, like 1920x1080, at most {} each", text,
                      shade::most_side_px));
}

}  // namespace silvavis::commands
