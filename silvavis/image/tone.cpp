#include "silvavis/image/tone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "silvasim/base/math.h"
#include "silvasim/base/parallel.h"
#include "silvasim/base/vector_clones.h"

namespace silvavis::image {

namespace {

namespace base = silvasim::base;

constexpr float ln_2 = 0.69314718f;

// Counts of pixels by luminance: `bins_a_stop` to a stop, from 2^least_stop on. Counting keeps the sum independent of
// the order.
constexpr int bins_a_stop = 16, least_stop = -40, most_stop = 24;
using Histogram = std::array<std::uint64_t, static_cast<std::size_t>((most_stop - least_stop) * bins_a_stop)>;

void count(const Image& image, Histogram& histogram) {
  if (image.channels < 3) return;
  const std::size_t step = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i + 2 < image.pixels.size(); i += step) {
    const float light = luminance(Rgb(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]));
    if (!(light > 0) || !std::isfinite(light)) continue;
    const float stops = base::log(light) / ln_2;
    const int bin = static_cast<int>(std::floor((stops - least_stop) * bins_a_stop));
    if (bin >= 0 && bin < static_cast<int>(histogram.size())) ++histogram[static_cast<std::size_t>(bin)];
  }
}

// Mean of the stops between two shares of the pixels.
double mean_stops(const Histogram& histogram, double from_share, double to_share) {
  double all = 0;
  for (const std::uint64_t pixels : histogram) all += static_cast<double>(pixels);
  double before = 0, sum = 0, weight = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    const double after = before + static_cast<double>(histogram[bin]);
    const double inside = std::min(after, to_share * all) - std::max(before, from_share * all);
    if (inside > 0) {
      sum += inside * (least_stop + (static_cast<double>(bin) + 0.5) / bins_a_stop);
      weight += inside;
    }
    before = after;
  }
  return weight > 0 ? sum / weight : 0;
}

// AgX (Sobotka 2022) as Wrensch fitted it (2023): light bleeds a little into the other channels, so that what is strong
// runs to white and not to a primary; a sigmoid over 16.5 stops of each channel; and the way back. The result is
// encoded with a gamma of 2.2.
constexpr float least_ev = -12.47393f, most_ev = 4.026069f;

inline float larger(float a, float b) { return base::select(a > b, a, b); }
inline float smaller(float a, float b) { return base::select(a < b, a, b); }

inline float sigmoid(float light) {
  const float ev = base::log(larger(light, 1e-10f)) * (1 / ln_2);
  const float x = smaller(larger((ev - least_ev) * (1 / (most_ev - least_ev)), 0.0f), 1.0f);
  return -0.00232f + x * (0.1191f + x * (0.4298f + x * (-6.868f + x * (31.96f + x * (-40.14f + x * 15.5f)))));
}

inline float power(float x, float exponent) {
  return base::select(x > 1e-30f, base::exp(exponent * base::log(larger(x, 1e-30f))), 0.0f);
}

// AgX by itself is flat and pale. Most of its own "punchy" look (1.35 and 1.4) gives a sunlit landscape its contrast, and keeps what
// stands in the shade to be seen.
constexpr float contrast = 1.26f, saturation = 1.15f;

// Plain loops over columns, which become SIMD; NaN fails every comparison and so becomes 0.
constexpr std::size_t block = 64;
struct Block {
  std::array<float, block> r, g, b;
};
SILVA_VECTOR_CLONES void map(Block& p, float scale) {
  for (std::size_t i = 0; i < block; ++i) {
    const float r = smaller(base::select(p.r[i] > 0, p.r[i] * scale, 0.0f), 1e6f);
    const float g = smaller(base::select(p.g[i] > 0, p.g[i] * scale, 0.0f), 1e6f);
    const float b = smaller(base::select(p.b[i] > 0, p.b[i] * scale, 0.0f), 1e6f);
    const float x = power(sigmoid(0.842479062f * r + 0.0784336f * g + 0.079223745f * b), contrast);
    const float y = power(sigmoid(0.042328242f * r + 0.878468636f * g + 0.079166127f * b), contrast);
    const float z = power(sigmoid(0.042375655f * r + 0.0784336f * g + 0.879142974f * b), contrast);
    p.r[i] = x;
    p.g[i] = y;
    p.b[i] = z;
  }
  for (std::size_t i = 0; i < block; ++i) {
    const float grey = 0.2126f * p.r[i] + 0.7152f * p.g[i] + 0.0722f * p.b[i];
    const float x = grey + (p.r[i] - grey) * saturation, y = grey + (p.g[i] - grey) * saturation;
    const float z = grey + (p.b[i] - grey) * saturation;
    p.r[i] = smaller(power(1.196879005f * x - 0.098020881f * y - 0.099029744f * z, 2.2f), 1.0f);
    p.g[i] = smaller(power(-0.052896852f * x + 1.15190313f * y - 0.098961177f * z, 2.2f), 1.0f);
    p.b[i] = smaller(power(-0.052971636f * x - 0.09804345f * y + 1.151073673f * z, 2.2f), 1.0f);
  }
}

}  // namespace

