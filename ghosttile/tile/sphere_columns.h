// The spheres of candidates as columns, and the one test that decides whether two candidates collide.
//
// Spheres of an object are sorted so that eight that follow one another lie together; a cluster's own sphere around them
// lets most pairs of eight be passed over.
// Source: Guérin et al. 2016, section 4.3: d(A, B) = min |b - a| - (ra + rb) <= delta.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ghosttile/tile/ghost_tile.h"

namespace ghosttile::tile {

struct SphereColumns {
  static constexpr std::size_t cluster_size = 8;

  // By candidate, in tile space: clusters [first_cluster[i], first_cluster[i + 1]); the last one is filled up with copies.
  std::vector<std::uint32_t> first_cluster;
  struct Cluster {
    std::array<float, cluster_size> x, y, z, radius;
  };
  std::vector<Cluster> clusters;
  struct Bound {
    V3 centre{0, 0, 0};
    float radius = 0;
  };
  std::vector<Bound> bounds;            // by cluster
  std::vector<Bound> candidate_bounds;  // by candidate

  // Candidate i against candidate j of the tile that is `shift` metres away.
  bool collide(std::uint32_t i, std::uint32_t j, const V3& shift, float delta_m) const;
};

SphereColumns sphere_columns(const std::vector<objects::Detail>& objects, const std::vector<Candidate>& candidates);

}  // namespace ghosttile::tile
