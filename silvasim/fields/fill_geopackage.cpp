#include "silvasim/fields/fill_geopackage.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "silvasim/base/geometry.h"
#include "silvasim/fields/rtree_nodes.h"
#include "silvasim/fields/sqlite_file.h"

namespace silvasim::fields {

namespace {

static_assert(std::endian::native == std::endian::little, "the point's bytes below are written as they lie in memory");

// Points as the format stores them: a header ("GP", version 0, little-endian, no envelope, srs) and the point's WKB.
struct PointBytes {
  std::array<std::uint8_t, 29> bytes = {'G', 'P', 0, 1, 0, 0, 0, 0, 1, 1};

  void set(std::int32_t srs, double x, double y) {
    std::memcpy(bytes.data() + 4, &srs, 4);
    std::memcpy(bytes.data() + 13, &x, 8);
    std::memcpy(bytes.data() + 21, &y, 8);
  }
};

void set_column(SqliteRow& row, int place, const PointColumn& column, const PointBlock& block, std::size_t k,
                std::size_t i) {
  if (column.type == ColumnType::number) {
    const double value = std::get<std::span<const double>>(block.columns[k])[i];
    if (std::isfinite(value))
      row.set(place, value);
    else
      row.set_null(place);
    return;
  }
  const std::int32_t value = std::get<std::span<const std::int32_t>>(block.columns[k])[i];
  if (column.type == ColumnType::integer)
    row.set(place, std::int64_t{value});
  else if (value >= 0)
    row.set(place, std::string_view(column.words[static_cast<std::size_t>(value)]));
  else
    row.set_null(place);
}

// One statement inserts so many rows: a statement has costs of its own, and the table counts its ids once a statement.
constexpr std::size_t many_rows = 64;

// "(?1, ?2), (?3, ?4)"
std::string places(std::size_t rows, std::size_t columns) {
  std::string text;
  for (std::size_t place = 1; place <= rows * columns; ++place) {
    text += place % columns == 1 ? (place == 1 ? "(?" : ", (?") : ", ?";
    text += std::to_string(place);
    if (place % columns == 0) text += ")";
  }
  return text;
}

std::string insertion(const PointLayer& layer, std::size_t rows) {
  std::string names = "fid, geom";
  for (const PointColumn& column : layer.columns) names += ", " + sql_quoted(column.name);
  return "INSERT INTO " + sql_quoted(layer.name) + " (" + names + ") VALUES " + places(rows, layer.columns.size() + 2);
}

// Puts a whole tree into the tables behind SQLite's rtree.
void fill_index(SqliteFile& file, const PointLayer& layer, std::span<const double> x, std::span<const double> y) {
  const std::string name = "rtree_" + layer.name + "_geom";
  const auto node_bytes = static_cast<std::size_t>(
      file.number("SELECT length(data) FROM " + sql_quoted(name + "_node") + " WHERE nodeno = 1"));
  const RtreeNodes tree = rtree_nodes(x, y, node_bytes);
  SqliteRow node(file, "INSERT OR REPLACE INTO " + sql_quoted(name + "_node") + " VALUES (?1, ?2)");
  SqliteRow parent(file, "INSERT INTO " + sql_quoted(name + "_parent") + " VALUES (?1, ?2)");
  const std::size_t nodes = tree.data.size() / node_bytes;
  for (std::size_t k = 1; k <= nodes; ++k) {
    node.set(1, static_cast<std::int64_t>(k));
    node.set_bytes(2, tree.data.data() + (k - 1) * node_bytes, node_bytes);
    node.step();
    if (k == 1) continue;
    parent.set(1, static_cast<std::int64_t>(k));
    parent.set(2, tree.parent[k]);
    parent.step();
  }
  // Which node holds which row, many at once as above.
  std::vector<std::int64_t> pairs;
  for (std::size_t i = 0; i < tree.leaf.size(); ++i) {
    if (tree.leaf[i] != 0) pairs.insert(pairs.end(), {static_cast<std::int64_t>(i) + 1, tree.leaf[i]});
  }
  const std::string into = "INSERT INTO " + sql_quoted(name + "_rowid") + " VALUES ";
  SqliteRow one(file, into + places(1, 2)), many(file, into + places(many_rows, 2));
  for (std::size_t i = 0; i < pairs.size();) {
    const std::size_t numbers = pairs.size() - i >= 2 * many_rows ? 2 * many_rows : 2;
    SqliteRow& row = numbers == 2 ? one : many;
    for (std::size_t k = 0; k < numbers; ++k, ++i) row.set(static_cast<int>(k) + 1, pairs[i]);
    row.step();
  }
}

}  // namespace

void fill_geopackage(const std::filesystem::path& path, const PointLayer& layer,
                     const std::function<std::optional<PointBlock>()>& next_block) {
  SqliteFile file(path);
  std::string quoted_text = "'";
  for (const char c : layer.name) quoted_text += c == '\'' ? std::string("''") : std::string(1, c);
  quoted_text += "'";

  const auto srs = static_cast<std::int32_t>(
      file.number("SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = " + quoted_text));
  std::vector<double> all_x, all_y;
  base::Box box;
  std::int64_t count = 0;
  {
    SqliteRow one(file, insertion(layer, 1)), many(file, insertion(layer, many_rows));
    std::array<PointBytes, many_rows> points;
    while (const auto block = next_block()) {
      for (std::size_t i = 0; i < block->x.size();) {
        const std::size_t rows = block->x.size() - i >= many_rows ? many_rows : 1;
        SqliteRow& row = rows == 1 ? one : many;
        int place = 0;
        for (std::size_t k = 0; k < rows; ++k, ++i) {
          const double x = block->x[i], y = block->y[i];
          row.set(++place, ++count);
          if (std::isfinite(x) && std::isfinite(y)) {
            points[k].set(srs, x, y);
            row.set_bytes(++place, points[k].bytes.data(), points[k].bytes.size());
            box = {std::min(box.west, x), std::min(box.south, y), std::max(box.east, x), std::max(box.north, y)};
          } else {
            row.set_null(++place);
          }
          for (std::size_t c = 0; c < layer.columns.size(); ++c)
            set_column(row, ++place, layer.columns[c], *block, c, i);
        }
        row.step();
      }
      if (layer.spatial_index) {
        all_x.insert(all_x.end(), block->x.begin(), block->x.end());
        all_y.insert(all_y.end(), block->y.begin(), block->y.end());
      }
    }
    if (layer.spatial_index && box.west <= box.east) fill_index(file, layer, all_x, all_y);
    SqliteRow total(file, "UPDATE gpkg_ogr_contents SET feature_count = ?1 WHERE table_name = ?2");
    total.set(1, count);
    total.set(2, std::string_view(layer.name));
    total.step();
    if (box.west <= box.east) {
      SqliteRow extent(file,
                       "UPDATE gpkg_contents SET min_x = ?1, min_y = ?2, max_x = ?3, max_y = ?4 WHERE table_name = ?5");
      extent.set(1, box.west);
      extent.set(2, box.south);
      extent.set(3, box.east);
      extent.set(4, box.north);
      extent.set(5, std::string_view(layer.name));
      extent.step();
    }
  }
  file.close();
}

}  // namespace silvasim::fields
