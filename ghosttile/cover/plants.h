// An ecosystem's standing plants, to ask which of them stand near a place.
//
// Nothing is stored a plant: the tiling is regular, so each Wang tile's sites are put into square cells once, and a question goes
// over tile positions, cells and sites. Memory: what the ecosystem itself holds (2 bytes a site) and 4 bytes a site of a tile.
// Units: metres, scene coordinates. Promise: plants come in one order, whatever box is asked for.
// Threads: immutable. Cost: about 10 ns a plant that is visited.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ghosttile/cover/habit.h"
#include "silvasim/base/geometry.h"
#include "silvasim/config/scenario.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace ghosttile::cover {

using silvasim::base::Box;
using silvasim::ecosystem::Ecosystem;

struct PlantSpecies {
  std::string name;
  std::size_t layer = 0;
  float height_per_radius = 1;  // a plant's height / its crown's radius
  float stem_per_height = 0;    // its stem's radius / its height
  Habit habit;
};

struct Stem {
  double x_m = 0, y_m = 0;
  float radius_m = 0;         // of the crown
  std::uint32_t species = 0;  // into Plants::species()
};

// Some of the species, and where they stand.
struct Selection {
  struct Layer {
    float most_radius_m = 0;        // the widest crown; 0: none stands
    std::vector<bool> occupied;     // by tile position
    std::uint64_t most_plants = 0;  // in one tile position
    double most_basal_area_m2 = 0;  // in one tile position
  };
  std::vector<bool> species;  // by Plants::species()
  std::vector<Layer> layers;
};

class Plants {
 public:
  // Radii of stems where no scenario tells them. The demo flora's stems (configs/demo/plants.xml, after yield tables) are 0.008 to
  // 0.012 of the height; the upper end stands for the wider foot, which is what details must keep clear of.
  static constexpr float usual_stem_per_height = 0.012f;

  // `scenario`: what the ecosystem was made from, for the radii of stems; may be null.
  explicit Plants(std::shared_ptr<const Ecosystem> ecosystem, const silvasim::config::Scenario* scenario = nullptr);

  const Ecosystem& ecosystem() const { return *ecosystem_; }
  std::size_t layer_count() const { return layers_.size(); }
  const std::vector<PlantSpecies>& species() const { return species_; }  // of all layers, layer by layer

  float height_m(const Stem& stem) const { return stem.radius_m * species_[stem.species].height_per_radius; }
  float stem_radius_m(const Stem& stem) const { return height_m(stem) * species_[stem.species].stem_per_height; }

  // Goes over all plants once.
  Selection select(std::vector<bool> species) const;

  // Calls visit(Stem) for each selected plant of a layer whose stem is in the closed box, until it returns false. Returns whether
  // it never did.
  template <typename Visit>
  bool for_each(std::size_t layer, const Box& box, const Selection& selection, Visit&& visit) const;

  // Whether a selected plant of the layer stands in the box. Quick for large boxes too.
  bool any(std::size_t layer, const Box& box, const Selection& selection) const;

 private:
  struct TileCells {
    int side = 1;                      // cells along each side
    std::vector<std::uint32_t> first;  // by cell, row by row from the south; one more than cells
    std::vector<std::uint32_t> sites;
  };
  struct Layer {
    std::vector<TileCells> tiles;
    std::vector<std::uint64_t> offsets;  // silvasim::ecosystem::site_offsets
    std::uint32_t first_species = 0;
  };
  struct Span {
    int first = 0, last = -1;
  };
  static Span span(double from, double to, double cell, int count);

  std::shared_ptr<const Ecosystem> ecosystem_;
  std::vector<Layer> layers_;
  std::vector<PlantSpecies> species_;
};

template <typename Visit>
bool Plants::for_each(std::size_t l, const Box& box, const Selection& selection, Visit&& visit) const {
  const Selection::Layer& chosen = selection.layers[l];
  if (!(chosen.most_radius_m > 0)) return true;
  const silvasim::ecosystem::Layer& land = ecosystem_->layers[l];
  const Layer& layer = layers_[l];
  const double side = land.tile_set.side_m;
  const Span columns = span(box.west - land.north_west.x, box.east - land.north_west.x, side, land.tiling.columns);
  const Span rows = span(land.north_west.y - box.north, land.north_west.y - box.south, side, land.tiling.rows);
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const std::size_t position = land.tiling.position(column, row);
      if (!chosen.occupied[position]) continue;
      const std::uint16_t tile = land.tiling.tiles[position];
      const TileCells& cells = layer.tiles[tile];
      const auto& sites = land.tile_set.tiles[tile].sites;
      const silvasim::base::Point origin = silvasim::ecosystem::tile_origin(land, column, row);
      const Span across = span(box.west - origin.x, box.east - origin.x, side / cells.side, cells.side);
      const Span along = span(box.south - origin.y, box.north - origin.y, side / cells.side, cells.side);
      for (int v = along.first; v <= along.last; ++v) {
        const std::size_t cell = static_cast<std::size_t>(v) * static_cast<std::size_t>(cells.side);
        const std::uint32_t end = cells.first[cell + static_cast<std::size_t>(across.last) + 1];
        for (std::uint32_t k = cells.first[cell + static_cast<std::size_t>(across.first)]; k < end; ++k) {
          const std::uint32_t s = cells.sites[k];
          const silvasim::ecosystem::PlantId id = land.plants[layer.offsets[position] + s];
          if (id == silvasim::ecosystem::no_plant || !selection.species[layer.first_species + id]) continue;
          Stem stem;
          stem.x_m = origin.x + static_cast<double>(sites[s].x_m);
          stem.y_m = origin.y + static_cast<double>(sites[s].y_m);
          if (!box.contains({stem.x_m, stem.y_m})) continue;
          stem.radius_m = sites[s].radius_m;
          stem.species = layer.first_species + id;
          if (!visit(static_cast<const Stem&>(stem))) return false;
        }
      }
    }
  }
  return true;
}

}  // namespace ghosttile::cover
