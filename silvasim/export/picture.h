// Quick looks: maps of an ecosystem that a planner pastes into a report, as PNG and as SVG.
//
// A map shows crowns to scale, discs in the species' colour, where a crown is a few pixels wide; farther out each pixel
// (PNG) mixes the colours of the crowns that cover it. An SVG holds circles up to `most_circles` plants in view and
// hexagons beyond, and its caption says so. Under the plants lies the relief. docs/quick-looks.md tells how to read
// them.
//
// Promise: same ecosystem and options, same bytes, whatever the threads. Counts in the legend are of stems in the view.
// Errors: base::ConfigError, its place the option's name, for what the user can mend (an unknown species, a box
//   beside the land, a width out of range, probabilities or suitability maps that the ecosystem does not hold); base::Error where a file
//   cannot be written.
// Threads: works in parallel inside.
// Cost: 1.3 million plants in 1600 pixels on two cores: PNG 0.57 s and 2.7 MB, SVG 0.67 s and 5.8 MB (bench/outputs).
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::exports {

enum class Subject {
  species,      // who stands where
  probability,  // the growth probability of the plants that stand
  suitability,  // how likely the shown species that suits a place best would grow there; no plants
};

struct PreviewOptions {
  int width_px = 1600;               // of the whole picture, 16 to 20,000; its height follows from the land's shape
  std::optional<base::Box> bbox;     // in the scene's frame; none: the ecosystem's extent
  std::vector<std::string> species;  // scientific or common names; empty: all
  Subject subject = Subject::species;
  bool decorated = true;               // false: the bare map, e.g. as a texture for the terrain
  std::string title;                   // empty: the ecosystem's name
  std::size_t most_circles = 200'000;  // SVG: more plants in view than this are aggregated
};

// Beside f.png come the world file f.pgw, which georeferences the whole image with its margins, and f.png.aux.xml with the
// CRS, as GDAL and QGIS read it.
void write_png(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, const std::filesystem::path& path);

// One group a species, named for Inkscape's layers and, by its id, for programs: "species-picea-abies".
void write_svg(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, const std::filesystem::path& path);

// The files that come beside a picture of that name.
std::vector<std::filesystem::path> files_beside(const std::filesystem::path& picture);

// By the name's extension, .png or .svg.
void write_preview(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options,
                   const std::filesystem::path& path);

}  // namespace silvasim::exports
