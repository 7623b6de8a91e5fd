// The options that scene_dump and silva_frame share, so that both see the same scene.
#pragma once

#include <CLI/CLI.hpp>

#include "silvavis/commands/stage.h"

namespace silva_bench {

// One model of 160,000 triangles a species, a sun 40 degrees high in the south-west that shows shadows, little haze.
inline silvavis::commands::StageOptions stage_options() {
  silvavis::commands::StageOptions options;
  options.triangles = 160000;
  options.variants = 1;
  options.sun_direction = {225, 40};
  options.visibility_km = 300;
  return options;
}

inline void add_options(CLI::App& app, silvavis::commands::StageOptions& options) {
  app.add_option("--triangles", options.triangles, "Triangles of a grown tree (default: 160000)")
      ->check(CLI::Range(1000, 2000000));
  app.add_option("--variants", options.variants, "Grown models a species (default: 1)")->check(CLI::Range(1, 64));
  app.add_option("--models", options.models, "Folder in which the models that plants.xml names lie");
  app.add_option("--sun", options.sun_direction, "AZIMUTH,ELEVATION in degrees (default: 225,40)")
      ->delimiter(',')
      ->expected(2);
  app.add_option("--seed", options.seed, "Of turns and grown plants (default: 1)");
}

}  // namespace silva_bench
