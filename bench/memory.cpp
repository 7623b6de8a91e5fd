// Where the memory of a picture goes: what the process holds after each stage of `silvavis render`, and the most within it.
//
// memory FILE.silva [--triangles N] [--variants N] [--lod auto|off] [--threads N]: prints Markdown, in MB of 10^6 bytes. 1920 x 1080,
// bird's eye, one ray a pixel and one towards the sun. The stages are those of commands/stage.cpp, in the same order.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/fields/field_set.h"
#include "silvavis/accel/nested.h"
#include "silvavis/flora.h"
#include "silvavis/image/file.h"
#include "silvavis/render.h"
#include "views.h"

namespace {

namespace fs = std::filesystem;
using namespace silvavis;

double status_mb(const char* key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(key, 0) == 0) return std::stod(line.substr(std::strlen(key))) * 1024 / 1e6;
  return 0;
}

// Prints a line, and lets the system forget the peak so far.
void after(const char* stage) {
  fmt::print("| {} | {:.0f} | {:.0f} | {:.0f} |\n", stage, status_mb("VmRSS:"), status_mb("RssFile:"),
             status_mb("VmHWM:"));
  std::fflush(stdout);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double mb(std::size_t bytes) { return static_cast<double>(bytes) / 1e6; }

std::string text_of_models(const scene::Scene& scene) {
  std::size_t full = 0, coarser = 0, impostors = 0, looks = 0;
  for (const auto& model : scene.models) {
    full += model->bytes();
    for (const auto& level : model->coarser) coarser += level->bytes();
    if (model->impostor) impostors += model->impostor->bytes();
    looks += model->looks->bytes();
  }
  return fmt::format(
      "\nOf these {} models: {:.1f} full, {:.1f} coarser, {:.1f} impostors, {:.1f} textures; plants {:.1f}\n",
      scene.models.size(), mb(full - coarser - impostors), mb(coarser), mb(impostors), mb(looks),
      mb(scene.plant_bytes()));
}

void measure(const fs::path& file, const FloraOptions& flora_options, const fs::path& output) {
  fmt::print("| after | holds MB | of it files | most MB |\n|---|---|---|---|\n");
  after("start");
  silvasim::ecosystem::Ecosystem ecosystem = silvasim::ecosystem::read(file);
  silvasim::fields::report_frame({ecosystem.crs_wkt, "", ecosystem.extent});
  after("read");
  auto models_by_layer = models_of(ecosystem, flora_options).models;
  after("models");
  scene::Scene scene = scene::make_scene(std::move(ecosystem), models_by_layer);
  models_by_layer.clear();
  after("scene");
  auto tracer = accel::make_nested(scene);
  after("tracer");
  shade::SkyOptions sky;
  sky.sun_direction = V3(-0.54f, -0.54f, 0.64f).normalized();
  const Light light(sky);
  after("light");
  RenderOptions settings;
  settings.camera = silva_bench::camera_of(scene, 0);
  settings.samples = 1;
  settings.sky_rays = 0;
  settings.lod = flora_options.levels;
  const image::Frame frame = render(scene, *tracer, light, {}, settings);
  after("picture");
  const std::string models = text_of_models(scene);
  tracer.reset();
  scene.models.clear();
  image::write(output, frame);
  after("written");
  fmt::print("{}", models);
  fs::remove(output);
}

}  // namespace

int main(int argc, char** argv) {
  FloraOptions options;
  options.triangles = 160000;
  options.variants = 1;
  fs::path file, output = fs::temp_directory_path() / "silva-memory.png";
  std::string lod = "auto";
  int threads = 0;
  CLI::App app("Tells what the process holds after each stage of a picture.", "memory");
  app.add_option("input", file, "The ecosystem file (.silva)")->required();
  app.add_option("--triangles", options.triangles, "Triangles of a grown tree (default: 160000)");
  app.add_option("--variants", options.variants, "Grown models a species (default: 1)");
  app.add_option("--lod", lod, "auto or off")->check(CLI::IsMember({"auto", "off"}));
  app.add_option("--threads", threads, "Threads (default: one a core)");
  app.add_option("-o,--output", output, "Picture to write, and to remove again");
  CLI11_PARSE(app, argc, argv);
  options.levels = lod == "auto";
  silvasim::base::give_back_large_blocks();
  try {
    const silvasim::base::ThreadLimit limit(threads);
    measure(file, options, output);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "memory: error: %s\n", error.what());
    return 1;
  }
}
