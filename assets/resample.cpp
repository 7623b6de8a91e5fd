#include "assets/resample.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace assets {

namespace {

double mitchell(double x) {
  constexpr double b = 1.0 / 3, c = 1.0 / 3;
  x = std::abs(x);
  if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  if (x < 2)
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
  return 0;
}

}  // namespace

std::vector<Resampler::Taps> Resampler::taps(int size, int new_size) {
  const double scale = static_cast<double>(size) / new_size;
  const double widened = std::max(scale, 1.0), radius = 2 * widened;
  std::vector<Taps> all(static_cast<std::size_t>(new_size));
  for (int i = 0; i < new_size; ++i) {
    const double centre = (i + 0.5) * scale - 0.5;
    const int first = std::max(0, static_cast<int>(std::ceil(centre - radius)));
    const int last = std::min(size - 1, static_cast<int>(std::floor(centre + radius)));
    std::vector<double> weights;
    for (int k = first; k <= last; ++k) weights.push_back(mitchell((k - centre) / widened));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    Taps& taps = all[static_cast<std::size_t>(i)];
    taps.first = first;
    for (const double w : weights) taps.weights.push_back(static_cast<float>(w / sum));
  }
  return all;
}

Resampler::Resampler(int width, int height, int new_width, int new_height, int channels)
    : channels_(static_cast<std::size_t>(channels)),
      across_(taps(width, new_width)),
      down_(taps(height, new_height)),
      row_(static_cast<std::size_t>(new_width) * channels_),
      pixels_(static_cast<std::size_t>(new_width) * static_cast<std::size_t>(new_height) * channels_, 0.0f) {}

void Resampler::add_row(const std::vector<float>& row) {
  for (std::size_t i = 0; i < across_.size(); ++i) {
    const Taps& taps = across_[i];
    for (std::size_t c = 0; c < channels_; ++c) {
      const float* in = row.data() + static_cast<std::size_t>(taps.first) * channels_ + c;
      float sum = 0;
      for (const float weight : taps.weights) {
        sum += weight * *in;
        in += channels_;
      }
      row_[i * channels_ + c] = sum;
    }
  }
  // Add it to the rows of the result whose filter reaches it; later ones begin later.
  for (std::size_t j = first_open_; j < down_.size(); ++j) {
    const Taps& taps = down_[j];
    if (taps.first > y_) break;
    const int k = y_ - taps.first;
    if (k >= static_cast<int>(taps.weights.size())) {
      if (j == first_open_) ++first_open_;
      continue;
    }
    const float weight = taps.weights[static_cast<std::size_t>(k)];
    float* out = pixels_.data() + j * row_.size();
    for (std::size_t i = 0; i < row_.size(); ++i) out[i] += weight * row_[i];
  }
  ++y_;
}

void keep_coverage(std::vector<float>& alphas, float cutoff, double share) {
  const std::size_t count = alphas.size();
  const auto wanted = static_cast<std::size_t>(std::llround(share * static_cast<double>(count)));
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto scattered = [](std::uint32_t i) { return i * 2654435761u; };
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return alphas[a] != alphas[b] ? alphas[a] > alphas[b] : scattered(a) < scattered(b);
  };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, count - 1)), order.end(),
                   before);

  // The least alpha that must be seen becomes the cutoff.
  float least = 1;
  for (std::size_t k = 0; k < wanted; ++k) least = std::min(least, alphas[order[k]]);
  const float scale = wanted > 0 && least > 0 ? cutoff / least : 1.0f;
  constexpr float step = 1.0f / 255;
  for (std::size_t k = 0; k < count; ++k) {
    float& alpha = alphas[order[k]];
    alpha = k < wanted ? std::clamp(alpha * scale, cutoff, 1.0f)
                       : std::clamp(alpha * scale, 0.0f, std::max(0.0f, cutoff - step));
  }
}

}  // namespace assets
