#include "silvavis/shade/sky_rays.h"

#include <algorithm>
#include <cmath>

namespace silvavis::shade {

namespace {

constexpr float most_share = 0.5f;

// The place of `u` among growing sums, and how far it is between two of them.
template <std::size_t N>
std::size_t place(const std::array<float, N>& sums, float u, float& between) {
  const auto after = std::upper_bound(sums.begin() + 1, sums.end() - 1, u);
  const auto i = static_cast<std::size_t>(after - sums.begin()) - 1;
  between = std::clamp((u - sums[i]) / std::max(sums[i + 1] - sums[i], 1e-12f), 0.0f, 0.999999f);
  return i;
}

}  // namespace

SkyRays::SkyRays(const Sky& sky) {
  const V3& sun = sky.sun_direction();
  const float level = std::sqrt(sun.x * sun.x + sun.y * sun.y);
  if (level > 1e-6f) {
    level_x_ = sun.x / level;
    level_y_ = sun.y / level;
  }
  for (std::size_t i = 0; i <= rows_; ++i) {
    const float t = static_cast<float>(i) / rows_;
    edges_[i] = t * t;
  }
  // The sky's light in each cell, and the cell's size.
  constexpr int within = 2;  // places along each side of a cell
  std::array<std::array<float, columns_>, rows_> light{}, size{};
  float light_sum = 0;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      float sum = 0;
      for (int k = 0; k < within * within; ++k) {
        const float s = (static_cast<float>(k % within) + 0.5f) / within,
                    t = (static_cast<float>(k / within) + 0.5f) / within;
        const float z = edges_[row] + (edges_[row + 1] - edges_[row]) * t;
        const float x = (static_cast<float>(column) + s) / columns_, flat = std::sqrt(1 - z * z);
        const float ahead = 1 - 2 * x * x, beside = 2 * x * std::sqrt(1 - x * x);
        sum += luminance(sky.radiance(
            V3((ahead * level_x_ - beside * level_y_) * flat, (ahead * level_y_ + beside * level_x_) * flat, z)));
      }
      light[row][column] = sum / (within * within);
      const float from = static_cast<float>(column) / columns_, to = static_cast<float>(column + 1) / columns_;
      size[row][column] = (edges_[row + 1] - edges_[row]) * 4 * (std::asin(to) - std::asin(from));
      light_sum += light[row][column] * size[row][column];
    }
  }
  // Only what lies above the mean: the cosine finds the rest.
  const float mean = light_sum / (2 * pi);
  std::array<float, rows_> sums{};
  float all = 0;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      light[row][column] = std::max(0.0f, light[row][column] - mean) * size[row][column];
      sums[row] += light[row][column];
    }
    all += sums[row];
  }
  if (!(all > 0)) return;
  share_ = std::min(most_share, all / light_sum);
  for (std::size_t row = 0; row < rows_; ++row) {
    row_sums_[row + 1] = row_sums_[row] + sums[row] / all;
    const float height = edges_[row + 1] - edges_[row];
    for (std::size_t column = 0; column < columns_; ++column) {
      const float part = light[row][column] / std::max(sums[row], 1e-30f);
      column_sums_[row][column + 1] = column_sums_[row][column] + part;
      densities_[row][column] = light[row][column] / all / (height * (1.0f / columns_));
    }
  }
}

V3 SkyRays::towards(float u, float v) const {
  const bool left = v >= 0.5f;
  float s = 0, t = 0;
  const std::size_t row = place(row_sums_, u, t);
  const std::size_t column = place(column_sums_[row], left ? 2 * v - 1 : 2 * v, s);
  const float z = edges_[row] + (edges_[row + 1] - edges_[row]) * t;
  const float x = (static_cast<float>(column) + s) / columns_, flat = std::sqrt(1 - z * z);
  const float ahead = 1 - 2 * x * x, beside = (left ? 2 : -2) * x * std::sqrt(1 - x * x);
  return {(ahead * level_x_ - beside * level_y_) * flat, (ahead * level_y_ + beside * level_x_) * flat, z};
}

float SkyRays::density(const V3& d) const {
  if (d.z < 0) return 0;
  const float level = std::sqrt(d.x * d.x + d.y * d.y);
  const float ahead = level > 1e-6f ? (d.x * level_x_ + d.y * level_y_) / level : 1;
  const float x = std::sqrt(std::clamp((1 - ahead) * 0.5f, 0.0f, 1.0f));
  const auto row = std::min(static_cast<std::size_t>(std::sqrt(d.z) * rows_), rows_ - 1),
             column = std::min(static_cast<std::size_t>(x * columns_), columns_ - 1);
  // The column coordinate x is the sine of half the angle: d angle = 2 dx / sqrt(1 - x^2), on two sides.
  return densities_[row][column] * 0.25f * std::sqrt(1 - x * x);
}

}  // namespace silvavis::shade
