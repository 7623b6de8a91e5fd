// What it costs to get a population out: the ecosystem file, maps, and files for other programs, for one of the scenes of
// Table 1. Baseline, in the same run: as many bytes written to the same disk and nothing else.
//
// outputs [--threads N] [--scene puget-10km|puget-20km|puget-40km]: prints Markdown. Writes into the folder for temporary
// files; of GeoJSON and CSV some gigabytes for the largest scene.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/base/parallel.h"
#include "silvasim/config/load.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/export/formats.h"
#include "silvasim/export/picture.h"
#include "silvasim/pipeline.h"

namespace {

namespace fs = std::filesystem;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double seconds_of_plain_bytes(const fs::path& path, std::uintmax_t bytes) {
  const std::vector<std::byte> piece(std::size_t{1} << 20, std::byte{0x5A});
  return seconds_of([&] {
    silvasim::base::NewFile file(path);
    for (std::uintmax_t left = bytes; left > 0;) {
      const std::size_t now = static_cast<std::size_t>(std::min<std::uintmax_t>(left, piece.size()));
      file.write(std::span(piece).first(now));
      left -= now;
    }
    file.commit();
  });
}

}  // namespace

int main(int argc, char** argv) {
  int threads = 0;
  std::string scene = "puget-20km";
  CLI::App app("How fast each output is written, beside plain bytes");
  app.add_option("--threads", threads, "0: all")->check(CLI::NonNegativeNumber);
  app.add_option("--scene", scene, "a file of bench/scenes, without .xml")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const silvasim::base::ThreadLimit limit(threads);
  const fs::path file = fs::path(SILVA_SOURCE_DIR) / "bench" / "scenes" / (scene + ".xml");
  const fs::path folder = fs::temp_directory_path() / "silva-outputs";
  fs::create_directories(folder);
  try {
    const auto scenario = silvasim::config::load_scenario(file, std::nullopt, silvasim::evaluators::dialect());
    const silvasim::ecosystem::Ecosystem grown = silvasim::simulate(scenario).ecosystem;
    std::uint64_t plants = 0;
    for (const auto plant : grown.layers[0].plants) plants += plant != silvasim::ecosystem::no_plant;
    fmt::print("{}, {} plants, {} threads.\n\n", scene, plants, silvasim::base::thread_count());
    fmt::print("| output | seconds | MB | plants a second | times the plain bytes |\n|---|---|---|---|---|\n");
    const auto row = [&](const std::string& name, const fs::path& path, const std::function<void()>& write) {
      const double seconds = seconds_of(write);
      const auto bytes = fs::file_size(path);
      fs::remove(path);
      const double plain = seconds_of_plain_bytes(path, bytes);
      fs::remove(path);
      fmt::print("| {} | {:.2f} | {:.1f} | {:.2g} M | {:.1f} |\n", name, seconds, static_cast<double>(bytes) / 1e6,
                 static_cast<double>(plants) / seconds / 1e6, seconds / plain);
      std::fflush(stdout);
    };
    const fs::path silva = folder / "f.silva";
    row("ecosystem file", silva, [&] { silvasim::ecosystem::write(grown, silva); });
    for (const char* const name : {"map.png", "map.svg"}) {
      row(name, folder / name, [&] { silvasim::exports::write_preview(grown, {}, folder / name); });
    }
    for (const auto& format : silvasim::exports::formats()) {
      if (format.name == "tif") continue;
      const fs::path path = folder / ("f" + format.extensions.front());
      row(format.name, path, [&] { format.write(grown, path, {}); });
    }
  } catch (const silvasim::base::Error& error) {
    fmt::print("skipped: {}\n", error.what());
  }
  fs::remove_all(folder);
}
