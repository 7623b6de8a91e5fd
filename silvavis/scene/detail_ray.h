// A ray in the space of an instance's model: as scene::local_ray() for plants, turned by the candidate's whole rotation.
#pragma once

#include "silvavis/scene/instance.h"

namespace silvavis::scene {

// `corner`: of the instance's tile, world space.
inline LocalRay detail_ray(const DetailFrame& frame, const V3d& corner, const V3d& origin, const V3& direction) {
  const double dx = static_cast<double>(direction.x), dy = static_cast<double>(direction.y),
               dz = static_cast<double>(direction.z);
  const double x = origin.x - (corner.x + static_cast<double>(frame.at.x)),
               y = origin.y - (corner.y + static_cast<double>(frame.at.y)),
               z = origin.z - (corner.z + static_cast<double>(frame.at.z));
  const double t = -(x * dx + y * dy + z * dz);
  const double size = 1.0 / static_cast<double>(frame.scale);
  const V3 moved(static_cast<float>((x + t * dx) * size), static_cast<float>((y + t * dy) * size),
                 static_cast<float>((z + t * dz) * size));
  return {frame.turned_back(moved), frame.turned_back(direction), t};
}

}  // namespace silvavis::scene
