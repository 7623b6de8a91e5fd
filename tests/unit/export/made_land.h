// Made ecosystems to export: hills, zones of species, sites thrown by hand, so that nothing here depends on the rooms
// that fill tiles and let plants grow.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::testing {

struct MadeLand {
  std::uint64_t seed = 1;
  double side_m = 100;
  int columns = 6, rows = 5;
  int sites_per_tile = 120;  // at most: darts that hit a neighbour are dropped
  double least_radius_m = 1.5, most_radius_m = 5;
  int species = 3;
  double stands = 0.8;  // share of the sites that bear a plant
  bool terrain = true;
  bool probabilities = true;  // and suitability maps
  base::Point south_west{600000, 5190000};
  std::string crs_wkt = {};
};

ecosystem::Ecosystem make_land(const MadeLand& made);

// A second layer of small plants over the same land.
void add_shrubs(ecosystem::Ecosystem& ecosystem, const MadeLand& made);

// WKT 2 of WGS 84 / UTM zone 10N.
std::string utm_10_north();

// Counted without any of the exports' code: plants of a species whose stems lie in the box.
std::uint64_t recount(const ecosystem::Ecosystem& ecosystem, std::size_t layer, std::size_t species,
                      const base::Box& box);

}  // namespace silvasim::testing
