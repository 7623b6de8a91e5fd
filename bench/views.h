// The three cameras of the paper's Table 2, fitted to a scene: what every measurement of pictures looks through.
//
// World space. 1920 x 1080 pixels. Threads: any.
#pragma once

#include <array>
#include <cstddef>

#include "silvavis/scene/scene.h"
#include "silvavis/shade/camera.h"

namespace silva_bench {

inline constexpr std::array<const char*, 3> views = {"bird's eye", "flight", "close"};

silvavis::shade::Camera camera_of(const silvavis::scene::Scene& scene, std::size_t view);

}  // namespace silva_bench
