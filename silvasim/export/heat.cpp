#include "silvasim/export/heat.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "silvasim/export/spline.h"
#include "silvasim/export/text.h"

namespace silvasim::exports {

namespace {

constexpr float unknown = -1;
constexpr int most_cells_filled = 16;  // how far a hole is filled from its rim

// Where so much of the weight is on cells where something grows runs the rim: low enough that a stream's line of cells
// stays whole, high enough that a single cell whose sites are all of the wrong size does not tear a hole.
constexpr float rim = 0.42f, rim_sharpness = 6;

std::size_t shown_in(const std::vector<SpeciesCount>& layer) {
  return static_cast<std::size_t>(std::count_if(layer.begin(), layer.end(), [](const auto& c) { return c.shown; }));
}

// Fills cells without a value from the mean of the eight around them, a ring at a time.
void fill_holes(std::vector<float>& cells, int columns, int rows) {
  const auto index = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  };
  for (int ring = 0; ring < most_cells_filled; ++ring) {
    std::vector<std::pair<std::size_t, float>> filled;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        if (cells[index(column, row)] >= 0) continue;
        float sum = 0;
        int count = 0;
        for (int j = std::max(0, row - 1); j <= std::min(rows - 1, row + 1); ++j) {
          for (int i = std::max(0, column - 1); i <= std::min(columns - 1, column + 1); ++i) {
            const float share = cells[index(i, j)];
            if (share < 0) continue;
            sum += share;
            ++count;
          }
        }
        if (count > 0) filled.emplace_back(index(column, row), sum / static_cast<float>(count));
      }
    }
    if (filled.empty()) return;
    for (const auto& [cell, share] : filled) cells[cell] = share;
  }
}

// The largest share of the shown species in each cell of a map.
std::vector<float> largest_shares(const ecosystem::SuitabilityMap& map, const std::vector<SpeciesCount>& species) {
  std::vector<float> largest(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows), unknown);
  for (std::size_t s = 0; s < species.size(); ++s) {
    if (!species[s].shown) continue;
    const std::uint8_t* const shares = map.of(s);
    for (std::size_t i = 0; i < largest.size(); ++i) {
      if (shares[i] == ecosystem::SuitabilityMap::no_site) continue;
      largest[i] = std::max(largest[i], static_cast<float>(shares[i]) / 254.0f);
    }
  }
  fill_holes(largest, map.columns, map.rows);
  return largest;
}

}  // namespace

Heat::Heat(const ecosystem::Ecosystem& ecosystem, const Census& census) {
  const ecosystem::SuitabilityMap* finest = nullptr;
  const auto shown = [&](std::size_t l) {
    return shown_in(census.layers[l]) > 0 && !ecosystem.layers[l].suitability.empty();
  };
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    const ecosystem::SuitabilityMap& map = ecosystem.layers[l].suitability;
    if (shown(l) && (!finest || map.cell_m < finest->cell_m)) finest = &map;
  }
  if (!finest) return;
  columns_ = finest->columns;
  rows_ = finest->rows;
  west_ = finest->west;
  north_ = finest->north;
  cell_m_ = finest->cell_m;
  shares_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), unknown);
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    if (!shown(l)) continue;
    const ecosystem::SuitabilityMap& map = ecosystem.layers[l].suitability;
    const std::vector<float> shares = largest_shares(map, census.layers[l]);
    std::size_t i = 0;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column, ++i) {
        const double u = (west_ + (column + 0.5) * cell_m_ - map.west) / map.cell_m;
        const double v = (map.north - north_ + (row + 0.5) * cell_m_) / map.cell_m;
        if (!(u >= 0 && v >= 0 && u < map.columns && v < map.rows)) continue;
        shares_[i] = std::max(
            shares_[i],
            shares[static_cast<std::size_t>(v) * static_cast<std::size_t>(map.columns) + static_cast<std::size_t>(u)]);
      }
    }
  }
}

