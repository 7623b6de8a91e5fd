// Colours as 0xRRGGBB, and light as sums of them.
//
// Light is mixed where it adds up, in a space close to linear: the square of the stored value (a gamma of 2 stands for
// sRGB's curve, because a square and a root give the same bits on every machine).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace silvasim::exports {

using Colour = std::uint32_t;

struct Light {
  float red = 0, green = 0, blue = 0;  // 0..1, linear

  friend Light operator+(Light a, Light b) { return {a.red + b.red, a.green + b.green, a.blue + b.blue}; }
  friend Light operator*(Light a, float k) { return {a.red * k, a.green * k, a.blue * k}; }
};

inline Light mix(Light a, Light b, float share_of_b) { return a * (1 - share_of_b) + b * share_of_b; }

inline Light light_of(Colour colour) {
  const auto channel = [&](int shift) {
    const float value = static_cast<float>((colour >> shift) & 0xFF) / 255.0f;
    return value * value;
  };
  return {channel(16), channel(8), channel(0)};
}

inline std::uint8_t byte_of(float linear) {
  return static_cast<std::uint8_t>(std::sqrt(std::clamp(linear, 0.0f, 1.0f)) * 255.0f + 0.5f);
}

inline Colour colour_of(Light light) {
  return Colour{byte_of(light.red)} << 16 | Colour{byte_of(light.green)} << 8 | byte_of(light.blue);
}

// The crown's outline and the stem.
inline Colour darker(Colour colour) { return colour_of(light_of(colour) * 0.42f); }

// "#1f5f3a"
std::string hex(Colour colour);

// Perceptually even from dark violet (0) over green to yellow (1), readable in grey and by colour-blind people.
Colour ramp(double share);

}  // namespace silvasim::exports
