#include "silvasim/export/colour.h"

#include <fmt/format.h>

#include <array>

namespace silvasim::exports {

std::string hex(Colour colour) { return fmt::format("#{:06x}", colour & 0xFFFFFF); }

Colour ramp(double share) {
  // Lightness rises evenly between these; hue runs violet, blue, teal, green, yellow.
  static constexpr std::array<Colour, 9> controls = {0x3B0F5C, 0x44347F, 0x3A568C, 0x2D738E, 0x23908B,
                                                     0x32AC7B, 0x6CC660, 0xB2DA3F, 0xF7E53B};
  const double at = std::clamp(std::isnan(share) ? 0.0 : share, 0.0, 1.0) * (controls.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), controls.size() - 2);
  const double t = at - static_cast<double>(i);
  // Between neighbours the stored values are even enough: they are close together.
  Colour result = 0;
  for (const int shift : {16, 8, 0}) {
    const double a = (controls[i] >> shift) & 0xFF, b = (controls[i + 1] >> shift) & 0xFF;
    result |= static_cast<Colour>(a + (b - a) * t + 0.5) << shift;
  }
  return result;
}

}  // namespace silvasim::exports
