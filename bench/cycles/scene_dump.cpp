// Writes what another renderer needs of an ecosystem: full models, ground, a table of plants, three cameras, the sun.
//
// scene_dump FILE.silva FOLDER [--triangles N] [--variants N] [--models FOLDER] [--sun AZIMUTH,ELEVATION] [--seed N]
#include <CLI/CLI.hpp>
#include <cstdio>

#include "cycles/dump.h"
#include "cycles/stage.h"
#include "silvasim/base/error.h"

int main(int argc, char** argv) {
  silvavis::commands::StageOptions options = silva_bench::stage_options();
  std::filesystem::path folder;
  CLI::App app("Writes an ecosystem's models, ground and plants for another renderer.", "scene_dump");
  app.add_option("ecosystem", options.ecosystem, "The ecosystem file (.silva)")->required();
  app.add_option("folder", folder, "Folder to write into; made where it is missing")->required();
  silva_bench::add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    const auto stage = silvavis::commands::set_stage(options, {});
    silva_bench::dump(stage->scene, *stage->light, stage->land, folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scene_dump: error: %s\n", error.what());
    return 1;
  }
}
