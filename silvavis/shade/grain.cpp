#include "silvavis/shade/grain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "silvavis/shade/patches.h"

namespace silvavis::shade {

namespace {

// Means of Flake::inside, over the plane: what gaps take away.
constexpr float mean_inside = 0.637f;

// How much is left of what is `size_m` wide.
float shown(double size_m, double width_m) { return static_cast<float>(std::clamp(1.8 - width_m / size_m, 0.0, 1.0)); }

// Cells that differ by `tones`, with gaps between them that are darker by `gaps`.
float cells(double x, double y, double size_m, double width_m, float tones, float gaps) {
  const float there = shown(size_m, width_m);
  if (there <= 0) return 0;
  const Flake one = flake(x, y, size_m);
  return there * (tones * (one.tone - 0.5f) + gaps * (one.inside - mean_inside));
}

// Long and thin: in each tuft another way. One way a tuft, because turning a place by an angle that varies would squeeze the blades the
// more the farther the place is from the scene's origin.
float blades(double x, double y, double width_m) {
  constexpr double wide_m = 0.025, long_m = 0.28, tuft_m = 0.4;
  const float there = shown(1.5 * wide_m, width_m);
  if (there <= 0) return 0;
  float sum = 0;
  for (int layer = 0; layer < 2; ++layer) {
    const double shift = 37.7 * layer;
    const float turn = 6.2831853f * flake(x + shift, y - shift, tuft_m).tone, c = std::cos(turn), s = std::sin(turn);
    const double u = static_cast<double>(c) * x + static_cast<double>(s) * y,
                 v = static_cast<double>(c) * y - static_cast<double>(s) * x;
    sum += lumps(u * (wide_m / long_m) + shift, v, wide_m) - 0.5f;
  }
  return there * sum;
}

Rgb grass(double x, double y, double width_m) {
  const float clumps = patches(x + 331, y - 57, 1.7, width_m) - 0.5f;
  const float tussocks = patches(x - 5, y + 3, 0.4, width_m) - 0.5f,
              tufts = patches(x + 3, y - 8, 0.11, width_m) - 0.5f;
  const float blade = blades(x, y, width_m);
  // Some is dry; lit blades are yellower than the shade between them.
  const float light = 1 + 0.5f * clumps + 0.8f * tussocks + 0.8f * tufts + 1.2f * blade;
  const float dry = 0.5f * (patches(x - 77, y + 31, 0.7, width_m) - 0.5f) + 0.3f * blade;
  return Rgb(1 + 0.5f * dry, 1, 1 - 0.2f * dry) * std::max(light, 0.12f);
}

Rgb litter(double x, double y, double width_m) {
  const float heaps = patches(x + 331, y - 57, 1.1, width_m) - 0.5f;
  const float leaf = cells(x, y, 0.075, width_m, 1.0f, 0.5f), small = cells(x + 7, y - 3, 0.031, width_m, 0.6f, 0.2f);
  const float light = 1 + 0.6f * heaps + leaf + small;
  return Rgb(1 + 0.25f * leaf, 1, 1 - 0.2f * leaf) * std::max(light, 0.15f);
}

float earth(double x, double y, double width_m) {
  return std::max(0.3f, 1 + 0.8f * (patches(x + 331, y - 57, 0.9, width_m) - 0.5f) +
                            0.7f * (patches(x - 13, y + 91, 0.07, width_m) - 0.5f));
}

float scree(double x, double y, double width_m) {
  return std::max(0.2f, 1 + 0.6f * (patches(x + 331, y - 57, 2.3, width_m) - 0.5f) +
                            cells(x, y, 0.42, width_m, 0.5f, 0.55f) + cells(x - 9, y + 4, 0.12, width_m, 0.4f, 0.35f));
}

float rock(double x, double y, double width_m) {
  return std::max(0.25f, 1 + 0.7f * (patches(x + 331, y - 57, 3.7, width_m) - 0.5f) +
                             cells(x, y, 2.6, width_m, 0.25f, 0.3f) +
                             0.5f * (patches(x - 613, y + 91, 0.25, width_m) - 0.5f));
}

}  // namespace

Flake flake(double x, double y, double size_m) {
  const double u = x / size_m, v = y / size_m, fu = std::floor(u), fv = std::floor(v);
  const auto i = static_cast<std::int32_t>(fu), j = static_cast<std::int32_t>(fv);
  const auto s = static_cast<float>(u - fu), t = static_cast<float>(v - fv);
  float nearest = 9, second = 9;
  Flake found;
  for (int dj = -1; dj <= 1; ++dj) {
    for (int di = -1; di <= 1; ++di) {
      const std::uint32_t hash = place_hash(i + di, j + dj);
      const float a = static_cast<float>(di) + static_cast<float>(hash >> 24) * (1.0f / 256) - s,
                  b = static_cast<float>(dj) + static_cast<float>(hash >> 16 & 255) * (1.0f / 256) - t;
      const float away = a * a + b * b;
      if (away < nearest) {
        second = nearest;
        nearest = away;
        found.tone = static_cast<float>(hash & 0xFFFF) * (1.0f / 65536);
      } else {
        second = std::min(second, away);
      }
    }
  }
  found.inside = std::min(1.0f, 3 * (std::sqrt(second) - std::sqrt(nearest)));
  return found;
}

Rgb grain(const GroundParts& parts, double x, double y, double width_m) {
  Rgb sum(0, 0, 0);
  constexpr float least = 0.02f;  // less is not seen
  const auto add = [&](float share, const auto& look) {
    sum += share < least ? Rgb(share) : Rgb(look(x, y, width_m)) * share;
  };
  add(parts.grass, grass);
  add(parts.litter, litter);
  add(parts.earth, earth);
  add(parts.scree, scree);
  add(parts.rock, rock);
  return sum;
}

}  // namespace silvavis::shade