Heat::Sample Heat::at(double x, double y) const {
  const double u = (x - west_) / cell_m_ - 0.5, v = (north_ - y) / cell_m_ - 0.5;
  if (!(u >= -0.5 && u <= columns_ - 0.5 && v >= -0.5 && v <= rows_ - 0.5)) return {};
  const int i0 = static_cast<int>(std::floor(u)), j0 = static_cast<int>(std::floor(v));
  const auto a = cubic_spline(static_cast<float>(u - i0)), b = cubic_spline(static_cast<float>(v - j0));
  float sum = 0, grows = 0, known = 0;
  for (int dj = 0; dj < 4; ++dj) {
    const std::size_t row =
        static_cast<std::size_t>(std::clamp(j0 + dj - 1, 0, rows_ - 1)) * static_cast<std::size_t>(columns_);
    for (int di = 0; di < 4; ++di) {
      const float share = shares_[row + static_cast<std::size_t>(std::clamp(i0 + di - 1, 0, columns_ - 1))];
      if (share < 0) continue;
      const float weight = a[static_cast<std::size_t>(di)] * b[static_cast<std::size_t>(dj)];
      known += weight;
      if (share <= 0) continue;
      grows += weight;
      sum += weight * share;
    }
  }
  if (grows <= 0) return {};
  return {sum / grows, std::clamp((grows / known - rim) * rim_sharpness + 0.5f, 0.0f, 1.0f)};
}

double mean_suitability(const ecosystem::SuitabilityMap& map, std::size_t species, const base::Box& box) {
  const std::uint8_t* const shares = map.of(species);
  // How much of a row or column of cells lies in the box.
  const auto overlap = [&](double low, double least, double most) {
    return std::max(0.0, std::min(low + map.cell_m, most) - std::max(low, least));
  };
  std::vector<double> widths;
  for (int column = 0; column < map.columns; ++column) {
    widths.push_back(overlap(map.west + column * map.cell_m, box.west, box.east));
  }
  double sum = 0, area = 0;
  for (int row = 0; row < map.rows; ++row) {
    const double height = overlap(map.north - (row + 1) * map.cell_m, box.south, box.north);
    if (height <= 0) continue;
    const std::uint8_t* const cells = shares + static_cast<std::size_t>(row) * widths.size();
    for (std::size_t column = 0; column < widths.size(); ++column) {
      if (cells[column] == ecosystem::SuitabilityMap::no_site) continue;
      sum += widths[column] * height * cells[column];
      area += widths[column] * height;
    }
  }
  return area > 0 ? sum / area / 254 : 0;
}

std::string heat_title(const ecosystem::Ecosystem& ecosystem, const Census& census, const PreviewOptions& options) {
  if (options.species.size() == 1) return "suitability for " + options.species.front();
  std::size_t shown = 0;
  std::string name;
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    for (std::size_t s = 0; s < ecosystem.layers[l].species.size(); ++s) {
      if (!census.layers[l][s].shown) continue;
      ++shown;
      name = ecosystem.layers[l].species[s].name;
    }
  }
  if (shown == 1) return "suitability for " + name;
  return fmt::format("suitability for the best suited of {} species", shown);
}

std::string heat_caption(const ecosystem::Ecosystem& ecosystem, const Census& census) {
  std::size_t shown = 0;
  std::vector<std::string> cells;
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    const std::size_t here = shown_in(census.layers[l]);
    shown += here;
    if (here == 0 || ecosystem.layers[l].suitability.empty()) continue;
    const std::string side = length(ecosystem.layers[l].suitability.cell_m);
    if (std::find(cells.begin(), cells.end(), side) == cells.end()) cells.push_back(side);
  }
  const std::string who = shown == 1 ? "a plant of this species" : "the species that the place suits best";
  return fmt::format(
      "Colour tells how likely {} would grow by the place alone, before neighbours compete, whatever stands there{}. "
      "On bare "
      "ground it cannot grow. Means over cells of {}.",
      who, shown == 1 ? "" : fmt::format(": the largest probability of {} species", shown), fmt::join(cells, " and "));
}

}  // namespace silvasim::exports
