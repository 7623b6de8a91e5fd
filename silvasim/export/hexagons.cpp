#include "silvasim/export/hexagons.h"

#include <algorithm>
#include <cmath>

#include "silvasim/base/parallel.h"

namespace silvasim::exports {

namespace {

struct Sum {
  float area_px = 0, weighted_probability = 0;
};

}  // namespace

HexagonLayer gather(const ecosystem::Layer& layer, const std::vector<SpeciesCount>& counts,
                    const std::vector<std::uint64_t>& offsets, const View& view, double across_px) {
  const double pitch = across_px * 0.8660254037844386;  // from row to row
  const int columns = static_cast<int>(view.width_px / across_px) + 2;
  const int rows = static_cast<int>(view.height_px / pitch) + 2;
  const double hexagon_px = across_px * pitch;
  const auto species = layer.species.size();
  std::vector<std::vector<std::vector<Hexagon>>> found(static_cast<std::size_t>(rows));  // a row, a species
  constexpr int band_rows = 8;
  const auto bands = static_cast<std::size_t>((rows + band_rows - 1) / band_rows);
  base::parallel_for(bands, [&](std::size_t band) {
    const int first = static_cast<int>(band) * band_rows, last = std::min(first + band_rows, rows);
    std::vector<Sum> sums(static_cast<std::size_t>((last - first) * columns) * species);
    base::Box near = view.box;
    near.north = view.y_m((first - 1) * pitch);
    near.south = view.y_m(last * pitch);
    const double px_per_m = view.px_per_m();
    for_each_plant_near(layer, offsets, near, [&](const ecosystem::Plant& plant) {
      if (!counts[plant.species].shown || !view.box.contains(plant.at)) return;
      // The nearer of the closest centres in the rows above and below.
      const double x = view.x_px(plant.at.x), y = view.y_px(plant.at.y);
      const int upper = static_cast<int>(std::floor(y / pitch));
      int best_row = 0, best_column = 0;
      double least = 1e300;
      for (int row = upper; row <= upper + 1; ++row) {
        const double shift = (row & 1) ? 0.5 : 0.0;
        const double column = std::floor(x / across_px - shift + 0.5);
        const double dx = x - (column + shift) * across_px, dy = y - row * pitch;
        if (dx * dx + dy * dy >= least) continue;
        least = dx * dx + dy * dy;
        best_row = row;
        best_column = static_cast<int>(column);
      }
      // Odd rows begin half a hexagon to the east; what lies west of their first goes to it.
      best_column = std::clamp(best_column, 0, columns - 1);
      if (best_row < first || best_row >= last) return;
      Sum& sum = sums[static_cast<std::size_t>((best_row - first) * columns + best_column) * species + plant.species];
      const auto radius = static_cast<float>(static_cast<double>(plant.radius_m) * px_per_m);
      const float area = 3.14159265f * radius * radius;
      sum.area_px += area;
      sum.weighted_probability += area * plant.probability;
    });
    for (int row = first; row < last; ++row) {
      auto& of_row = found[static_cast<std::size_t>(row)];
      of_row.resize(species);
      for (int column = 0; column < columns; ++column) {
        const Sum* sum = sums.data() + static_cast<std::size_t>((row - first) * columns + column) * species;
        float total = 0;
        for (std::size_t s = 0; s < species; ++s) total += sum[s].area_px;
        if (total <= 0) continue;
        // Roberts' R2 sequence: numbers in [0,1) that differ from all their neighbours'.
        const double turn = column * 0.7548776662466927 + row * 0.5698402909980532;
        double left = (turn - std::floor(turn)) * static_cast<double>(total);
        std::size_t chosen = species;
        for (std::size_t s = 0; s < species; ++s) {
          if (sum[s].area_px <= 0) continue;
          chosen = s;
          left -= static_cast<double>(sum[s].area_px);
          if (left < 0) break;
        }
        of_row[chosen].push_back({static_cast<float>((column + ((row & 1) ? 0.5 : 0.0)) * across_px),
                                  static_cast<float>(row * pitch), total / static_cast<float>(hexagon_px),
                                  sum[chosen].weighted_probability / sum[chosen].area_px});
      }
    }
  });
  HexagonLayer result;
  result.species.resize(species);
  for (const auto& row : found) {
    for (std::size_t s = 0; s < species; ++s) {
      result.species[s].insert(result.species[s].end(), row[s].begin(), row[s].end());
    }
  }
  return result;
}

}  // namespace silvasim::exports
