// What a hit looks like before light falls on it.
//
// Normals point to the side that the ray comes from. Reflectance and transmittance are diffuse, linear.
#pragma once

#include "silvavis/accel/tracer.h"
#include "silvavis/base/vector.h"
#include "silvavis/scene/instance.h"
#include "silvavis/shade/land.h"

namespace silvavis::shade {

struct SurfacePoint {
  V3d at{0, 0, 0};     // world space
  V3 normal{0, 0, 1};  // for shading
  V3 plane{0, 0, 1};   // of the triangle itself
  Rgb reflectance{0, 0, 0};
  Rgb transmittance{0, 0, 0};
  bool water = false;  // a mirror by Fresnel

  // Of an impostor: the model, which tells what it bars itself, and how it is turned.
  const scene::PlantModel* told = nullptr;
  scene::Turn turn{1, 0};
};

SurfacePoint surface_at(const scene::Scene& scene, const Land& land, const accel::Ray& ray, const accel::Hit& hit);

// A ray from the surface, `width_m` wide, towards a light; false: the plant itself bars it. `lift_m`: how far off the surface it
// begins, for what rounding needs.
bool ray_from(const SurfacePoint& point, const accel::Hit& hit, const V3& towards, double lift_m, accel::Ray& ray);

}  // namespace silvavis::shade
