#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "silvasim/base/error.h"
#include "silvasim/base/math.h"
#include "silvavis/image/compare.h"
#include "silvavis/image/tone.h"

namespace silvavis::image {

namespace {

constexpr int window = 11;

std::array<double, window> gaussian() {
  std::array<double, window> weights{};
  double sum = 0;
  for (int i = 0; i < window; ++i) {
    const double x = i - window / 2;
    sum += weights[static_cast<std::size_t>(i)] = silvasim::base::exp(-x * x / (2 * 1.5 * 1.5));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<float> encoded_luminance(const Image& image, float scale) {
  const std::size_t step = static_cast<std::size_t>(image.channels);
  std::vector<float> result(image.pixels.size() / step);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const float* p = image.pixels.data() + i * step;
    result[i] = srgb_encoded(scale * (step < 3 ? p[0] : luminance(Rgb(p[0], p[1], p[2]))));
  }
  return result;
}

}  // namespace

double ssim(const Image& a, const Image& b, double exposure_stops) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) {
    throw silvasim::base::Error("the pictures are of different size");
  }
  if (a.width < window || a.height < window) return std::numeric_limits<double>::quiet_NaN();
  const float scale = static_cast<float>(silvasim::base::exp(exposure_stops * 0.6931471805599453));
  const std::vector<float> light_a = encoded_luminance(a, scale), light_b = encoded_luminance(b, scale);
  const std::array<double, window> weights = gaussian();
  const std::size_t width = static_cast<std::size_t>(a.width), height = static_cast<std::size_t>(a.height);
  const std::size_t columns = width - window + 1, rows = height - window + 1;

  // The window is a product of two: first along the rows, of the means and of the squares; then down the columns.
  using Moments = std::array<double, 5>;  // a, b, aa, bb, ab
  std::vector<Moments> along(columns * window);
  const auto blur_row = [&](std::size_t y) {
    for (std::size_t x = 0; x < columns; ++x) {
      Moments sum{};
      for (std::size_t i = 0; i < window; ++i) {
        const double p = static_cast<double>(light_a[y * width + x + i]);
        const double q = static_cast<double>(light_b[y * width + x + i]), w = weights[i];
        sum[0] += w * p;
        sum[1] += w * q;
        sum[2] += w * p * p;
        sum[3] += w * q * q;
        sum[4] += w * p * q;
      }
      along[(y % window) * columns + x] = sum;
    }
  };
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
  double total = 0;
  for (std::size_t y = 0; y < height; ++y) {
    blur_row(y);
    if (y + 1 < window) continue;
    for (std::size_t x = 0; x < columns; ++x) {
      Moments m{};
      for (std::size_t i = 0; i < window; ++i) {
        const Moments& row = along[((y + 1 + i) % window) * columns + x];
        for (std::size_t k = 0; k < m.size(); ++k) m[k] += weights[i] * row[k];
      }
      const double variance_a = m[2] - m[0] * m[0], variance_b = m[3] - m[1] * m[1], both = m[4] - m[0] * m[1];
      total += (2 * m[0] * m[1] + c1) * (2 * both + c2) /
               ((m[0] * m[0] + m[1] * m[1] + c1) * (variance_a + variance_b + c2));
    }
  }
  return total / static_cast<double>(rows * columns);
}

}  // namespace silvavis::image
