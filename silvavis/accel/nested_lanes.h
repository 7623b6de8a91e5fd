// What the parts of the kernel share: rays prepared for slabs, and small words for Highway's.
#if defined(SILVAVIS_NESTED_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_LANES
#undef SILVAVIS_NESTED_LANES
#else
#define SILVAVIS_NESTED_LANES
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "silvavis/accel/tracer.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Eight floats where the machine has them, else four; loops step by Lanes(f8).
using F8 = hn::CappedTag<float, 8>;
using F4 = hn::CappedTag<float, 4>;
constexpr F8 f8;
constexpr F4 f4;
using V8 = hn::Vec<F8>;
using M8 = hn::Mask<F8>;

template <typename D, typename M>
HWY_INLINE std::uint32_t bits_of(D d, M mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

HWY_INLINE V8 floats_of(const std::uint8_t* bytes) {
  return hn::ConvertTo(f8,
                       hn::PromoteTo(hn::Rebind<std::int32_t, F8>(), hn::LoadU(hn::Rebind<std::uint8_t, F8>(), bytes)));
}
HWY_INLINE V8 floats_of(const std::uint16_t* words) {
  return hn::ConvertTo(
      f8, hn::PromoteTo(hn::Rebind<std::int32_t, F8>(), hn::LoadU(hn::Rebind<std::uint16_t, F8>(), words)));
}
HWY_INLINE hn::Vec<F4> four_floats_of(const std::uint16_t* words) {
  return hn::ConvertTo(
      f4, hn::PromoteTo(hn::Rebind<std::int32_t, F4>(), hn::LoadU(hn::Rebind<std::uint16_t, F4>(), words)));
}

// 1 / x without infinities, whose products with zero would be no numbers; minus zero counts as zero, as in x < 0.
HWY_INLINE float inverse(float x) { return std::abs(x) < 1e-18f ? (x < 0 ? -1e18f : 1e18f) : 1.0f / x; }

// A ray in floats of world space, for boxes only: all that hits something is decided nearer to it.
struct FlatRay {
  float ox, oy, oz, dx, dy, dz, ix, iy, iz;
  float ahead_x, ahead_y, per_run;  // its way over the ground, of unit length; metres of ray a metre of that
  FlatRay() = default;
  explicit FlatRay(const Ray& ray)
      : ox(static_cast<float>(ray.origin.x)),
        oy(static_cast<float>(ray.origin.y)),
        oz(static_cast<float>(ray.origin.z)),
        dx(ray.direction.x),
        dy(ray.direction.y),
        dz(ray.direction.z),
        ix(inverse(dx)),
        iy(inverse(dy)),
        iz(inverse(dz)) {
    const float run = std::sqrt(dx * dx + dy * dy);
    per_run = 1.0f / std::max(run, 1e-9f);
    ahead_x = run > 1e-9f ? dx * per_run : 1.0f;
    ahead_y = run > 1e-9f ? dy * per_run : 0.0f;
  }
};

// What waits on a stack: a distance and what is there, in one number that sorts by the distance.
HWY_INLINE std::uint64_t waiting(float distance, std::uint32_t index, bool leaf) {
  // The bits of positive floats sort like the floats, those of negative ones the other way round and above them.
  const auto bits = std::bit_cast<std::uint32_t>(distance);
  const std::uint32_t rising = bits ^ (static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31) | 0x80000000u);
  return std::uint64_t{rising} << 32 | std::uint64_t{index} << 1 | (leaf ? 1 : 0);
}
HWY_INLINE float distance_of(std::uint64_t entry) {
  const auto rising = static_cast<std::uint32_t>(entry >> 32);
  return std::bit_cast<float>(rising ^
                              (static_cast<std::uint32_t>(~static_cast<std::int32_t>(rising) >> 31) | 0x80000000u));
}
HWY_INLINE std::uint32_t index_of(std::uint64_t entry) { return static_cast<std::uint32_t>(entry) >> 1; }
HWY_INLINE bool is_leaf(std::uint64_t entry) { return (entry & 1) != 0; }

// Adds to the sorted part above `bottom`, the farthest lowest.
HWY_INLINE void insert(std::uint64_t* stack, int& size, int bottom, std::uint64_t entry) {
  int at = size++;
  for (; at > bottom && stack[at - 1] < entry; --at) stack[at] = stack[at - 1];
  stack[at] = entry;
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
