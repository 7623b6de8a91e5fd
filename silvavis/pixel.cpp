// Which pixels a square has, and when one of them has enough samples.
#include <algorithm>
#include <bit>
#include <cmath>

#include "silvavis/sampler.h"

namespace silvavis {

namespace {

constexpr int least_samples = 16;

}  // namespace

std::vector<Pixel> square_of(int left, int top, int side_px, int width, int height) {
  const auto even_bits = [](unsigned code) {
    int value = 0;
    for (unsigned bit = 0; code >> (2 * bit) != 0; ++bit) value |= static_cast<int>(code >> (2 * bit) & 1) << bit;
    return value;
  };
  const unsigned side = std::bit_ceil(static_cast<unsigned>(side_px));
  std::vector<Pixel> pixels;
  for (unsigned code = 0; code < side * side; ++code) {
    const int column = even_bits(code), row = even_bits(code >> 1);
    if (column < std::min(side_px, width - left) && row < std::min(side_px, height - top))
      pixels.push_back({left + column, top + row});
  }
  return pixels;
}

bool has_enough(const Pixel& pixel, const RenderOptions& options) {
  if (pixel.samples >= options.samples) return true;
  if (pixel.samples % samples_a_pass != 0) return false;
  // Fewer would end where chance made a pixel dark and even, and darken the picture.
  if (options.error <= 0 || pixel.samples < least_samples) return false;
  const double n = pixel.samples, mean = pixel.tone / n;
  const double variance = std::max(0.0, pixel.tone_squared / n - mean * mean) / (n - 1);
  return std::sqrt(variance) < options.error / options.brightening;
}

}  // namespace silvavis
