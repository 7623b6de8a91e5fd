// Between sRGB's encoding and linear light (IEC 61966-2-1), with the same bits on every machine.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "silvasim/base/math.h"

namespace assets {

inline double linear_from_srgb(double encoded) {
  if (encoded <= 0.04045) return encoded / 12.92;
  return silvasim::base::exp(2.4 * silvasim::base::log((encoded + 0.055) / 1.055));
}

// Of 8 bits.
inline const std::array<float, 256>& linear_of_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < t.size(); ++i)
      t[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / 255.0));
    return t;
  }();
  return table;
}

// The byte whose encoding is nearest.
inline std::uint8_t byte_of_linear(float linear) {
  static const std::array<float, 255> bounds = [] {
    std::array<float, 255> t{};
    for (std::size_t i = 0; i < t.size(); ++i) {
      t[i] = static_cast<float>(linear_from_srgb((static_cast<double>(i) + 0.5) / 255.0));
    }
    return t;
  }();
  return static_cast<std::uint8_t>(std::upper_bound(bounds.begin(), bounds.end(), linear) - bounds.begin());
}

}  // namespace assets
