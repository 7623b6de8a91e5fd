// Everything that can be traced, as plain values that refer to each other by index.
//
// The hierarchy is the paper's: a pyramid over tile positions, a tree over the sites of each Wang tile that all its
// positions share, a tree a model. Of a plant nothing is stored but its species and its height above the sea: 3 bytes a site.
// Units: metres, world space (base/vector.h). Source: Silva 2013, section 5, figures 5 to 7.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/base/lazy_vector.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvavis/scene/detail_layer.h"
#include "silvavis/scene/ground.h"
#include "silvavis/scene/plant_model.h"
#include "silvavis/scene/pyramid.h"

namespace silvavis::scene {

inline constexpr std::uint8_t no_species = 255;
inline constexpr int quarters = 4;  // of a tile position, along each side

// A Wang tile's sites in the order of its tree's leaves, eight or sixteen a leaf. Columns are padded to whole leaves with
// sites of negative radius.
struct SiteNode {
  // Of up to sixteen children, in tile space, grown by the plants' reach; least_x > most_x: no child.
  std::array<float, 16> least_x, most_x, least_y, most_y;
  std::array<std::uint32_t, 16> children{};  // nodes, or leaves as SiteLeaf packs them
  bool above_leaves = false;
};
struct SiteLeaf {
  static constexpr std::uint32_t least_slots = 8;

  std::uint32_t first_slot = 0, slots = least_slots;  // least_slots or twice that, and a multiple of least_slots

  std::uint32_t packed() const { return first_slot / least_slots << 1 | (slots > least_slots ? 1u : 0u); }
  static SiteLeaf of(std::uint32_t packed) {
    return {(packed >> 1) * least_slots, (packed & 1) != 0 ? 2 * least_slots : least_slots};
  }
};
struct TileSites {
  std::uint32_t count = 0;
  std::vector<float> x_m, y_m, radius_m;  // by slot
  std::vector<float> reach_m;             // radius * PlantLayer::most_reach
  std::vector<std::uint32_t> site_ids;    // by slot: the id in the ecosystem's tile
  std::vector<SiteNode> nodes;            // the root first; empty where the tile has no site
};

// Where a species' models lie in Scene::models.
struct SpeciesModels {
  std::string name;
  std::uint32_t first_model = 0;
  std::uint32_t variants = 1;  // 0: not drawn
  float model_radius_m = 1;    // a plant's scale is its site's radius / model_radius_m
  float most_reach = 0;        // as of the layer below, of these models alone
  float most_height = 0;
  std::uint32_t colour = 0x808080;
};

struct PlantLayer {
  std::string name;
  double tile_side_m = 0;
  double west = 0, south = 0;  // of the tile position in column 0, row 0 (here the southernmost)
  int columns = 0, rows = 0;
  std::vector<std::uint16_t> tiles;  // by position
  std::vector<TileSites> tile_sites;
  std::vector<SpeciesModels> species;
  std::uint32_t first_species = 0;  // of this layer among the species of all layers
  std::uint64_t first_plant = 0;    // of this layer among the sites of all layers

  // By tile position.
  std::vector<std::uint64_t> first_slot;  // into the columns below; one more than positions
  std::vector<float> base_m, step_m;      // height = base + step * stored
  // By slot of each position, and sixteen more so that whole leaves can be read anywhere.
  silvasim::base::LazyVector<std::uint8_t> plant_species;
  silvasim::base::LazyVector<std::uint16_t> plant_heights;

  // Over quarters of tile positions: from the lowest root to the highest tip of what stands there. The first layer's is part
  // of the land's.
  Pyramid pyramid;
  float most_reach = 1;    // greatest horizontal reach of a model / its nominal radius
  float most_height = 0;   // greatest height of a model / its nominal radius
  float least_height = 0;  // lowest point of a model (roots) / its nominal radius; at most 0

  // In the ecosystem's order, whose row 0 is the northernmost.
  std::size_t position(int column, int row) const {
    return static_cast<std::size_t>(rows - 1 - row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

// The first layer's tile positions together with the ground beneath and around them: the top of the hierarchy. Its leaf is the
// paper's: a patch of ground and a Wang tile.
struct LandGrid {
  int first_column = 0,
      first_row = 0;  // tile position of the pyramid's first node of level 0; may lie outside the tiling
  Pyramid pyramid;    // over quarters of tile positions, so that a tile position is a node of level 0
  // By item, sixteen a node of level 0: how far at least the ground lies below the item's highest tip.
  static constexpr float canopy_step_m = 0.5f;
  std::vector<std::uint8_t> canopy;
};

struct Scene {
  silvasim::base::Point origin;  // scene point at world (0, 0)
  std::string crs_wkt;
  silvasim::base::Box extent;  // world space
  Ground ground;
  LandGrid land;
  std::vector<PlantLayer> layers;
  std::vector<DetailLayer> details;  // may be made anew (scene/details.h) while nothing is traced
  std::vector<std::shared_ptr<const PlantModel>> models;
  std::uint64_t plants = 0;  // that are drawn
  std::uint64_t seed = 0;    // of the turns of plants

  // All that grows with the number of plants.
  std::size_t plant_bytes() const;
};

// The models of one species: at least one, all made for the species' measures at scale 1.
using SpeciesModelSet = std::vector<std::shared_ptr<const PlantModel>>;

// `models`: by layer, by species; an empty set leaves the species out. Takes the ecosystem apart to save memory.
// Errors: base::Error for a layer of more than 255 species, heights beyond 100 km, a terrain of more than 2^26 tile positions.
// Threads: parallel inside.
// Cost: 90 ns a site on one core.
Scene make_scene(silvasim::ecosystem::Ecosystem ecosystem, const std::vector<std::vector<SpeciesModelSet>>& models);

}  // namespace silvavis::scene
