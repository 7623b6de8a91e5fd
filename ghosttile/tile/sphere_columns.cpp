#include "ghosttile/tile/sphere_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ghosttile/tile/hilbert.h"
#include "silvasim/base/vector_clones.h"

namespace ghosttile::tile {

namespace {

using objects::Sphere;

// A sphere around spheres: about the middle of their box. The slack covers what floats lose.
SphereColumns::Bound bound_of(const Sphere* spheres, std::size_t count) {
  V3 least = spheres[0].centre, most = least;
  for (std::size_t s = 0; s < count; ++s) {
    const V3 r(spheres[s].radius_m, spheres[s].radius_m, spheres[s].radius_m);
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], (spheres[s].centre - r)[axis]);
      most[axis] = std::max(most[axis], (spheres[s].centre + r)[axis]);
    }
  }
  SphereColumns::Bound bound{(least + most) * 0.5f, 0};
  for (std::size_t s = 0; s < count; ++s)
    bound.radius = std::max(bound.radius, (spheres[s].centre - bound.centre).length() + spheres[s].radius_m);
  bound.radius *= 1 + 1e-5f;
  return bound;
}

std::vector<Sphere> clustered(std::vector<Sphere> spheres) {
  V3 least = spheres[0].centre, most = least;
  for (const Sphere& sphere : spheres) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], sphere.centre[axis]);
      most[axis] = std::max(most[axis], sphere.centre[axis]);
    }
  }
  const V3 extent = most - least;
  const float side = std::max({extent.x, extent.y, extent.z, 1e-9f}) * 1.001f;
  std::vector<std::uint32_t> places(spheres.size()), order(spheres.size());
  for (std::size_t s = 0; s < spheres.size(); ++s) places[s] = hilbert_place((spheres[s].centre - least) / side);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t s) { return places[s]; });
  std::vector<Sphere> sorted;
  for (const std::uint32_t s : order) sorted.push_back(spheres[s]);
  while (sorted.size() % SphereColumns::cluster_size != 0) sorted.push_back(sorted.back());
  return sorted;
}

[[gnu::always_inline]] inline bool apart(const SphereColumns::Bound& a, const SphereColumns::Bound& b, const V3& shift,
                                         float delta_m) {
  const float x = b.centre.x + shift.x - a.centre.x, y = b.centre.y + shift.y - a.centre.y,
              z = b.centre.z + shift.z - a.centre.z;
  const float sum = a.radius + b.radius + delta_m + 1e-6f;
  return sum < 0 || x * x + y * y + z * z > sum * sum * (1 + 1e-5f);
}

[[gnu::always_inline]] inline bool clusters_collide(const SphereColumns::Cluster& a, const SphereColumns::Cluster& b,
                                                    const V3& shift, float delta_m) {
  // All 64 pairs, and one look at what came out: a branch a sphere would cost more than it saves.
  std::array<int, SphereColumns::cluster_size> hits{};
  for (std::size_t s = 0; s < SphereColumns::cluster_size; ++s) {
    const float x = a.x[s] - shift.x, y = a.y[s] - shift.y, z = a.z[s] - shift.z, radius = a.radius[s] + delta_m;
    for (std::size_t t = 0; t < SphereColumns::cluster_size; ++t) {
      const float dx = b.x[t] - x, dy = b.y[t] - y, dz = b.z[t] - z, sum = radius + b.radius[t];
      hits[t] |= static_cast<int>(dx * dx + dy * dy + dz * dz <= sum * sum) & static_cast<int>(sum >= 0);
    }
  }
  int any = 0;
  for (const int hit : hits) any |= hit;
  return any != 0;
}

// What it calls must be inline, so that it is compiled for wider registers too.
SILVA_VECTOR_CLONES
bool candidates_collide(const SphereColumns& columns, std::uint32_t i, std::uint32_t j, const V3& shift,
                        float delta_m) {
  for (std::uint32_t a = columns.first_cluster[i]; a < columns.first_cluster[i + 1]; ++a) {
    if (apart(columns.bounds[a], columns.candidate_bounds[j], shift, delta_m)) continue;
    for (std::uint32_t b = columns.first_cluster[j]; b < columns.first_cluster[j + 1]; ++b) {
      if (apart(columns.bounds[a], columns.bounds[b], shift, delta_m)) continue;
      if (clusters_collide(columns.clusters[a], columns.clusters[b], shift, delta_m)) return true;
    }
  }
  return false;
}

}  // namespace

bool SphereColumns::collide(std::uint32_t i, std::uint32_t j, const V3& shift, float delta_m) const {
  return !apart(candidate_bounds[i], candidate_bounds[j], shift, delta_m) &&
         candidates_collide(*this, i, j, shift, delta_m);
}

SphereColumns sphere_columns(const std::vector<objects::Detail>& objects, const std::vector<Candidate>& candidates) {
  std::vector<std::vector<Sphere>> of_objects;
  for (const objects::Detail& object : objects) of_objects.push_back(clustered(object.spheres));

  SphereColumns columns;
  columns.first_cluster.push_back(0);
  std::vector<Sphere> moved;
  for (const Candidate& candidate : candidates) {
    moved.clear();
    for (const Sphere& sphere : of_objects[candidate.object])
      moved.push_back({candidate(sphere.centre), sphere.radius_m * candidate.scale});
    for (std::size_t first = 0; first < moved.size(); first += SphereColumns::cluster_size) {
      SphereColumns::Cluster cluster;
      for (std::size_t s = 0; s < SphereColumns::cluster_size; ++s) {
        const Sphere& sphere = moved[first + s];
        cluster.x[s] = sphere.centre.x;
        cluster.y[s] = sphere.centre.y;
        cluster.z[s] = sphere.centre.z;
        cluster.radius[s] = sphere.radius_m;
      }
      columns.clusters.push_back(cluster);
      columns.bounds.push_back(bound_of(moved.data() + first, SphereColumns::cluster_size));
    }
    columns.candidate_bounds.push_back(bound_of(moved.data(), moved.size()));
    columns.first_cluster.push_back(static_cast<std::uint32_t>(columns.clusters.size()));
  }
  return columns;
}

}  // namespace ghosttile::tile
