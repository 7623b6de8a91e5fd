// The standing plants in portions of about the same size, in the order of the ecosystem file, with all that exports say
// of each.
//
// Threads: one PlantRows may be asked from any number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/export/geographic.h"

namespace silvasim::exports {

struct PlantRow {
  std::uint64_t id = 0;  // running index of the site over its layer
  ecosystem::Plant plant;
  double z_m = 0;
  base::Point geographic;  // longitude, latitude; where the CRS is known
  double scale = 0;
  double height_m = 0;
};

class PlantRows {
 public:
  // Keeps a reference to the ecosystem.
  explicit PlantRows(const ecosystem::Ecosystem& ecosystem, bool with_geographic);

  std::size_t portions() const { return portions_.size(); }
  const ecosystem::Layer& layer_of(std::size_t portion) const { return ecosystem_.layers[portions_[portion].layer]; }
  std::size_t layer_index_of(std::size_t portion) const { return portions_[portion].layer; }
  bool has_geographic() const { return geographic_.known(); }
  bool has_probabilities() const;

  // Calls visit(PlantRow) for each plant of a portion.
  template <typename Visit>
  void for_each(std::size_t portion, Visit&& visit) const {
    const Portion& part = portions_[portion];
    const ecosystem::Layer& layer = ecosystem_.layers[part.layer];
    const auto columns = static_cast<std::size_t>(layer.tiling.columns);
    for (std::size_t position = part.first; position < part.last; ++position) {
      const auto& sites = layer.tile_set.tiles[layer.tiling.tiles[position]].sites;
      PlantRow row;
      row.plant.column = static_cast<int>(position % columns);
      row.plant.row = static_cast<int>(position / columns);
      const base::Point origin = ecosystem::tile_origin(layer, row.plant.column, row.plant.row);
      for (std::size_t s = 0; s < sites.size(); ++s) {
        row.id = offsets_[part.layer][position] + s;
        row.plant.species = layer.plants[row.id];
        if (row.plant.species == ecosystem::no_plant) continue;
        row.plant.site = static_cast<std::uint32_t>(s);
        row.plant.at = {origin.x + static_cast<double>(sites[s].x_m), origin.y + static_cast<double>(sites[s].y_m)};
        row.plant.radius_m = sites[s].radius_m;
        row.plant.probability =
            layer.probabilities.empty() ? 1.0f : static_cast<float>(layer.probabilities[row.id]) / 65535.0f;
        const ecosystem::Species& species = layer.species[row.plant.species];
        row.scale = static_cast<double>(row.plant.radius_m) / static_cast<double>(species.model_radius_m);
        row.height_m = static_cast<double>(species.height_m) * row.scale;
        row.z_m = ecosystem::height_at(ecosystem_.terrain, row.plant.at);
        if (geographic_.known()) row.geographic = geographic_.at(row.plant.at);
        visit(static_cast<const PlantRow&>(row));
      }
    }
  }

 private:
  struct Portion {
    std::size_t layer = 0, first = 0, last = 0;  // tile positions [first, last)
  };
  const ecosystem::Ecosystem& ecosystem_;
  std::vector<std::vector<std::uint64_t>> offsets_;
  std::vector<Portion> portions_;
  Geographic geographic_;
};

}  // namespace silvasim::exports
