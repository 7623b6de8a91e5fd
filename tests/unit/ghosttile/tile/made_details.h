// Details for tests: sphere sets without triangles to speak of.
#pragma once

#include <cmath>
#include <vector>

#include "ghosttile/objects/detail.h"
#include "silvasim/base/random.h"

namespace ghosttile::tile {

inline objects::Detail detail_of(std::vector<objects::Sphere> spheres) {
  objects::Detail detail;
  detail.name = "made";
  detail.spheres = std::move(spheres);
  detail.anchors = {{0, 0, 0}};
  return detail;
}

// A straight twig along x.
inline objects::Detail twig(float length_m, float radius_m, int spheres) {
  std::vector<objects::Sphere> of;
  for (int s = 0; s < spheres; ++s)
    of.push_back({{length_m * ((static_cast<float>(s) + 0.5f) / static_cast<float>(spheres) - 0.5f), 0, 0}, radius_m});
  return detail_of(of);
}

// A lump: spheres within a ball.
inline objects::Detail lump(float radius_m, int spheres, std::uint32_t seed) {
  silvasim::base::Stream stream(seed, silvasim::base::Purpose::picture);
  std::vector<objects::Sphere> of;
  while (static_cast<int>(of.size()) < spheres) {
    const assets::V3 at(2 * stream.next_float() - 1, 2 * stream.next_float() - 1, 2 * stream.next_float() - 1);
    if (at.length() < 1) of.push_back({at * radius_m * 0.6f, radius_m * (0.2f + 0.2f * stream.next_float())});
  }
  return detail_of(of);
}

}  // namespace ghosttile::tile
