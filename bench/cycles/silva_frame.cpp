// SilvaVis's side of the comparison: one picture with one ray a pixel and one towards the sun, and what it cost.
//
// silva_frame FILE.silva OUT.exr [--view 0|1|2] [--backend nested|embree] [--lod auto|off] [--opaque] [--runs N] [--threads N], and
// scene_dump's options: renders the picture `runs` times, prints one JSON object. CPU seconds are those of the process, user
// and system; of the runs the least counts.
// --against CYCLES.exr holds the distances of what is seen against those of Cycles.
// silva_frame --show IN.exr OUT.jpg --exposure STOPS: a picture, halved in size, through SilvaVis's tone curve.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "cpu_clock.h"
#include "cycles/stage.h"
#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/image/file.h"
#include "silvavis/image/tone.h"
#include "views.h"

namespace {

namespace fs = std::filesystem;
using namespace silvavis;
using silva_bench::cpu_seconds;

image::Image halved(const image::Image& from) {
  image::Image image(from.width / 2, from.height / 2, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = 0.25f * (from.at(2 * x, 2 * y)[c] + from.at(2 * x + 1, 2 * y)[c] +
                                     from.at(2 * x, 2 * y + 1)[c] + from.at(2 * x + 1, 2 * y + 1)[c]);
  return image;
}

void show(const fs::path& from, const fs::path& to, double exposure_stops) {
  image::Frame frame;
  frame.colour = halved(image::read(from));
  image::WriteOptions options;
  options.exposure_stops = exposure_stops;
  options.jpeg_quality = 85;
  image::write(to, frame, options);
}

// The same model with whole leaves: what a renderer is asked for that cannot see holes.
std::shared_ptr<const scene::PlantModel> without_holes(const scene::PlantModel& model) {
  auto looks = std::make_shared<scene::Looks>(*model.looks);
  for (scene::Cutout& cutout : looks->cutouts) cutout.width = cutout.height = 0;
  auto whole = std::make_shared<scene::PlantModel>(model);
  whole->looks = std::move(looks);
  for (auto& level : whole->coarser) level = without_holes(*level);
  return whole;
}

// The share of pixels where two pictures see something at another distance: by more than 5 cm and 1/2000, which is more
// than floats lose at 40 km. The other's depths are along the axis, as renderers keep them.
double share_elsewhere(const image::Frame& frame, const fs::path& other, const shade::Camera& camera) {
  const image::Frame theirs = image::read_frame(other);
  if (theirs.depth.width != frame.depth.width || theirs.depth.height != frame.depth.height)
    throw silvasim::base::Error(other.string() + ": has no depth of this picture's size");
  const shade::Lens lens = shade::lens_of(camera);
  std::size_t elsewhere = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const V3 ray = shade::ray_through(lens, x + 0.5, y + 0.5).direction;
      const double ours = static_cast<double>(*frame.depth.at(x, y)) * lens.forward.dot(V3d(ray));
      const auto depth = static_cast<double>(*theirs.depth.at(x, y));
      if (!(ours < 1e9) && !(depth < 1e9)) continue;
      elsewhere += !(std::abs(ours - depth) < 0.05 + ours / 2000);
    }
  }
  return static_cast<double>(elsewhere) / (static_cast<double>(camera.width) * camera.height);
}

void measure(const commands::StageOptions& options, std::size_t view, int runs, bool opaque, const fs::path& output,
             const fs::path& other) {
  const auto stage = commands::set_stage(options, {});
  if (opaque) {
    for (auto& model : stage->scene.models) model = without_holes(*model);
    stage->tracer = options.backend == "embree" ? accel::make_embree(stage->scene) : accel::make_nested(stage->scene);
  }
  const double prepared_cpu_s = cpu_seconds();
  RenderOptions settings;
  settings.camera = silva_bench::camera_of(stage->scene, view);
  settings.samples = 1;
  settings.error = 0;
  settings.sky_rays = 0;
  settings.lod = options.lod == "auto";
  commands::set_light(*stage, options, settings.camera.eye.z);
  double least_cpu_s = 1e9, least_wall_s = 1e9;
  image::Frame frame;
  RenderStatistics statistics;
  for (int run = 0; run < runs; ++run) {
    const double cpu = cpu_seconds();
    const auto begin = std::chrono::steady_clock::now();
    statistics = {};
    frame = render(stage->scene, *stage->tracer, *stage->light, stage->land, settings, {}, &statistics);
    least_cpu_s = std::min(least_cpu_s, cpu_seconds() - cpu);
    least_wall_s =
        std::min(least_wall_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  const std::uint64_t peak = silvasim::base::peak_rss_bytes();
  image::write(output, frame);
  const auto& s = stage->seconds;
  nlohmann::ordered_json json{{"plants", stage->scene.plants},
                              {"frame_cpu_s", least_cpu_s},
                              {"frame_s", least_wall_s},
                              {"before_cpu_s", prepared_cpu_s},
                              {"read_s", s.read},
                              {"models_s", s.models},
                              {"build_s", s.scene + s.tracer},
                              {"light_s", s.light},
                              {"shadow_rays", statistics.shadow_rays},
                              {"exposure_stops", image::automatic_exposure(frame.colour)},
                              {"peak_mb", static_cast<double>(peak) / 1e6}};
  if (!other.empty()) {
    settings.aovs = true;
    frame = render(stage->scene, *stage->tracer, *stage->light, stage->land, settings);
    json["share_elsewhere"] = share_elsewhere(frame, other, settings.camera);
  }
  fmt::print("{}\n", json.dump());
}

}  // namespace

int main(int argc, char** argv) {
  silvasim::base::give_back_large_blocks();
  commands::StageOptions options = silva_bench::stage_options();
  fs::path input, output, other;
  std::size_t view = 0;
  int runs = 1, threads = 0;
  bool tone = false, opaque = false;
  double exposure_stops = 0;
  CLI::App app("Renders one picture as silvavis does, and tells what it cost.", "silva_frame");
  app.add_option("input", input, "The ecosystem file (.silva), or a picture with --show")->required();
  app.add_option("output", output, "The picture to write")->required();
  app.add_option("--view", view, "0 bird's eye, 1 flight, 2 close")->check(CLI::Range(0, 2));
  app.add_option("--backend", options.backend, "nested or embree")->check(CLI::IsMember({"nested", "embree"}));
  app.add_option("--lod", options.lod, "auto or off")->check(CLI::IsMember({"auto", "off"}));
  app.add_flag("--opaque", opaque, "Leaves without holes");
  app.add_option("--runs", runs, "Pictures; the least time counts (default: 1)")->check(CLI::Range(1, 100));
  app.add_option("--threads", threads, "Threads (default: one a core)");
  app.add_option("--against", other, "Picture with depths by in_cycles.py: also tell what is elsewhere in it");
  app.add_flag("--show", tone, "Only halve and tone-map a picture");
  app.add_option("--exposure", exposure_stops, "Stops, with --show");
  silva_bench::add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    const silvasim::base::ThreadLimit limit(threads);
    options.ecosystem = input;
    if (tone)
      show(input, output, exposure_stops);
    else
      measure(options, view, runs, opaque, output, other);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "silva_frame: error: %s\n", error.what());
    return 1;
  }
}
