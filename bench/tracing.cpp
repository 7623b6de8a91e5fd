// The nested trees beside one flat structure of Embree: memory, build and time, on the paper's scenes.
//
// tracing [--threads N] [--runs N] [--triangles N] [--scene NAME] [--way NAME] [--view NAME]: prints Markdown. Rays from the eye
// only, 1920 x 1080, one a pixel, as in the paper's Table 2 ("without shadows"); full models, and for the nested trees their
// simpler levels too. "Embree" asks ray by ray, "Embree, packets" sixteen rays of 4 x 4 pixels at once. Each way works in a
// process of its own, so that its peak of memory is its own; all see the same rays of the same scene in the same order.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cpu_clock.h"
#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvasim/config/load.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/pipeline.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/flora.h"
#include "silvavis/shade/camera.h"
#include "views.h"

namespace {

namespace fs = std::filesystem;
using namespace silvavis;

constexpr int width = 1920, height = 1080;

const std::vector<std::string> scenes{"unisb-3km", "puget-20km", "puget-40km"};
const std::vector<std::string> ways{"Embree", "Embree, packets", "nested", "nested, levels"};

struct Setup {
  int threads = 0, runs = 3, triangles = 160000;
  std::string scene, way, view;  // empty: all
};
using silva_bench::camera_of, silva_bench::views;

struct Figures {
  double models_s = 0, scene_s = 0, build_s = 0;
  double plant_mb = 0, model_mb = 0, peak_mb = 0;
  std::array<double, 3> seconds{};
  std::array<double, 3> cpu_s{};         // of all threads, least of the runs
  std::array<std::uint64_t, 3> check{};  // a sum over what the pixels see
  std::uint64_t plants = 0;
};

double seconds_since(std::chrono::steady_clock::time_point& mark) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - mark).count();
  mark = now;
  return seconds;
}

std::uint64_t trace(const scene::Scene& scene, const accel::Tracer& tracer, std::size_t view, bool lod) {
  const shade::Lens lens = shade::lens_of(camera_of(scene, view));
  constexpr int across = 16, down = 8;
  std::vector<std::uint64_t> sums(static_cast<std::size_t>(width / across) * (height / down));
  silvasim::base::parallel_for(sums.size(), [&](std::size_t i) {
    std::array<accel::Ray, across * down> rays;
    std::array<accel::Hit, across * down> hits;
    const int left = static_cast<int>(i) % (width / across) * across,
              top = static_cast<int>(i) / (width / across) * down;
    for (int k = 0; k < across * down; ++k) {
      // Squares of 4 x 4 pixels one after another.
      const int square = k / 16, x = left + square % 4 * 4 + k % 4, y = top + square / 4 * 4 + k % 16 / 4;
      const shade::CameraRay ray = shade::ray_through(lens, x + 0.5, y + 0.5);
      rays[static_cast<std::size_t>(k)].origin = ray.origin;
      rays[static_cast<std::size_t>(k)].direction = ray.direction;
      if (lod) rays[static_cast<std::size_t>(k)].spread = static_cast<float>(lens.footprint_rad);
    }
    tracer.nearest(rays, hits);
    for (const accel::Hit& hit : hits) {
      if (hit.surface == accel::Surface::plant)
        sums[i] += 1 + static_cast<std::uint64_t>(hit.site_slot + 131 * hit.column + 17 * hit.row);
    }
  });
  std::uint64_t sum = 0;
  for (const std::uint64_t part : sums) sum += part;
  return sum;
}

Figures measure(silvasim::ecosystem::Ecosystem ecosystem, const std::string& way, const Setup& setup) {
  Figures figures;
  auto mark = std::chrono::steady_clock::now();
  FloraOptions options;
  options.triangles = setup.triangles;
  options.variants = 1;
  options.levels = way == "nested, levels";
  Flora flora = models_of(ecosystem, options);
  figures.models_s = seconds_since(mark);
  const scene::Scene scene = scene::make_scene(std::move(ecosystem), flora.models);
  figures.scene_s = seconds_since(mark);
  const bool embree = way.starts_with("Embree");
  const auto tracer = embree
                          ? accel::make_embree(scene, way == "Embree" ? accel::Flat::instances : accel::Flat::packets)
                          : accel::make_nested(scene);
  figures.build_s = seconds_since(mark);
  figures.plants = scene.plants;
  figures.plant_mb = static_cast<double>(scene.plant_bytes()) / 1e6;
  for (const auto& model : scene.models) figures.model_mb += static_cast<double>(model->bytes()) / 1e6;
  if (embree) figures.plant_mb = static_cast<double>(tracer->bytes()) / 1e6;
  for (std::size_t view = 0; view < views.size(); ++view) {
    if (!setup.view.empty() && setup.view != views[view]) continue;
    std::vector<double> times;
    for (int run = 0; run < setup.runs; ++run) {
      seconds_since(mark);
      const double begin = silva_bench::cpu_seconds();
      figures.check[view] = trace(scene, *tracer, view, options.levels);
      times.push_back(seconds_since(mark));
      const double cpu_s = silva_bench::cpu_seconds() - begin;
      figures.cpu_s[view] = run == 0 ? cpu_s : std::min(figures.cpu_s[view], cpu_s);
    }
    std::sort(times.begin(), times.end());
    figures.seconds[view] = times[times.size() / 2];
  }
  figures.peak_mb = static_cast<double>(silvasim::base::peak_rss_bytes()) / 1e6;
  return figures;
}

