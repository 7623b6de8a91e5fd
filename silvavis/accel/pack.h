// From a model of floats to the quantised one that is traced: builds the tree, orders triangles by its leaves.
//
// A binary tree and its leaves come from Embree's builder (surface area heuristic); which of its nodes become nodes of sixteen is
// chosen so that rays are expected to visit the fewest.
// Errors: base::Error for a model whose triangles all vanish at 1/65535 of its size.
// Threads: parallel inside. Cost: docs/performance.md.
#pragma once

#include <memory>

#include "assets/model.h"
#include "silvavis/scene/plant_model.h"

namespace silvavis::accel {

// `looks`: of another level of the same plant; none: made from the model's own.
scene::PlantModel pack(const assets::Model& model, std::shared_ptr<const scene::Looks> looks = nullptr);

}  // namespace silvavis::accel
