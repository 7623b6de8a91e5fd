#include "silvasim/fields/feature_writer.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "silvasim/base/error.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/write_geopackage.h"
#include "silvasim/fields/write_text.h"

namespace silvasim::fields {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return text;
}

// The caller chose the names, so a wrong one is a mistake in the program.
void check(const PointLayer& layer) {
  std::set<std::string> names = {"fid", "geom", "x", "y"};
  if (layer.name.empty()) throw std::logic_error("a layer of points needs a name");
  for (const PointColumn& column : layer.columns) {
    if (column.name.empty() || !names.insert(lower(column.name)).second) {
      throw std::logic_error("a layer of points cannot have a column \"" + column.name + "\"");
    }
  }
}

void check(const PointLayer& layer, const PointBlock& block) {
  bool good = block.x.size() == block.y.size() && block.columns.size() == layer.columns.size();
  for (std::size_t i = 0; good && i < block.columns.size(); ++i) {
    const bool number = layer.columns[i].type == ColumnType::number;
    good = std::visit([&](const auto& values) { return values.size() == block.x.size(); }, block.columns[i]) &&
           number == std::holds_alternative<std::span<const double>>(block.columns[i]);
    if (!good || layer.columns[i].type != ColumnType::text) continue;
    const auto words = static_cast<std::int64_t>(layer.columns[i].words.size());
    for (const std::int32_t index : std::get<std::span<const std::int32_t>>(block.columns[i]))
      good = good && index >= -1 && index < words;
  }
  if (!good) throw std::logic_error("a block of points does not fit its layer's columns");
}

}  // namespace

void write_points(const std::filesystem::path& path, PointFormat format, const PointLayer& layer,
                  const std::function<std::optional<PointBlock>()>& next_block, std::size_t count,
                  const base::Progress& progress) {
  prepare_gdal();
  check(layer);
  std::size_t written = 0;
  const auto next = [&]() -> std::optional<PointBlock> {
    base::report(progress, "write", count ? std::min(1.0, double(written) / double(count)) : 0.0);
    std::optional<PointBlock> block = next_block();
    if (!block) return block;
    check(layer, *block);
    written += block->x.size();
    return block;
  };
  switch (format) {
    case PointFormat::geopackage:
      write_geopackage(path, layer, next);
      break;
    case PointFormat::geojson:
      write_geojson(path, layer, next);
      break;
    case PointFormat::csv:
      write_csv(path, layer, next);
      break;
  }
}

}  // namespace silvasim::fields
