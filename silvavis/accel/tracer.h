// Rays against a scene, in batches: what the renderer asks, and every backend answers alike.
//
// Two backends: nested.h walks the scene's own trees (Silva 2013, section 5); embree.h gives every plant an instance in one
// flat structure of Embree, as other renderers do. Both decode plants by scene/instance.h and holes by scene::is_hole().
// Threads: all calls may come from several threads at once.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "silvavis/base/vector.h"
#include "silvavis/scene/scene.h"

namespace silvavis::accel {

inline constexpr std::uint32_t no_slot = 0xFFFFFFFFu;

struct Ray {
  V3d origin{0, 0, 0};    // world space
  V3 direction{0, 0, 1};  // unit length
  double least = 0;       // hits nearer than this do not count
  double most = std::numeric_limits<double>::infinity();

  // How wide the ray is, at its origin and what it gains a metre: plants whose leaves are smaller than that are met in a
  // simpler level. Both zero: always the full models.
  float width_m = 0, spread = 0;

  // The plant that the ray leaves, where that has told already what it bars itself (an impostor).
  std::uint32_t left_slot = no_slot;  // no_slot: none, and the others mean nothing
  std::int32_t left_column = 0, left_row = 0;
  std::uint8_t left_layer = 0;
};

enum class Surface : std::uint8_t { none, ground, plant, detail };

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  Surface surface = Surface::none;
  // Of the plant, and so on to the end; of a detail: into Scene::details, the tile's x and y, into DetailLayer::chosen.
  std::uint8_t layer = 0;
  std::uint8_t species = 0;          // in its layer
  std::int32_t column = 0, row = 0;  // tile position, row 0 the southernmost
  std::uint32_t site_slot = 0;       // in TileSites
  std::uint32_t model = 0;           // into Scene::models
  std::uint8_t level = 0;            // 0: the model itself, k: its coarser[k - 1]; one more than those: its impostor
  std::uint32_t slot = 0;            // the model's triangle; of an impostor its point
  float u = 0, v = 0;                // weights of its corners 1 and 2
};

class Tracer {
 public:
  virtual ~Tracer() = default;

  // The nearest hit of each ray. rays.size() == hits.size()
  virtual void nearest(std::span<const Ray> rays, std::span<Hit> hits) const = 0;
  // Whether anything lies between `least` and `most` of each ray: 1 or 0.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> answers) const = 0;

  // What the structure holds beyond the scene itself.
  virtual std::size_t bytes() const = 0;
};

}  // namespace silvavis::accel
