// Which light the plant itself keeps from a point of its impostor.
//
// An impostor has room for 64 directions a point, and tracing them all was two thirds of what making a model cost. A picture
// asks for some of the points under some of the directions; those are traced through the full model when they are first asked
// for, and kept. What is kept hangs on model, point and direction alone, never on who asked first.
// Threads: any. Cost: 1 microsecond the first time, then a look into a table.
#pragma once

#include "silvavis/scene/plant_model.h"

namespace silvavis::shade {

// `point`: of the model's impostor. `towards`: the light in the model's space, above the horizon. `chance`: mixed bits of ray and
// plant, which decide between directions.
bool is_barred(const scene::PlantModel& model, std::uint32_t point, const V3& towards, std::uint64_t chance);

}  // namespace silvavis::shade
