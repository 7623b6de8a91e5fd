// The paper's Table 1 on this machine: all six scenes, stage by stage, beside the paper's times.
//
// table1 [--threads N] [--runs N]: prints Markdown; each time is the median of the runs, 3 by default.
// The paper's machine: one thread of a Xeon E5520 of 2009.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>

#include "cpu_clock.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/config/load.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/pipeline.h"

namespace {

namespace fs = std::filesystem;

struct Scene {
  const char* file;
  const char* name;
  int evaluators;
  long paper_plants;
  double paper_s;
};

constexpr Scene scenes[] = {
    {"unisb-3km.xml", "UniSB 3 km", 7, 29003, 16},           {"unisb-6km.xml", "UniSB 6 km", 7, 113481, 42},
    {"unisb-9km.xml", "UniSB 9 km", 7, 252299, 89},          {"puget-10km.xml", "Puget Sound 10 km", 8, 323565, 16},
    {"puget-20km.xml", "Puget Sound 20 km", 8, 1262512, 60}, {"puget-40km.xml", "Puget Sound 40 km", 8, 4994147, 228}};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void measure(const Scene& scene, const fs::path& folder, int runs) {
  std::map<std::string, std::vector<double>> stages;
  unsigned long long plants = 0;
  const fs::path output = fs::temp_directory_path() / "silva-table1.silva";
  for (int run = 0; run < runs; ++run) {
    const double cpu = silva_bench::cpu_seconds();
    const auto start = std::chrono::steady_clock::now();
    const auto scenario =
        silvasim::config::load_scenario(folder / scene.file, std::nullopt, silvasim::evaluators::dialect());
    const silvasim::Simulation simulation = silvasim::simulate(scenario);
    const auto before = std::chrono::steady_clock::now();
    silvasim::ecosystem::write(simulation.ecosystem, output);
    stages["write"].push_back(seconds_since(before));
    stages["total"].push_back(seconds_since(start));
    stages["cpu"].push_back(silva_bench::cpu_seconds() - cpu);
    for (const auto& [stage, seconds] : simulation.report.seconds) stages[stage].push_back(seconds);
    plants = simulation.report.layers[0].plants;
  }
  fs::remove(output);
  const auto of = [&](const char* stage) { return median(stages[stage]); };
  fmt::print(
      "| {} | {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | **{:.2f}** | {:.2f} | {:g} |\n",
      scene.name, scene.evaluators, scene.paper_plants, plants, of("fields"), of("tiles") + of("tiling"),
      of("evaluate"), of("neighbours"), of("corners"), of("write"), of("total"), of("cpu"), scene.paper_s);
}

}  // namespace

int main(int argc, char** argv) {
  int threads = 0, runs = 3;
  CLI::App app("The paper's Table 1: how long each stage of a run takes");
  app.add_option("--threads", threads, "0: all")->check(CLI::NonNegativeNumber);
  app.add_option("--runs", runs, "of which the median counts")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const silvasim::base::ThreadLimit limit(threads);
  const fs::path folder = fs::path(SILVA_SOURCE_DIR) / "bench" / "scenes";
  fmt::print("Seconds, median of {} runs, {} threads.\n\n", runs, silvasim::base::thread_count());
  fmt::print(
      "| scene | evaluators | plants, paper | plants | fields | tiles | evaluate | neighbours | corners | write | "
      "total | CPU | paper |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Scene& scene : scenes) {
    try {
      measure(scene, folder, runs);
    } catch (const silvasim::base::Error& error) {
      fmt::print("| {} | skipped: {} |\n", scene.name, error.what());
    }
  }
}
