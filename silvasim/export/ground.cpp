#include "silvasim/export/ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "silvasim/base/parallel.h"
#include "silvasim/export/spline.h"

namespace silvasim::exports {

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const Light paper = light_of(paper_colour);

// Lambert's light from the north-west and, weaker, from its neighbours and above, 1 on level ground.
float shade_of(float slope_east, float slope_north) {
  struct Lamp {
    float east, north, up, weight;  // unit vector towards the light
  };
  static constexpr std::array<Lamp, 5> lamps = {{
      {-0.5f, 0.5f, 0.70710678f, 0.52f},
      {-0.70710678f, 0, 0.70710678f, 0.14f},
      {0, 0.70710678f, 0.70710678f, 0.14f},
      {-0.5f, -0.5f, 0.70710678f, 0.08f},
      {0, 0, 1, 0.12f},
  }};
  const float length = std::sqrt(1 + slope_east * slope_east + slope_north * slope_north);
  float lit = 0, level = 0;
  for (const Lamp& lamp : lamps) {
    lit += lamp.weight * std::max(0.0f, (lamp.up - lamp.east * slope_east - lamp.north * slope_north) / length);
    level += lamp.weight * lamp.up;
  }
  return lit / level;
}

// Lowland, slopes, heights, summits: pale, so that plants stand out.
Light tint(float share) {
  static const std::array<Light, 4> controls = {light_of(0xE3E8D6), light_of(0xF1EBD8), light_of(0xE9DFD0),
                                                light_of(0xF6F4F0)};
  const float at = std::clamp(share, 0.0f, 1.0f) * 3;
  const std::size_t i = std::min<std::size_t>(2, static_cast<std::size_t>(at));
  return mix(controls[i], controls[i + 1], at - static_cast<float>(i));
}

}  // namespace

Ground::Ground(const ecosystem::Terrain& terrain, const View& view) {
  if (terrain.columns <= 0 || terrain.rows <= 0) return;
  // Average blocks of cells where cells are finer than pixels.
  const auto block = [](double pixel, double cell) {
    return static_cast<int>(std::clamp(std::floor(pixel / cell + 0.01), 1.0, 4096.0));
  };
  const int block_columns = block(view.box.width() / view.width_px, terrain.cell_width_m);
  const int block_rows = block(view.box.height() / view.height_px, terrain.cell_height_m);
  cell_width_ = terrain.cell_width_m * block_columns;
  cell_height_ = terrain.cell_height_m * block_rows;
  // Keep the blocks that the view touches, and three more around it for slopes and for spreading.
  const auto index = [](double cells, int count) {
    return static_cast<int>(std::clamp(std::floor(cells), 0.0, static_cast<double>(count)));
  };
  const int all_columns = (terrain.columns + block_columns - 1) / block_columns;
  const int all_rows = (terrain.rows + block_rows - 1) / block_rows;
  const int first_column = index((view.box.west - terrain.west) / cell_width_ - 3, all_columns);
  const int last_column = index((view.box.east - terrain.west) / cell_width_ + 4, all_columns);
  const int first_row = index((terrain.north - view.box.north) / cell_height_ - 3, all_rows);
  const int last_row = index((terrain.north - view.box.south) / cell_height_ + 4, all_rows);
  if (first_column >= last_column || first_row >= last_row) return;
  columns_ = last_column - first_column;
  rows_ = last_row - first_row;
  west_ = terrain.west + first_column * cell_width_;
  north_ = terrain.north - first_row * cell_height_;
  const auto columns = static_cast<std::size_t>(columns_);
  heights_.assign(columns * static_cast<std::size_t>(rows_), nan);
  base::parallel_for(static_cast<std::size_t>(rows_), [&](std::size_t j) {
    const int top = (first_row + static_cast<int>(j)) * block_rows, bottom = std::min(top + block_rows, terrain.rows);
    for (int i = 0; i < columns_; ++i) {
      const int left = (first_column + i) * block_columns, right = std::min(left + block_columns, terrain.columns);
      double sum = 0;
      int count = 0;
      for (int row = top; row < bottom; ++row) {
        const float* cells =
            terrain.heights_m.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(terrain.columns);
        for (int column = left; column < right; ++column) {
          if (!std::isfinite(cells[column])) continue;
          sum += static_cast<double>(cells[column]);
          ++count;
        }
      }
      if (count > 0) heights_[j * columns + static_cast<std::size_t>(i)] = static_cast<float>(sum / count);
    }
  });

  // Horn's slopes; a neighbour without data stands at the middle's height.
  const auto height = [&](int i, int j, float otherwise) {
    const float value = heights_[static_cast<std::size_t>(std::clamp(j, 0, rows_ - 1)) * columns +
                                 static_cast<std::size_t>(std::clamp(i, 0, columns_ - 1))];
    return std::isnan(value) ? otherwise : value;
  };
  std::vector<float> east(heights_.size(), 0), north(heights_.size(), 0);
  std::vector<double> squares(static_cast<std::size_t>(rows_), 0);
  std::vector<std::uint64_t> valid(static_cast<std::size_t>(rows_), 0);
  base::parallel_for(static_cast<std::size_t>(rows_), [&](std::size_t row) {
    const int j = static_cast<int>(row);
    for (int i = 0; i < columns_; ++i) {
      const std::size_t at = row * columns + static_cast<std::size_t>(i);
      const float middle = heights_[at];
      if (std::isnan(middle)) continue;
      const auto h = [&](int di, int dj) { return height(i + di, j + dj, middle); };
      // At the rim of the grid only half of the distance lies between the two sides.
      const float run_x = (columns_ == 1 || i == 0 || i == columns_ - 1) ? 4.0f : 8.0f;
      const float run_y = (rows_ == 1 || j == 0 || j == rows_ - 1) ? 4.0f : 8.0f;
      const float x = h(1, -1) + 2 * h(1, 0) + h(1, 1) - h(-1, -1) - 2 * h(-1, 0) - h(-1, 1);
      const float y = h(-1, -1) + 2 * h(0, -1) + h(1, -1) - h(-1, 1) - 2 * h(0, 1) - h(1, 1);
      east[at] = x / (run_x * static_cast<float>(cell_width_));
      north[at] = y / (run_y * static_cast<float>(cell_height_));
      squares[row] += static_cast<double>(east[at] * east[at] + north[at] * north[at]);
      ++valid[row];
    }
  });
  double square = 0;
  std::uint64_t count = 0;
  for (std::size_t j = 0; j < squares.size(); ++j) square += squares[j], count += valid[j];
  if (count == 0) {
    columns_ = rows_ = 0;
    return;
  }
  const double steepness = std::sqrt(square / static_cast<double>(count));
  const auto raised = static_cast<float>(steepness > 0 ? std::clamp(0.32 / steepness, 0.7, 6.0) : 1.0);
  shades_.assign(heights_.size(), nan);
  base::parallel_for(static_cast<std::size_t>(rows_), [&](std::size_t row) {
    for (std::size_t at = row * columns; at < (row + 1) * columns; ++at) {
      if (!std::isnan(heights_[at])) shades_[at] = shade_of(east[at] * raised, north[at] * raised);
    }
  });

  // Tint between the heights that leave out the lowest and highest hundredth; small relief keeps one tint.
  std::vector<float> sorted;
  const std::size_t stride = std::max<std::size_t>(1, heights_.size() / 65536);
  for (std::size_t i = 0; i < heights_.size(); i += stride) {
    if (!std::isnan(heights_[i])) sorted.push_back(heights_[i]);
  }
  if (sorted.empty()) sorted.push_back(0);
  std::sort(sorted.begin(), sorted.end());
  lowest_ = sorted[sorted.size() / 100];
  range_ = std::max(sorted[sorted.size() - 1 - sorted.size() / 100] - lowest_, 60.0f);
}

