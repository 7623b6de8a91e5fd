// A model measured, and brought to the measures of its species.
//
// Units: metres in the result. The stem's axis is vertical, through the foot.
#pragma once

#include <cstddef>

#include "assets/load.h"
#include "assets/model.h"

namespace assets {

struct Measures {
  double height_m = 0;        // from the foot (z = foot_z_m) to the highest vertex
  double crown_radius_m = 0;  // 98 % of the seen surface lies within this horizontal distance of the stem's axis
  double reach_m = 0;         // greatest horizontal distance of a vertex from the axis
  double foot_radius_m = 0;   // the same of what lies within the lowest 2 % of the height above the foot
  double foot_x_m = 0, foot_y_m = 0, foot_z_m = 0;  // where the stem leaves the ground, in the model's own coordinates
  std::size_t triangles = 0;
  V3 least, greatest;  // corners of the bounding box
};

// The foot: the model's own z = 0 where it was drawn to stand there, that is if at most a quarter of its height lies below,
// which then is root and stays below the ground; otherwise its lowest vertex. In the plane: the model's own origin if it
// lies within the foot's triangles' bounding circle, otherwise their mean, weighted by area.
// Cost: 65,536 samples of the surface. Promise: the same numbers for the same model.
Measures measure(const Model& model);

struct Size {
  double height_m = 0;
  double radius_m = 0;  // of the crown; 0: as the height tells
};

// Foot to the origin, height and crown radius as given: z is scaled by one factor, x and y by another.
// Warns where the factors differ by more than 1.5: the model is stretched, and another one would suit the species better.
// Errors: base::Error for measures that are not above 0, or a model without height or width.
Model fitted(Model model, const Size& size, LoadReport* report = nullptr);

}  // namespace assets
