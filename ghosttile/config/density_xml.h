// Density elements of the XML to trees of density fields.
#pragma once

#include "ghosttile/config/words.h"
#include "ghosttile/cover/land.h"
#include "ghosttile/density/node.h"

namespace ghosttile::config {

// What the elements stand in.
struct Surroundings {
  cover::Land* land = nullptr;                   // null: no ecosystem; rules are errors then
  std::shared_ptr<const density::Plane> ground;  // null: none; layers lie over height 0 then
  bool above_ground = true;                      // whether the z of places is measured from the ground
  density::V3d origin{0, 0, 0};                  // of places
  double turn_deg = 0;                           // of places, about the origin
  density::Box3 region;                          // where stems are looked for
};

density::Node density_of(const xml::Node& element, const Surroundings& around, Errors& errors);

// The product of all density elements that a node holds, times `value`; one at least.
density::Node product_of(const xml::Node& holder, double value, const Surroundings& around, Errors& errors);

// The ground's height.
double height_at(const density::Plane& ground, double x, double y);

}  // namespace ghosttile::config
