// How the land of a picture looks: a picture draped over it, the colours of classes, plain grey; and where water is.
//
// A raster may have any CRS and resolution; one without a georeference is stretched over the scene. More than
// `most_drape_px` pixels are averaged (classes: thinned). Where a raster has no data, the land has its plain look.
// Colours of a picture are taken for reflectances, darkened to `drape_brightness`, because pictures of land hold the light
// of their own day.
// Errors: base::ConfigError for files that cannot be read, do not meet the scene, or hold no colours.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "silvavis/scene/scene.h"
#include "silvavis/shade/land.h"

namespace silvavis::commands {

struct LandOptions {
  std::optional<std::filesystem::path> drape, classes;  // one of the two at most
  std::optional<std::filesystem::path>
      class_colours;               // of `classes`, instead of the raster's palette: code,class,#rrggbb
  bool hillshade = false;          // plain grey
  std::vector<std::string> water;  // file, or file#layer
  double water_width_m = 2;        // of lines among the water
};

inline constexpr double most_drape_px = 32e6;
inline constexpr int most_water_side = 4096;

// Appends what a user should know to `warnings`.
shade::Land land_of(const LandOptions& options, const scene::Scene& scene, std::vector<std::string>& warnings);

// The files that it reads.
std::vector<std::filesystem::path> files_of(const LandOptions& options);

}  // namespace silvavis::commands
