#include "silvasim/export/formats.h"
#include "silvasim/export/number.h"
#include "silvasim/export/text_rows.h"

namespace silvasim::exports {

namespace {

// In quotes where a comma, a quote or a line end would break the row.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

void write_csv(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
               const base::Progress& progress) {
  const PlantRows rows(ecosystem, true);
  const bool with_probability = rows.has_probabilities();
  // The text that all plants of a species share.
  std::vector<std::vector<std::string>> names(ecosystem.layers.size());
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    for (const ecosystem::Species& species : ecosystem.layers[l].species) {
      names[l].push_back("," + quoted(ecosystem.layers[l].name) + "," + quoted(species.name) + "," +
                         quoted(species.common_name) + ",");
    }
  }
  const auto text_of = [&](std::size_t portion, std::string& text) {
    const auto& names_here = names[rows.layer_index_of(portion)];
    const bool probability_here = !rows.layer_of(portion).probabilities.empty();
    const auto number = [&](double value, int decimals) {
      append_fixed(text, value, decimals);
      text += ',';
    };
    rows.for_each(portion, [&](const PlantRow& row) {
      append(text, row.id);
      text += names_here[row.plant.species];
      number(row.plant.at.x, 3);
      number(row.plant.at.y, 3);
      number(row.z_m, 2);
      if (rows.has_geographic()) {
        number(row.geographic.x, 8);
        number(row.geographic.y, 8);
      }
      number(row.height_m, 3);
      number(static_cast<double>(row.plant.radius_m), 3);
      number(row.scale, 4);
      if (with_probability) {
        if (probability_here) append_fixed(text, static_cast<double>(row.plant.probability), 5);
        text += ',';
      }
      append(text, static_cast<std::uint64_t>(row.plant.column));
      text += ',';
      append(text, static_cast<std::uint64_t>(row.plant.row));
      text += ',';
      append(text, std::uint64_t{row.plant.site});
      text += '\n';
    });
  };

  const std::string head = std::string("id,layer,species,common_name,x_m,y_m,z_m,") +
                           (rows.has_geographic() ? "longitude,latitude," : "") + "height_m,crown_radius_m,scale," +
                           (with_probability ? "probability," : "") + "tile_column,tile_row,site\n";
  write_text_rows(path, rows, head, text_of, "", progress);
}

}  // namespace silvasim::exports