Ground::Sample Ground::at(double x, double y) const {
  if (columns_ == 0) return {paper, 1};
  // Cubic B-splines over 4 x 4 cells: smooth everywhere, a little softer than the cells.
  const double u = (x - west_) / cell_width_ - 0.5, v = (north_ - y) / cell_height_ - 0.5;
  if (!(u >= -0.5 && u <= columns_ - 0.5 && v >= -0.5 && v <= rows_ - 0.5)) return {paper, 1};
  const int i0 = static_cast<int>(std::floor(u)), j0 = static_cast<int>(std::floor(v));
  const auto a = cubic_spline(static_cast<float>(u - i0)), b = cubic_spline(static_cast<float>(v - j0));
  float shade = 0, height = 0, weight = 0;
  for (int dj = 0; dj < 4; ++dj) {
    const std::size_t row =
        static_cast<std::size_t>(std::clamp(j0 + dj - 1, 0, rows_ - 1)) * static_cast<std::size_t>(columns_);
    for (int di = 0; di < 4; ++di) {
      const std::size_t at = row + static_cast<std::size_t>(std::clamp(i0 + di - 1, 0, columns_ - 1));
      if (std::isnan(shades_[at])) continue;
      const float w = a[static_cast<std::size_t>(di)] * b[static_cast<std::size_t>(dj)];
      shade += w * shades_[at];
      height += w * heights_[at];
      weight += w;
    }
  }
  // The rim of land without data is where half of the weight has none; it fades over a part of a cell.
  const float known = std::clamp((weight - 0.5f) * 6 + 0.5f, 0.0f, 1.0f);
  if (known <= 0) return {paper, 1};
  shade /= weight;
  height /= weight;
  // Level ground leaves room for light; slopes towards it come near white, slopes away from it stay a warm grey.
  const float light = shade <= 1 ? 0.30f + 0.62f * shade : 0.92f + 0.30f * (shade - 1);
  const Light lit = tint((height - lowest_) / range_) * std::min(light, 1.0f);
  return {mix(paper, lit, known), 1 + (shade - 1) * known};
}

}  // namespace silvasim::exports
