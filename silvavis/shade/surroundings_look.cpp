// What the land around a scene looks like; where it is, is told by surroundings.cpp.
#include <algorithm>
#include <array>
#include <cmath>

#include "silvavis/shade/atmosphere.h"
#include "silvavis/shade/patches.h"
#include "silvavis/shade/surroundings.h"

namespace silvavis::shade {

namespace {

// Sines of the heights from which land is looked at.
constexpr std::array<float, Views::heights> sines{0.12f, 0.3f, 0.6f, 0.95f};

float smooth(float x) {
  const float t = std::clamp(x, 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace

V3 Views::direction(std::size_t number) {
  const float turn = 2 * pi * static_cast<float>(number % sides) / sides, sine = sines[number / sides];
  const float level = std::sqrt(1 - sine * sine);
  return {std::sin(turn) * level, std::cos(turn) * level, sine};
}

void Views::smooth() {
  const auto old = shares;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const std::size_t row = i / sides * sides, k = i % sides;
    shares[i] = old[i] * 0.5f + (old[row + (k + 1) % sides] + old[row + (k + sides - 1) % sides]) * 0.25f;
  }
}

Rgb Views::from(const V3& to_eye) const {
  // Looked at from straight above all sides are one.
  const float turn = std::atan2(to_eye.x, to_eye.y) * (sides / (2 * pi)), x = turn - std::floor(turn / sides) * sides;
  const auto i = std::min(static_cast<std::size_t>(x), sides - 1);
  const float s = x - static_cast<float>(i);
  std::size_t row = 0;
  while (row + 2 < heights && to_eye.z > sines[row + 1]) ++row;
  const float t = std::clamp((to_eye.z - sines[row]) / (sines[row + 1] - sines[row]), 0.0f, 1.0f);
  const auto at = [&](std::size_t height) {
    return shares[height * sides + i] * (1 - s) + shares[height * sides + (i + 1) % sides] * s;
  };
  return at(row) * (1 - t) + at(row + 1) * t;
}

double Surroundings::outside_planted(double x, double y) const {
  const double dx = std::max({planted_.west - x, x - planted_.east, 0.0}),
               dy = std::max({planted_.south - y, y - planted_.north, 0.0});
  return std::sqrt(dx * dx + dy * dy);
}

Rgb Surroundings::colour_at(double x, double y, const V3& to_eye, float width_m) const {
  const double away = outside_planted(x, y), width = static_cast<double>(width_m);
  // Woods and fields as large as in the scene, with ragged edges. Noise gathers at its middle; the slope spreads it evenly over all shades.
  const double size = std::clamp(0.12 * spread_m_, 90.0, 1500.0);
  const float field = 0.5f * patches(x, y, size) + 0.32f * patches(x + 877, y - 1409, 0.31 * size) +
                      0.18f * patches(x - 2203, y + 557, 0.08 * size);
  const float place = smooth(0.5f + 2.15f * (field - 0.5f));
  const float at = place * static_cast<float>(usual_.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), usual_.size() - 2);
  const float s = std::clamp(3 * (at - static_cast<float>(i)) - 1, 0.0f, 1.0f);
  Rgb colour = usual_[i] * (1 - s) + usual_[i + 1] * s;
  // Where a ray is wider than fields it sees all of them.
  const auto shown = static_cast<float>(std::clamp(1.8 - width / (0.31 * size), 0.0, 1.0));
  colour = usual_mean_ + (colour - usual_mean_) * shown;
  // The border's own colours end in tongues of all lengths.
  const double reach = std::max(60.0, 0.05 * spread_m_);
  const auto far = static_cast<float>(away / reach) * (0.4f + 1.2f * patches(x - 311, y + 71, 0.7 * reach, width));
  if (far < 1) {
    const Rgb near = mean_near(planted_, x, y, 0.3 * away).colour;
    colour = near + (colour - near) * smooth(far);
  }
  // Crowns and the shade between them, most where it is dark. A ray meets the one or the other, however wide it is, as it does in the
  // scene: so the grain of both is alike.
  const float wooded = 0.5f + (0.5f - place) * shown;
  const float crowns = lumps(x + 17, y - 29, 8) + lumps(x - 43, y + 5, 3) - 1, groups = lumps(x, y, 31, width) - 0.5f;
  const float light = 1 + (0.5f + 1.1f * wooded) * crowns + (0.2f + 0.3f * wooded) * groups;
  return colour * views_.from(to_eye) * std::max(light, 0.1f);
}

}  // namespace silvavis::shade