double automatic_exposure(std::span<const Image> images) {
  Histogram histogram{};
  for (const Image& image : images) count(image, histogram);
  if (std::all_of(histogram.begin(), histogram.end(), [](std::uint64_t pixels) { return pixels == 0; })) return 0;
  // The darkest twentieth is shadow and the brightest is sky or glitter: neither tells how bright the scene is.
  const double middle_stops = mean_stops(histogram, 0.05, 0.95);
  // What eyes make of so much light: 1 by day, a fourteenth at the end of civil twilight.
  const auto key = [](double cd_m2) {
    constexpr double ln_10 = 2.302585092994046;
    return 1.03 - 2 / (2 + base::log(cd_m2 + 1) / ln_10);
  };
  constexpr double day_cd_m2 = 2000;  // of land in the sun of noon
  const double cd_m2 = cd_m2_per_unit * base::exp(middle_stops * static_cast<double>(ln_2));
  const double adapted = std::min(1.0, key(cd_m2) / key(day_cd_m2));
  // By day a little lighter than a grey card (0.18), at which pictures of woods look like dusk.
  constexpr double shown = 0.25;
  double wanted = base::log(shown * adapted) / static_cast<double>(ln_2) - middle_stops;
  // Dark woods stay darker than meadows: by a fifth of what they are darker, up to what things of one light differ by.
  constexpr double most_difference_stops = 3;
  const double darker = base::log(shown) / static_cast<double>(ln_2) - middle_stops;
  wanted -= 0.2 * std::clamp(darker, 0.0, most_difference_stops);
  constexpr double most_stops = 14, least_stops = -8;  // by night it stays night
  return std::clamp(wanted, least_stops, most_stops);
}

double automatic_exposure(const Image& image) { return automatic_exposure(std::span(&image, 1)); }

Image land_of(const Frame& frame) {
  constexpr std::size_t least_share = 50;  // a fiftieth of the picture
  if (frame.depth.empty()) return frame.colour;
  Image land;
  for (std::size_t i = 0; i < frame.depth.pixels.size(); ++i) {
    const float* pixel = &frame.colour.pixels[3 * i];
    if (std::isfinite(frame.depth.pixels[i])) land.pixels.insert(land.pixels.end(), pixel, pixel + 3);
  }
  if (land.pixels.size() * least_share < frame.colour.pixels.size()) return frame.colour;
  land.width = static_cast<int>(land.pixels.size() / 3);
  land.height = 1;
  return land;
}

Rgb tone_mapped(const Rgb& light, float scale) {
  Block one{};
  one.r[0] = light.x;
  one.g[0] = light.y;
  one.b[0] = light.z;
  map(one, scale);
  return Rgb(one.r[0], one.g[0], one.b[0]);
}

Image tone_mapped(const Image& light, double exposure_stops) {
  const float scale = static_cast<float>(base::exp(exposure_stops * 0.6931471805599453));
  Image result(light.width, light.height, 3);
  if (light.channels < 3) return result;
  base::parallel_for(static_cast<std::size_t>(light.height), [&](std::size_t row) {
    const int y = static_cast<int>(row), step = static_cast<int>(block);
    for (int first = 0; first < light.width; first += step) {
      const std::size_t count = static_cast<std::size_t>(std::min(step, light.width - first));
      const float* from = light.at(first, y);
      Block pixels{};
      for (std::size_t i = 0; i < count; ++i, from += light.channels) {
        pixels.r[i] = from[0];
        pixels.g[i] = from[1];
        pixels.b[i] = from[2];
      }
      map(pixels, scale);
      float* to = result.at(first, y);
      for (std::size_t i = 0; i < count; ++i, to += 3) {
        to[0] = pixels.r[i];
        to[1] = pixels.g[i];
        to[2] = pixels.b[i];
      }
    }
  });
  return result;
}

namespace {

inline float encoded(float linear) {
  const float x = smaller(larger(linear, 0.0f), 1.0f);
  const float root = 1.055f * base::exp(base::log(larger(x, 0.001f)) * (1 / 2.4f)) - 0.055f;
  return base::select(x <= 0.0031308f, 12.92f * x, base::select(x >= 1, 1.0f, root));
}

}  // namespace

float srgb_encoded(float linear) { return encoded(linear); }

float srgb_decoded(float encoded) {
  if (!(encoded > 0)) return 0;
  return encoded <= 0.04045f ? encoded / 12.92f : base::exp(base::log((encoded + 0.055f) / 1.055f) * 2.4f);
}

namespace {

SILVA_VECTOR_CLONES void encode(const float* from, float* to, std::size_t count, float most) {
  for (std::size_t i = 0; i < count; ++i) to[i] = encoded(from[i]) * most + 0.5f;
}

template <class Whole>
std::vector<Whole> srgb_whole(const Image& linear, float most) {
  std::vector<Whole> whole(linear.pixels.size());
  const std::size_t row = static_cast<std::size_t>(linear.width) * static_cast<std::size_t>(linear.channels);
  base::parallel_for(static_cast<std::size_t>(linear.height), [&](std::size_t y) {
    std::vector<float> values(row);
    encode(linear.pixels.data() + y * row, values.data(), row, most);
    for (std::size_t i = 0; i < row; ++i) whole[y * row + i] = static_cast<Whole>(values[i]);
  });
  return whole;
}

}  // namespace

std::vector<std::uint8_t> srgb_bytes(const Image& linear) { return srgb_whole<std::uint8_t>(linear, 255); }
std::vector<std::uint16_t> srgb_words(const Image& linear) { return srgb_whole<std::uint16_t>(linear, 65535); }

}  // namespace silvavis::image
