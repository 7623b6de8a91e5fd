#include <fmt/format.h>

#include <limits>
#include <map>
#include <optional>

#include "silvasim/base/file.h"
#include "silvasim/base/parallel.h"
#include "silvasim/export/formats.h"
#include "silvasim/export/plant_rows.h"
#include "silvasim/export/qgis_style.h"
#include "silvasim/fields/feature_writer.h"

namespace silvasim::exports {

namespace {

using fields::ColumnType;

// The columns of one portion.
struct Columns {
  std::vector<double> x, y;
  std::vector<std::int64_t> id, layer, species, common, column, row, site;
  std::vector<double> z, height, radius, scale, probability;
};

class Source {
 public:
  explicit Source(const ecosystem::Ecosystem& ecosystem) : rows_(ecosystem, false) {
    fields::PointColumn layers{"layer", ColumnType::text}, species{"species", ColumnType::text},
        common{"common_name", ColumnType::text};
    for (const ecosystem::Layer& layer : ecosystem.layers) {
      first_word_.push_back(static_cast<std::int64_t>(species.words.size()));
      layers.words.push_back(layer.name);
      for (const ecosystem::Species& each : layer.species) {
        species.words.push_back(each.name);
        common.words.push_back(each.common_name);
      }
    }
    table_.crs_wkt = ecosystem.crs_wkt;
    const auto number = [](const char* name) { return fields::PointColumn{name, ColumnType::number}; };
    table_.columns = {fields::PointColumn{"id"}, layers,         species, common, number("z_m"), number("height_m"),
                      number("crown_radius_m"),  number("scale")};
    if (rows_.has_probabilities()) table_.columns.push_back(number("probability"));
    for (const char* name : {"tile_column", "tile_row", "site"}) table_.columns.push_back(fields::PointColumn{name});
  }

  fields::PointLayer& table() { return table_; }

  std::optional<fields::PointBlock> next() {
    // Make eight portions at a time in parallel, then hand them out one by one.
    if (given_ == ready_.size()) {
      const std::size_t count = std::min<std::size_t>(8, rows_.portions() - next_portion_);
      if (count == 0) return std::nullopt;
      ready_.assign(count, {});
      base::parallel_for(count, [&](std::size_t i) { fill(next_portion_ + i, ready_[i]); });
      next_portion_ += count;
      given_ = 0;
    }
    const Columns& c = ready_[given_++];
    fields::PointBlock block{c.x, c.y, {}};
    using Integers = std::span<const std::int64_t>;
    using Numbers = std::span<const double>;
    for (const auto* integers : {&c.id, &c.layer, &c.species, &c.common}) block.columns.push_back(Integers(*integers));
    for (const auto* numbers : {&c.z, &c.height, &c.radius, &c.scale}) block.columns.push_back(Numbers(*numbers));
    if (rows_.has_probabilities()) block.columns.push_back(Numbers(c.probability));
    for (const auto* integers : {&c.column, &c.row, &c.site}) block.columns.push_back(Integers(*integers));
    return block;
  }

 private:
  void fill(std::size_t portion, Columns& c) const {
    const auto layer = rows_.layer_index_of(portion);
    const bool probabilities = !rows_.layer_of(portion).probabilities.empty();
    rows_.for_each(portion, [&](const PlantRow& row) {
      c.x.push_back(row.plant.at.x);
      c.y.push_back(row.plant.at.y);
      c.id.push_back(static_cast<std::int64_t>(row.id));
      const std::int64_t word = first_word_[layer] + row.plant.species;
      c.layer.push_back(static_cast<std::int64_t>(layer));
      c.species.push_back(word);
      c.common.push_back(table_.columns[3].words[static_cast<std::size_t>(word)].empty() ? -1 : word);
      c.z.push_back(row.z_m);
      c.height.push_back(row.height_m);
      c.radius.push_back(static_cast<double>(row.plant.radius_m));
      c.scale.push_back(row.scale);
      c.probability.push_back(probabilities ? static_cast<double>(row.plant.probability)
                                            : std::numeric_limits<double>::quiet_NaN());
      c.column.push_back(row.plant.column);
      c.row.push_back(row.plant.row);
      c.site.push_back(row.plant.site);
    });
  }

  PlantRows rows_;
  std::vector<std::int64_t> first_word_;  // of each layer in the species' and common names' words
  fields::PointLayer table_;
  std::vector<Columns> ready_;
  std::size_t given_ = 0, next_portion_ = 0;
};

std::size_t plant_count(const ecosystem::Ecosystem& ecosystem) {
  std::size_t count = 0;
  for (const ecosystem::Layer& layer : ecosystem.layers) {
    for (const ecosystem::PlantId plant : layer.plants) count += plant != ecosystem::no_plant;
  }
  return count;
}

void write(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path, fields::PointFormat format,
           const base::Progress& progress) {
  Source source(ecosystem);
  if (format == fields::PointFormat::geopackage) source.table().style_qml = qgis_style(ecosystem);
  base::NewFile file(path);
  fields::write_points(
      file.path(), format, source.table(), [&] { return source.next(); }, plant_count(ecosystem), progress);
  file.commit();
}

}  // namespace

void write_gpkg(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
                const base::Progress& progress) {
  write(ecosystem, path, fields::PointFormat::geopackage, progress);
}

void write_fgb(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
               const base::Progress& progress) {
  write(ecosystem, path, fields::PointFormat::flatgeobuf, progress);
}

}  // namespace silvasim::exports
