#include "silvavis/scene/ground.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"

namespace silvavis::scene {

namespace {

constexpr float most_height_m = 100'000;  // beyond it floats do not keep centimetres

// Fills what has no data with the mean of its surroundings: each coarser grid holds the means of 2 x 2, and what is missing is
// taken from the next coarser one. Without any data at all: 0.
void fill_gaps(std::vector<float>& heights, int columns, int rows) {
  if (std::none_of(heights.begin(), heights.end(), [](float h) { return std::isnan(h); })) return;
  if (columns == 1 && rows == 1) {
    heights[0] = 0;
    return;
  }
  const int coarse_columns = (columns + 1) / 2, coarse_rows = (rows + 1) / 2;
  const auto index = [](int column, int row, int width) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  };
  std::vector<float> coarse(static_cast<std::size_t>(coarse_columns) * static_cast<std::size_t>(coarse_rows));
  for (int row = 0; row < coarse_rows; ++row) {
    for (int column = 0; column < coarse_columns; ++column) {
      float sum = 0;
      int count = 0;
      for (int j = row * 2; j < std::min(rows, row * 2 + 2); ++j) {
        for (int i = column * 2; i < std::min(columns, column * 2 + 2); ++i) {
          const float height = heights[index(i, j, columns)];
          if (std::isnan(height)) continue;
          sum += height;
          ++count;
        }
      }
      coarse[index(column, row, coarse_columns)] = count > 0 ? sum / static_cast<float>(count) : std::nanf("");
    }
  }
  fill_gaps(coarse, coarse_columns, coarse_rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      float& height = heights[index(column, row, columns)];
      if (std::isnan(height)) height = coarse[index(column / 2, row / 2, coarse_columns)];
    }
  }
}

}  // namespace

Ground make_ground(const silvasim::ecosystem::Terrain& terrain, const silvasim::base::Box& extent,
                   silvasim::base::Point origin) {
  Ground ground;
  if (terrain.columns <= 0 || terrain.rows <= 0) {
    ground.columns = ground.rows = 2;
    ground.west = extent.west - origin.x;
    ground.south = extent.south - origin.y;
    ground.cell_x_m = extent.width();
    ground.cell_y_m = extent.height();
    ground.heights_m.assign(4, 0.0f);
  } else {
    ground.columns = terrain.columns + 2;
    ground.rows = terrain.rows + 2;
    ground.cell_x_m = terrain.cell_width_m;
    ground.cell_y_m = terrain.cell_height_m;
    ground.west = terrain.west - 0.5 * terrain.cell_width_m - origin.x;
    ground.south = terrain.north - (terrain.rows + 0.5) * terrain.cell_height_m - origin.y;
    std::vector<float> heights = terrain.heights_m;
    fill_gaps(heights, terrain.columns, terrain.rows);
    ground.heights_m.resize(static_cast<std::size_t>(ground.columns) * static_cast<std::size_t>(ground.rows));
    for (int j = 0; j < ground.rows; ++j) {
      const int row = std::clamp(terrain.rows - j, 0, terrain.rows - 1);  // the file's row 0 is the northernmost
      for (int i = 0; i < ground.columns; ++i) {
        const int column = std::clamp(i - 1, 0, terrain.columns - 1);
        ground.heights_m[static_cast<std::size_t>(j) * static_cast<std::size_t>(ground.columns) +
                         static_cast<std::size_t>(i)] =
            heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(terrain.columns) +
                    static_cast<std::size_t>(column)];
      }
    }
  }
  const auto [least, most] = std::minmax_element(ground.heights_m.begin(), ground.heights_m.end());
  if (!(*least >= -most_height_m && *most <= most_height_m)) {
    throw silvasim::base::Error("the terrain's heights reach from " + std::to_string(*least) + " to " +
                                std::to_string(*most) + " m; at most " + std::to_string(most_height_m) +
                                " m can be drawn (was its no data value not declared?)");
  }
  ground.pyramid = make_pyramid(ground.columns - 1, ground.rows - 1, {*least, *most}, [&](int i, int j) {
    const auto [low, high] =
        std::minmax({ground.at(i, j), ground.at(i + 1, j), ground.at(i, j + 1), ground.at(i + 1, j + 1)});
    return HeightRange{low, high};
  });
  ground.pyramid.west = static_cast<float>(ground.west);
  ground.pyramid.south = static_cast<float>(ground.south);
  ground.pyramid.cell_x_m = static_cast<float>(ground.cell_x_m);
  ground.pyramid.cell_y_m = static_cast<float>(ground.cell_y_m);
  return ground;
}

GroundPoint ground_at(const Ground& ground, double x, double y) {
  const double u = std::clamp((x - ground.west) / ground.cell_x_m, 0.0, ground.columns - 1.0);
  const double v = std::clamp((y - ground.south) / ground.cell_y_m, 0.0, ground.rows - 1.0);
  const int i = std::min(static_cast<int>(u), ground.columns - 2), j = std::min(static_cast<int>(v), ground.rows - 2);
  const double s = u - i, t = v - j;
  const auto corner = [&](int di, int dj) { return static_cast<double>(ground.at(i + di, j + dj)); };
  const double south_west = corner(0, 0), north_east = corner(1, 1);
  // South-eastern triangle where s > t, north-western elsewhere.
  const double along_x = s > t ? corner(1, 0) - south_west : north_east - corner(0, 1);
  const double along_y = s > t ? north_east - corner(1, 0) : corner(0, 1) - south_west;
  return {south_west + s * along_x + t * along_y, along_x / ground.cell_x_m, along_y / ground.cell_y_m};
}

V3 ground_normal(const Ground& ground, double x, double y) {
  const double u = std::clamp((x - ground.west) / ground.cell_x_m, 0.0, ground.columns - 1.0);
  const double v = std::clamp((y - ground.south) / ground.cell_y_m, 0.0, ground.rows - 1.0);
  const int i = std::min(static_cast<int>(u), ground.columns - 2), j = std::min(static_cast<int>(v), ground.rows - 2);
  double slope_x = 0, slope_y = 0;
  for (int dj = 0; dj <= 1; ++dj) {
    for (int di = 0; di <= 1; ++di) {
      const int column = i + di, row = j + dj;
      const int w = std::max(column - 1, 0), e = std::min(column + 1, ground.columns - 1);
      const int s = std::max(row - 1, 0), n = std::min(row + 1, ground.rows - 1);
      const double weight = (di ? u - i : 1 - (u - i)) * (dj ? v - j : 1 - (v - j));
      slope_x += weight * static_cast<double>(ground.at(e, row) - ground.at(w, row)) / ((e - w) * ground.cell_x_m);
      slope_y +=
          weight * static_cast<double>(ground.at(column, n) - ground.at(column, s)) / ((n - s) * ground.cell_y_m);
    }
  }
  return V3(static_cast<float>(-slope_x), static_cast<float>(-slope_y), 1.0f).normalized();
}

}  // namespace silvavis::scene
