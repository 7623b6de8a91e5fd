#include "ghosttile/cover/rasters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "silvasim/fields/terrain.h"

namespace ghosttile::cover {

namespace {

namespace config = silvasim::config;
namespace fields = silvasim::fields;
using silvasim::base::Box;

constexpr float no_data = std::numeric_limits<float>::quiet_NaN();

// Least, greatest and missing values of squares of cells, so that large boxes are quick.
class CellRanges {
 public:
  explicit CellRanges(const fields::Raster& raster) : across_(tiles(raster.columns)), raster_(raster) {
    ranges_.resize(static_cast<std::size_t>(across_) * static_cast<std::size_t>(tiles(raster.rows)));
    for (int row = 0; row < raster.rows; ++row) {
      for (int column = 0; column < raster.columns; ++column)
        add(at(column / side, row / side), raster.at(column, row));
    }
  }

  static SourceRange none() {
    return {{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()}, false};
  }

  // Of the cells in closed ranges of columns and rows.
  SourceRange of(int first_column, int last_column, int first_row, int last_row) const {
    SourceRange all = none();
    for (int row = first_row; row <= last_row; row = (row / side + 1) * side) {
      for (int column = first_column; column <= last_column; column = (column / side + 1) * side) {
        const int end_column = std::min((column / side + 1) * side - 1, last_column);
        const int end_row = std::min((row / side + 1) * side - 1, last_row);
        const bool whole =
            column % side == 0 && row % side == 0 && end_column - column == side - 1 && end_row - row == side - 1;
        if (whole) {
          const SourceRange& tile = ranges_[index(column / side, row / side)];
          all.known = {std::min(all.known.least, tile.known.least), std::max(all.known.most, tile.known.most)};
          all.missing = all.missing || tile.missing;
          continue;
        }
        for (int r = row; r <= end_row; ++r) {
          for (int c = column; c <= end_column; ++c) add(all, raster_.at(c, r));
        }
      }
    }
    return all;
  }

 private:
  static constexpr int side = 32;
  static int tiles(int cells) { return (cells + side - 1) / side; }
  static void add(SourceRange& range, float value) {
    if (!std::isfinite(value)) {
      range.missing = true;
      return;
    }
    range.known = {std::min(range.known.least, value), std::max(range.known.most, value)};
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(column);
  }
  SourceRange& at(int column, int row) { return ranges_[index(column, row)]; }

  struct Tile : SourceRange {
    Tile() : SourceRange(none()) {}
  };
  int across_;
  const fields::Raster& raster_;
  std::vector<Tile> ranges_;
};

class RasterSource final : public Source {
 public:
  RasterSource(std::shared_ptr<const fields::Raster> raster, config::FieldKind kind, config::NoDataPolicy policy,
               float fill)
      : raster_(std::move(raster)), kind_(kind), policy_(policy), fill_(fill), ranges_(*raster_) {}

  void sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const override {
    std::array<double, density::block_size> at_x, at_y;
    std::array<std::uint8_t, density::block_size> missing;
    const float otherwise = policy_ == config::NoDataPolicy::fill ? fill_ : no_data;
    for (std::size_t done = 0; done < count; done += density::block_size) {
      const std::size_t some = std::min(count - done, density::block_size);
      for (std::size_t i = 0; i < some; ++i) {
        at_x[i] = origin.x + static_cast<double>(x[done + i]);
        at_y[i] = origin.y + static_cast<double>(y[done + i]);
      }
      fields::sample(*raster_, kind_, {at_x.data(), some}, {at_y.data(), some}, {value + done, some},
                     {missing.data(), some});
      for (std::size_t i = 0; i < some; ++i) value[done + i] = missing[i] ? otherwise : value[done + i];
    }
  }

  SourceRange range(const Box& box) const override {
    // A hundredth of a cell for the rounding of coordinates, and the cells around, which are mixed in.
    const auto cells = [](double from, double to, int count) {
      const auto bound = [&](double cell) { return static_cast<int>(std::clamp(cell, 0.0, count - 1.0)); };
      return std::array<int, 2>{bound(std::floor(from - 0.51)), bound(std::floor(to + 0.51))};
    };
    const fields::Raster& r = *raster_;
    const double west = (box.west - r.west) / r.cell_width, east = (box.east - r.west) / r.cell_width;
    const double north = (r.north - box.north) / r.cell_height, south = (r.north - box.south) / r.cell_height;
    SourceRange found = CellRanges::none();
    found.missing = true;
    if (r.columns > 0 && r.rows > 0 && east > -0.01 && south > -0.01 && west < r.columns + 0.01 &&
        north < r.rows + 0.01) {
      const auto columns = cells(west, east, r.columns), rows = cells(north, south, r.rows);
      found = ranges_.of(columns[0], columns[1], rows[0], rows[1]);
      const bool beyond = west < 0.01 || north < 0.01 || east > r.columns - 0.01 || south > r.rows - 0.01;
      found.missing = found.missing || beyond;
      if (kind_ == config::FieldKind::value && found.known.least < found.known.most) {
        const float hair = 1e-6f * std::max(std::fabs(found.known.least), std::fabs(found.known.most));
        found.known = {found.known.least - hair, found.known.most + hair};
      }
    }
    if (policy_ == config::NoDataPolicy::fill && found.missing) {
      found = {{std::min(found.known.least, fill_), std::max(found.known.most, fill_)}, false};
    }
    return found;
  }

  float without_data() const override { return policy_ == config::NoDataPolicy::ignore ? 1.0f : 0.0f; }

 private:
  std::shared_ptr<const fields::Raster> raster_;
  config::FieldKind kind_;
  config::NoDataPolicy policy_;
  float fill_;
  CellRanges ranges_;
};

class Constant final : public Source {
 public:
  explicit Constant(float value) : value_(value) {}
  void sample(const V3d&, const float*, const float*, std::size_t count, float* value) const override {
    std::fill_n(value, count, value_);
  }
  SourceRange range(const Box&) const override { return {{value_, value_}, false}; }

 private:
  float value_;
};

}  // namespace

std::shared_ptr<const Source> field_source(std::shared_ptr<const fields::FieldSet> set, std::size_t index) {
  const fields::Field& field = set->fields[index];
  const std::shared_ptr<const fields::Raster> raster(set, &field.raster);
  return std::make_shared<RasterSource>(raster, field.kind, field.no_data, field.no_data_fill);
}

std::shared_ptr<const Source> ground_source(const silvasim::ecosystem::Terrain& terrain, GroundMeasure measure) {
  if (terrain.columns <= 0 || terrain.rows <= 0) return constant_source(0);
  auto raster = std::make_shared<fields::Raster>();
  raster->columns = terrain.columns;
  raster->rows = terrain.rows;
  raster->west = terrain.west;
  raster->north = terrain.north;
  raster->cell_width = terrain.cell_width_m;
  raster->cell_height = terrain.cell_height_m;
  raster->values = terrain.heights_m;
  switch (measure) {
    case GroundMeasure::elevation:
      break;
    case GroundMeasure::slope:
      *raster = fields::derive(config::TerrainMeasure::slope_deg, *raster);
      break;
    case GroundMeasure::northness:
      *raster = fields::derive(config::TerrainMeasure::northness, *raster);
      break;
    case GroundMeasure::eastness:
      *raster = fields::derive(config::TerrainMeasure::eastness, *raster);
      break;
  }
  return std::make_shared<RasterSource>(raster, config::FieldKind::value, config::NoDataPolicy::exclude, 0.0f);
}

std::shared_ptr<const Source> constant_source(float value) { return std::make_shared<Constant>(value); }

}  // namespace ghosttile::cover
