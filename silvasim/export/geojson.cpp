// GeoJSON (RFC 7946) as text of our own: GDAL 3.6's writer does not notice a full disk.
#include <nlohmann/json.hpp>

#include "silvasim/export/formats.h"
#include "silvasim/export/number.h"
#include "silvasim/export/text_rows.h"

namespace silvasim::exports {

namespace {

// A text as JSON; bytes that are no UTF-8 become the replacement character.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// Before every plant but the very first stands a comma.
std::size_t first_with_plants(const PlantRows& rows) {
  for (std::size_t portion = 0; portion < rows.portions(); ++portion) {
    bool any = false;
    rows.for_each(portion, [&](const PlantRow&) { any = true; });
    if (any) return portion;
  }
  return rows.portions();
}

}  // namespace

void write_geojson(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
                   const base::Progress& progress) {
  const PlantRows rows(ecosystem, true);
  // The text that all plants of a species share.
  std::vector<std::vector<std::string>> names(ecosystem.layers.size());
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    for (const ecosystem::Species& species : ecosystem.layers[l].species) {
      const std::string common = species.common_name.empty() ? "null" : quoted(species.common_name);
      names[l].push_back(",\"layer\":" + quoted(ecosystem.layers[l].name) + ",\"species\":" + quoted(species.name) +
                         ",\"common_name\":" + common);
    }
  }
  const std::size_t first_portion = first_with_plants(rows);
  const auto text_of = [&](std::size_t portion, std::string& text) {
    const auto& names_here = names[rows.layer_index_of(portion)];
    const bool probability_here = !rows.layer_of(portion).probabilities.empty();
    const auto number = [&](const char* name, double value, int decimals) {
      text += name;
      append_fixed(text, value, decimals);
    };
    const auto whole = [&](const char* name, std::uint64_t value) {
      text += name;
      append(text, value);
    };
    bool first = portion == first_portion;
    rows.for_each(portion, [&](const PlantRow& row) {
      text += first ? "\n" : ",\n";
      first = false;
      whole("{\"type\":\"Feature\",\"properties\":{\"id\":", row.id);
      text += names_here[row.plant.species];
      if (std::isfinite(row.z_m)) number(",\"z_m\":", row.z_m, 2);
      number(",\"height_m\":", row.height_m, 3);
      number(",\"crown_radius_m\":", static_cast<double>(row.plant.radius_m), 3);
      number(",\"scale\":", row.scale, 4);
      if (probability_here) number(",\"probability\":", static_cast<double>(row.plant.probability), 5);
      whole(",\"tile_column\":", static_cast<std::uint64_t>(row.plant.column));
      whole(",\"tile_row\":", static_cast<std::uint64_t>(row.plant.row));
      whole(",\"site\":", row.plant.site);
      const bool degrees = rows.has_geographic();
      const base::Point at = degrees ? row.geographic : row.plant.at;
      if (std::isfinite(at.x) && std::isfinite(at.y)) {
        number("},\"geometry\":{\"type\":\"Point\",\"coordinates\":[", at.x, degrees ? 8 : 3);
        number(",", at.y, degrees ? 8 : 3);
        text += "]}}";
      } else {
        text += "},\"geometry\":null}";
      }
    });
  };
  write_text_rows(path, rows, "{\"type\":\"FeatureCollection\",\"name\":\"plants\",\"features\":[", text_of, "\n]}\n",
                  progress);
}

}  // namespace silvasim::exports
