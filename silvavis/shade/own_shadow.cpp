#include "silvavis/shade/own_shadow.h"

#include <array>
#include <atomic>

#include "silvavis/accel/nested.h"

namespace silvavis::shade {

namespace {

using scene::Impostor;

constexpr std::uint32_t at_once = 4;  // lamps that a bit of Point::known stands for
static_assert(Impostor::lamps == 32 * at_once && 64 % at_once == 0 && sizeof(Impostor::Point) == 32);

const std::array<V3, Impostor::lamps>& lamp_directions() {
  static const std::array<V3, Impostor::lamps> directions = [] {
    std::array<V3, Impostor::lamps> all;
    for (std::uint32_t lamp = 0; lamp < all.size(); ++lamp) all[lamp] = scene::lamp_direction(lamp);
    return all;
  }();
  return directions;
}

// The bits of `at_once` lamps from `first` on, in their places in the word that holds them.
std::uint64_t traced(const scene::PlantModel& model, const Impostor::Point& point, std::uint32_t first) {
  const float u = point.weight_1(), v = point.weight_2();
  const V3 a = model.position_of(point.slot, 0), b = model.position_of(point.slot, 1),
           c = model.position_of(point.slot, 2);
  const V3 at = a * (1 - u - v) + b * u + c * v, plane = (b - a).cross(c - a).normalized();
  std::array<accel::ModelRay, at_once> rays;
  for (std::uint32_t k = 0; k < at_once; ++k) {
    const V3& towards = lamp_directions()[first + k];
    constexpr float lift_m = 2e-3f;
    rays[k] = {at + plane * (plane.dot(towards) > 0 ? lift_m : -lift_m), towards, 0};
  }
  std::array<std::uint8_t, at_once> answers;
  accel::bar_model(model, rays, answers);
  std::uint64_t bits = 0;
  for (std::uint32_t k = 0; k < at_once; ++k) bits |= std::uint64_t{answers[k]} << ((first + k) % 64);
  return bits;
}

}  // namespace

bool is_barred(const scene::PlantModel& model, std::uint32_t index, const V3& towards, std::uint64_t chance) {
  const Impostor::Point& point = model.impostor->points[index];
  const std::uint32_t lamp = scene::lamp_for(towards, chance), together = lamp / at_once;
  const std::atomic_ref<std::uint64_t> barred(point.barred[lamp / 64]);
  const std::atomic_ref<std::uint32_t> known(point.known);
  if (!(known.load(std::memory_order_acquire) >> together & 1)) {
    // Threads that come here at once find the same.
    barred.fetch_or(traced(model, point, together * at_once), std::memory_order_relaxed);
    known.fetch_or(std::uint32_t{1} << together, std::memory_order_release);
  }
  return barred.load(std::memory_order_relaxed) >> lamp % 64 & 1;
}

}  // namespace silvavis::shade
