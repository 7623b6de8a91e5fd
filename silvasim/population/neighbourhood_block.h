// One block of the field-of-neighbourhood passes, worked on by one thread. Not for other rooms.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "silvasim/base/random.h"
#include "silvasim/population/choice.h"
#include "silvasim/population/influence_field.h"
#include "silvasim/population/neighbourhoods.h"
#include "silvasim/population/population.h"

namespace silvasim::population {

// How the land is cut into blocks of whole tiles and the blocks into cells.
struct BlockLayout {
  double cell_m = 0;
  int block_tiles = 1;        // tiles along a block's side
  int cells = 1;              // cells along a block's side
  int columns = 1, rows = 1;  // blocks
};

// What all blocks of one layer share.
struct CompetitionGround {
  const evaluators::Suitability& suitability;
  const evaluators::Ground& ground;
  const config::LayerSettings& layer;
  const Influences& influences;
  BlockLayout layout;
  std::uint64_t seed = 0;
  float most_reach_m = 0;
  std::optional<std::uint64_t> watch;
};

// The buffers of one thread; used for block after block.
class NeighbourhoodBlock {
 public:
  explicit NeighbourhoodBlock(const CompetitionGround& shared) : shared_(shared) {}

  struct Result {
    std::uint64_t fixings = 0;
    std::uint64_t changed = 0;
    std::optional<std::vector<ActingPlant>> acting;  // on the watched site, where it is in this block
  };

  // Runs pass `pass` (from 0) of block (column, row) and writes its plants into `population`, from which it also reads
  // those of the blocks around it.
  Result run(int column, int row, int pass, Population& population);

 private:
  struct Origin {
    int first_column = 0, first_row = 0, last_column = 0, last_row = 0;  // tiles, the last excluded
  };

  void load(int pass);
  void weigh_surroundings();
  void weigh_last_pass();
  Result fix_all(base::Stream stream, int pass);
  void fix(std::size_t site, int pass, Result& result);
  void store(Population& population) const;
  std::vector<ActingPlant> acting_on(std::size_t site) const;

  // Lets a plant at local (x, y) act on the block's unfixed sites but `self`.
  void act(float x, float y, float radius_m, ecosystem::PlantId species, std::size_t self);
  void weigh_again(float x, float y);
  void update(std::size_t site);

  // Cells along one axis that a stretch of local coordinates touches; first > last where none.
  std::pair<int, int> cells_between(float from, float to) const;

  // Calls visit(x, y, radius, index in the population, site id) for the sites of a tile, in the block's local metres.
  template <typename Visit>
  void for_sites_of_tile(int column, int row, Visit&& visit) const;

  // The same for the plants that stand around the block, as far as they may reach into it.
  template <typename Visit>
  void for_plants_around(Visit&& visit) const;

  template <typename Visit>
  void for_sites_near(float x, float y, float reach, Visit&& visit) const;

  const CompetitionGround& shared_;
  const Population* population_ = nullptr;  // as it is while the block runs
  Origin origin_;

  // Columns over the block's sites, cell by cell, cells row by row from the north. Local metres: x from the block's west
  // edge, y southward from its north edge.
  std::vector<float> x_, y_, radius_m_;
  std::vector<std::uint64_t> index_;  // in the population
  std::vector<SiteKey> key_;
  std::vector<float> surrounded_;   // probabilities weighed with the plants outside the block; sites x species
  std::vector<float> probability_;  // the current ones
  std::vector<float> certainty_;    // < 0: fixed
  std::vector<ecosystem::PlantId> plant_, last_plant_, candidate_;
  std::vector<float> chosen_;  // probability of the candidate at fixing
  std::vector<std::uint32_t> cell_start_;
  std::vector<std::uint32_t> unfixed_;  // a cell: how many
  std::vector<std::uint32_t> live_;     // cells that hold unfixed sites
};

}  // namespace silvasim::population
