// An ecosystem as files for other programs: one format a file, one table.
//
// Every format but the maps writes a row (or point) for each standing plant, in the order of the ecosystem file, with these columns:
//   id             running index of the plant's site over its layer's tile positions and their sites. It stays the same
//                  in every format and every run of the same seed and tiles, whether other plants stand or not; with
//                  the layer it names the plant.
//   layer, species (scientific name), common_name
//   x_m, y_m, z_m  stem in the scene's frame, and the ground's height there
//   longitude, latitude   degrees of WGS 84, where the frame has a place on the earth
//   height_m       the model's height times the scale
//   crown_radius_m the site's radius
//   scale          crown radius / the model's crown radius
//   probability    growth probability, where the ecosystem holds it
//   tile_column, tile_row, site   where the plant stands in the tiling, and its site's id in the tile
//
// Promise: same ecosystem, same bytes, whatever the threads.
// Errors: base::ConfigError for an unknown format and for maps that the ecosystem does not hold; base::Error where the file cannot be written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "silvasim/base/progress.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::exports {

struct Format {
  std::string name;
  std::vector<std::string> extensions;  // with the dot, the usual one first
  std::string help;                     // one line
  void (*write)(const ecosystem::Ecosystem&, const std::filesystem::path&, const base::Progress&);
  bool maps = false;  // of the place, not its plants: the ecosystem must hold them (SimulationOptions::probabilities)
};

const std::vector<Format>& formats();

// `format` empty: by the path's extension.
void export_to(const ecosystem::Ecosystem& ecosystem, const std::string& format, const std::filesystem::path& path,
               const base::Progress& progress = {});

// csv: RFC 4180 with "\n" and a header line. Cost: 1.3 million plants in 0.8 s on two cores (bench/outputs).
void write_csv(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
               const base::Progress& progress);

// gpkg: one layer "plants" in the scene's CRS with a style that QGIS applies by itself: crowns to scale, in the
// species' colours. geojson: RFC 7946, longitude and latitude; metres where the frame has no place on the earth. In
// all three, the geometry stands for x, y, longitude and latitude. fgb: as gpkg, without style, sorted by place.
void write_gpkg(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
                const base::Progress& progress);
void write_fgb(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
               const base::Progress& progress);
void write_geojson(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
                   const base::Progress& progress);

// tif: a GeoTIFF of the layers' SuitabilityMaps in the scene's CRS. A Float32 band a species, 0..1, NaN without sites, its
// description the species' name, with "layer: " in front where there are several layers. The layer of the smallest cells
// gives the grid; the cells of the others are repeated on it.
void write_tif(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
               const base::Progress& progress);

}  // namespace silvasim::exports