// In a child process, whose figures come back through a pipe.
Figures measure_apart(const fs::path& file, const std::string& way, const Setup& setup) {
  int ends[2];
  if (pipe(ends) != 0) throw silvasim::base::Error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    const silvasim::base::ThreadLimit limit(setup.threads);
    const Figures figures = measure(silvasim::ecosystem::read(file), way, setup);
    const bool written = write(ends[1], &figures, sizeof figures) == static_cast<ssize_t>(sizeof figures);
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  Figures figures;
  const bool got = read(ends[0], &figures, sizeof figures) == static_cast<ssize_t>(sizeof figures);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!got || status != 0) throw silvasim::base::Error(way + " failed");
  return figures;
}

}  // namespace

int main(int argc, char** argv) {
  silvasim::base::give_back_large_blocks();
  Setup setup;
  CLI::App app("The nested trees beside one flat structure of Embree: memory, build and time");
  app.add_option("--threads", setup.threads, "0: all")->check(CLI::NonNegativeNumber);
  app.add_option("--runs", setup.runs, "of which the median counts")->check(CLI::PositiveNumber);
  app.add_option("--triangles", setup.triangles, "of a model")->check(CLI::PositiveNumber);
  app.add_option("--scene", setup.scene, "only this")->check(CLI::IsMember(scenes));
  app.add_option("--way", setup.way, "only this")->check(CLI::IsMember(ways));
  app.add_option("--view", setup.view, "only this")
      ->check(CLI::IsMember(std::vector<std::string>(views.begin(), views.end())));
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "Seconds a frame of {} x {}, one ray a pixel, median of {} runs (least CPU seconds); models of {} triangles.\n\n",
      width, height, setup.runs, setup.triangles);
  fmt::print("| scene | plants | way | models s | build s | plants MB | peak MB |");
  for (const char* view : views) fmt::print(" {} s |", view);
  fmt::print("\n|---|---|---|---|---|---|---|---|---|---|\n");
  const fs::path folder = fs::path(SILVA_SOURCE_DIR) / "bench" / "scenes";
  for (const std::string& name : scenes) {
    if (!setup.scene.empty() && setup.scene != name) continue;
    const fs::path file = fs::temp_directory_path() / ("silva-tracing-" + name + ".silva");
    try {
      // Grown in a child too, so that no thread lives when the others are forked.
      const pid_t child = fork();
      if (child == 0) {
        int code = 0;
        try {
          const auto scenario =
              silvasim::config::load_scenario(folder / (name + ".xml"), std::nullopt, silvasim::evaluators::dialect());
          silvasim::ecosystem::write(silvasim::simulate(scenario).ecosystem, file);
        } catch (const silvasim::base::Error& error) {
          fmt::print(stderr, "{}: {}\n", name, error.what());
          code = 1;
        }
        _exit(code);
      }
      int status = 0;
      waitpid(child, &status, 0);
      if (status != 0) continue;
      for (const std::string& way : ways) {
        if (!setup.way.empty() && setup.way != way) continue;
        const Figures f = measure_apart(file, way, setup);
        fmt::print("| {} | {} | {} | {:.2f} | {:.3f} | {:.1f} | {:.0f} |", name, f.plants, way, f.models_s,
                   f.scene_s + f.build_s, f.plant_mb, f.peak_mb);
        for (std::size_t view = 0; view < views.size(); ++view)
          fmt::print(" {:.2f} ({:.2f}) |", f.seconds[view], f.cpu_s[view]);
        fmt::print("\n");
        std::fflush(stdout);
      }
    } catch (const silvasim::base::Error& error) {
      fmt::print("| {} | skipped: {} |\n", name, error.what());
    }
    fs::remove(file);
  }
}
