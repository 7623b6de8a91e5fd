// Plants into pixels: discs where crowns are wide enough, else the share of each pixel that crowns cover.
//
// Promise: a pixel's value is summed in file order by one thread, whatever the threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "silvasim/export/ground.h"
#include "silvasim/export/heat.h"
#include "silvasim/export/view.h"

namespace silvasim::exports {

enum class Style {
  crowns,  // discs with outlines
  cover,   // mixed by coverage
};

// Crowns from this mean radius on.
inline constexpr double least_crown_radius_px = 2.2;

inline Style style_of(const Census& census, const View& view) {
  const bool wide = census.mean_radius_m * view.px_per_m() >= least_crown_radius_px;
  return wide || census.plants == 0 ? Style::crowns : Style::cover;
}

// How opaque a forest looks whose crowns cover this share of the ground: 1 - (1 - covered)^boldness. A closed stand of
// discs covers little more than half of it, and a thinned one a fifth, yet both should show the legend's colours; so
// the map is bolder than the ground is covered where crowns are smaller than pixels.
inline float opacity(float covered, int boldness) {
  const float bare = 1 - std::min(covered, 1.0f);
  float left = 1;
  for (int i = 0; i < boldness; ++i) left *= bare;
  return 1 - left;
}

inline constexpr int most_boldness = 5;  // also of hexagons

inline int boldness_of(double radius_px, Subject subject) {
  const int bold = static_cast<int>(std::clamp(std::round(6.2 - 2.4 * radius_px), 1.0, double(most_boldness)));
  // A single species' plants stand far apart.
  return subject == Subject::probability ? 2 * bold : bold;
}

// Outlines and stems, the same in both kinds of picture.
inline float outline_px(float radius_px) { return std::clamp(radius_px * 0.16f, 0.5f, 1.6f); }
inline float stem_radius_px(float radius_px) { return radius_px < 9 ? 0 : std::min(radius_px * 0.09f, 3.0f); }

// Row by row from the north-west, three bytes a pixel.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

Pixels draw_ground(const View& view, const Ground& ground);

// The ramp's colours in the relief's light; ground where nothing can grow.
Pixels draw_heat(const View& view, const Ground& ground, const Heat& heat);

Pixels draw_map(const ecosystem::Ecosystem& ecosystem, const Census& census, const View& view, const Ground& ground,
                Subject subject);

}  // namespace silvasim::exports
