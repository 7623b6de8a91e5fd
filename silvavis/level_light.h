// How brightly a model is lit in a wood of its kind: what simpler levels are matched by.
#pragma once

#include <memory>

#include "silvavis/scene/scene.h"

namespace silvavis {

// Mean brightness of what is seen of nine such plants over three views, under two places of the sun and a sky, with all shadows. Only
// ratios mean something. Threads: any.
double lit_brightness(const std::shared_ptr<const scene::PlantModel>& model);

}  // namespace silvavis
