#include "silvasim/export/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "silvasim/base/error.h"

namespace silvasim::exports {

const std::vector<Format>& formats() {
  static const std::vector<Format> table = {
      {"csv", {".csv"}, "comma-separated values with a header line, for spreadsheets and R", &write_csv},
      {"gpkg",
       {".gpkg"},
       "GeoPackage with a point a plant; QGIS opens it with crowns in the species' colours",
       &write_gpkg},
      {"fgb",
       {".fgb"},
       "FlatGeobuf with a point a plant, for QGIS and web maps of millions of plants; written several times as "
       "fast as gpkg",
       &write_fgb},
      {"geojson", {".geojson", ".json"}, "GeoJSON (RFC 7946) with a point a plant, for web maps", &write_geojson},
      {"tif", {".tif", ".tiff"}, "GeoTIFF with a band a species: how well the place suits it", &write_tif, true},
  };
  return table;
}

void export_to(const ecosystem::Ecosystem& ecosystem, const std::string& format, const std::filesystem::path& path,
               const base::Progress& progress) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::vector<std::string> names;
  for (const Format& candidate : formats()) {
    const auto& known = candidate.extensions;
    const bool by_extension = format.empty() && std::find(known.begin(), known.end(), extension) != known.end();
    if (candidate.name == format || by_extension) return candidate.write(ecosystem, path, progress);
    names.push_back(candidate.name);
  }
  if (format.empty()) {
    throw base::ConfigError({"--to"}, fmt::format("the name \"{}\" does not tell the format; give one of {}",
                                                  path.filename().string(), fmt::join(names, ", ")));
  }
  std::string hint = base::did_you_mean(format, names);
  if (hint.empty()) hint = fmt::format("; give one of {}", fmt::join(names, ", "));
  throw base::ConfigError({"--to"}, fmt::format("there is no format \"{}\"{}", format, hint));
}

}  // namespace silvasim::exports
