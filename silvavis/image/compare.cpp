#include "silvavis/image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "silvasim/base/error.h"

namespace silvavis::image {

namespace {

void check(const Image& a, const Image& b) {
  if (a.width == b.width && a.height == b.height && a.channels == b.channels) return;
  throw silvasim::base::Error(
      fmt::format("the pictures are of different size: {} x {} with {} channels and {} x {} with {}", a.width, a.height,
                  a.channels, b.width, b.height, b.channels));
}

double mean_luminance(const Image& image) {
  double sum = 0;
  std::uint64_t count = 0;
  const std::size_t step = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.pixels.size(); i += step) {
    const float* p = image.pixels.data() + i;
    const float light = step < 3 ? p[0] : luminance(Rgb(p[0], p[1], p[2]));
    if (!std::isfinite(light)) continue;
    sum += light;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

template <class Id>
IdDifference compared(std::span<const Id> a, std::span<const Id> b) {
  if (a.size() != b.size()) {
    throw silvasim::base::Error(
        fmt::format("the pictures are of different size: {} and {} pixels", a.size(), b.size()));
  }
  IdDifference result;
  result.pixels = a.size();
  for (std::size_t i = 0; i < a.size(); ++i) result.different += a[i] != b[i] ? 1 : 0;
  if (!a.empty()) result.share_different = static_cast<double>(result.different) / static_cast<double>(a.size());
  return result;
}

}  // namespace

Difference compare(const Image& a, const Image& b, const CompareOptions& options) {
  check(a, b);
  Difference result;
  const std::size_t channels = static_cast<std::size_t>(a.channels);
  result.pixels = channels > 0 ? a.pixels.size() / channels : 0;
  double absolute = 0, squares = 0;
  std::uint64_t values = 0, different = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += channels) {
    bool differs = false;
    for (std::size_t c = i; c < i + channels; ++c) {
      const bool finite_a = std::isfinite(a.pixels[c]), finite_b = std::isfinite(b.pixels[c]);
      if (finite_a && finite_b) {
        const double error = std::abs(static_cast<double>(a.pixels[c]) - static_cast<double>(b.pixels[c]));
        absolute += error;
        squares += error * error;
        result.greatest = std::max(result.greatest, error);
        differs = differs || error > static_cast<double>(options.threshold);
        ++values;
      } else {
        const bool both_nan = std::isnan(a.pixels[c]) && std::isnan(b.pixels[c]);
        if (!both_nan && !(a.pixels[c] == b.pixels[c])) differs = true;
        if (finite_a != finite_b) ++result.not_finite;
      }
    }
    different += differs ? 1 : 0;
  }
  if (values > 0) {
    result.mean_absolute = absolute / static_cast<double>(values);
    result.rmse = std::sqrt(squares / static_cast<double>(values));
  }
  result.psnr_db = result.rmse > 0 ? -20 * std::log10(result.rmse) : std::numeric_limits<double>::infinity();
  const double light_a = mean_luminance(a), light_b = mean_luminance(b);
  result.brightness_ratio = light_a == light_b ? 1 : light_b / light_a;
  result.ssim = options.ssim ? ssim(a, b, options.exposure_stops) : std::numeric_limits<double>::quiet_NaN();
  if (result.pixels > 0) {
    result.share_different = static_cast<double>(different) / static_cast<double>(result.pixels);
  }
  return result;
}

IdDifference compare_ids(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) { return compared(a, b); }
IdDifference compare_ids(std::span<const std::uint16_t> a, std::span<const std::uint16_t> b) { return compared(a, b); }

}  // namespace silvavis::image
