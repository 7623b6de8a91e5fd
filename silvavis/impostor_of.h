// Makes a model's impostor: traces the model from each of its directions.
#pragma once

#include "silvavis/scene/plant_model.h"

namespace silvavis {

// Same model, same impostor. Threads: any. Cost: 70 ms a model of 40,000 triangles on one core.
scene::Impostor impostor_of(const scene::PlantModel& model);

}  // namespace silvavis
