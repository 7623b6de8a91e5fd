// A scene as plain files for another renderer: the same triangles, the same plants in the same places, the same light.
//
// Into a folder: scene.json (what there is, cameras, sun), an .npy a column, a .png a texture; README.md beside this file
// describes them. World space, metres; the models are the packed ones, decoded as the tracer decodes them.
// Promise: every plant that the tracer meets is in the table once, where scene::instance_at() puts it.
// Errors: base::Error that names the file. Cost: memory of the table, 22 bytes a plant.
#pragma once

#include <filesystem>

#include "silvavis/render.h"
#include "silvavis/scene/scene.h"

namespace silva_bench {

void dump(const silvavis::scene::Scene& scene, const silvavis::Light& light, const silvavis::shade::Land& land,
          const std::filesystem::path& folder);

}  // namespace silva_bench
