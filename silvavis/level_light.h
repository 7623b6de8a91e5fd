// How brightly a model alone is lit: what simpler levels are matched by.
#pragma once

#include <memory>

#include "silvavis/scene/scene.h"

namespace silvavis {

// Mean brightness of what is seen of the plant over several views and places of the sun, with its own shadows; full colours, no
// sky. Only ratios mean something. Threads: any. Cost: 30 ms.
double lit_brightness(const std::shared_ptr<const scene::PlantModel>& model);

}  // namespace silvavis
