#include "silvavis/shade/land.h"

#include <algorithm>
#include <cmath>

#include "silvavis/shade/grain.h"
#include "silvavis/shade/patches.h"

namespace silvavis::shade {

namespace {

Rgb mixed(const Rgb& a, const Rgb& b, float share) { return a * (1 - share) + b * share; }

float step_between(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// What lies under plants: litter, moss where it stays moist, bare humus at the feet of stems.
Rgb floor_of_wood(float middling, float fine, float foot) {
  const Rgb litter(0.086f, 0.062f, 0.037f), old_litter(0.050f, 0.038f, 0.024f), moss(0.038f, 0.056f, 0.018f),
      herbs(0.036f, 0.066f, 0.020f);
  Rgb colour = mixed(litter, old_litter, step_between(0.3f, 0.7f, fine));
  colour = mixed(colour, moss, 0.8f * step_between(0.52f, 0.68f, middling));
  colour = mixed(colour, herbs, 0.75f * step_between(0.46f, 0.30f, middling) * step_between(0.35f, 0.6f, fine));
  return mixed(colour, moss * 0.8f, 0.6f * std::max(foot, 0.0f));
}

// Grass where it is gentle; earth, scree and rock where it is steep; less lush and stonier the higher it lies.
Rgb plain_look(double x, double y, const V3& up, double height_m, const Crowns& crowns, double width_m) {
  const Rgb meadow(0.050f, 0.075f, 0.021f), pasture(0.076f, 0.088f, 0.034f), dry(0.132f, 0.118f, 0.058f),
      turf(0.094f, 0.096f, 0.046f), earth(0.096f, 0.074f, 0.050f), scree(0.158f, 0.150f, 0.134f),
      rock(0.172f, 0.168f, 0.158f);
  const float steepness = std::sqrt(std::max(0.0f, 1 - up.z * up.z)) / std::max(up.z, 0.05f);
  const float wide = patches(x, y, 160, width_m), middling = patches(x + 4211, y + 977, 24, width_m),
              fine = patches(x + 7919, y - 104729, 5, width_m);
  Rgb colour = mixed(meadow, pasture, step_between(0.35f, 0.65f, 0.6f * wide + 0.4f * middling));
  // What the sun dries: southern slopes, and patches of them anywhere.
  const float sunny = std::clamp(0.5f - 0.9f * up.y, 0.0f, 1.0f);
  colour = mixed(colour, dry, 0.7f * step_between(0.62f, 0.85f, 0.45f * wide + 0.3f * middling + 0.45f * sunny));
  // Between the highest meadows and what is bare, about the middle latitudes' 1500 to 2600 m.
  const auto height = static_cast<float>(height_m) + 300 * (wide - 0.5f);
  colour = mixed(colour, turf, step_between(1200, 2000, height));
  // Between trees something grows.
  GroundParts parts;
  const auto lay = [&](const Rgb& what, float& part, float share) {
    colour = mixed(colour, what, share);
    for (float* other : {&parts.grass, &parts.litter, &parts.earth, &parts.scree, &parts.rock}) *other *= 1 - share;
    part += share;
  };
  const float open = 1 - 0.85f * crowns.near;
  lay(earth, parts.earth, 0.55f * open * step_between(0.40f, 0.75f, steepness + 0.5f * (fine - 0.5f)));
  const float bare = step_between(2000, 2700, height) + 0.2f * step_between(1400, 2200, height);
  lay(scree, parts.scree, 0.85f * open * step_between(0.55f, 1.0f, steepness + 0.6f * (middling - 0.5f) + 0.5f * bare));
  lay(rock, parts.rock, open * step_between(0.75f, 1.15f, steepness + 0.35f * (middling + fine - 1)));
  colour *= 0.86f + 0.28f * fine;
  lay(floor_of_wood(middling, fine, crowns.foot), parts.litter, std::max(crowns.cover, 0.5f * crowns.near));
  return colour * grain(parts, x, y, width_m);
}

}  // namespace

Rgb land_colour(const Land& land, double x, double y, const V3& up, double height_m, const Crowns& crowns,
                double width_m) {
  const silvasim::base::Box& box = land.drape_box;
  if (land.drape.empty() || !box.contains({x, y})) return plain_look(x, y, up, height_m, crowns, width_m);
  const double u = (x - box.west) / box.width() * land.drape.width,
               v = (box.north - y) / box.height() * land.drape.height;
  const auto pixel = [&](int i, int j) {
    const float* at = land.drape.at(std::clamp(i, 0, land.drape.width - 1), std::clamp(j, 0, land.drape.height - 1));
    return Rgb(at[0], at[1], at[2]);
  };
  if (!land.smooth) {
    // A class says what kind of ground, not that it is even.
    const float uneven = 0.80f + 0.40f * (0.5f * patches(x + 4211, y + 977, 24, width_m) +
                                          0.5f * patches(x + 7919, y - 104729, 5, width_m));
    return pixel(static_cast<int>(u), static_cast<int>(v)) * grain({}, x, y, width_m) *
           (uneven * (1 - 0.35f * crowns.cover));
  }
  const double left = std::floor(u - 0.5), top = std::floor(v - 0.5);
  const auto s = static_cast<float>(u - 0.5 - left), t = static_cast<float>(v - 0.5 - top);
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  return mixed(mixed(pixel(i, j), pixel(i + 1, j), s), mixed(pixel(i, j + 1), pixel(i + 1, j + 1), s), t);
}

bool is_water(const Land& land, double x, double y) {
  if (land.water.empty() || !land.water_box.contains({x, y})) return false;
  const int i = std::min(static_cast<int>((x - land.water_box.west) / land.water_box.width() * land.water_columns),
                         land.water_columns - 1);
  const int j = std::min(static_cast<int>((land.water_box.north - y) / land.water_box.height() * land.water_rows),
                         land.water_rows - 1);
  return land.water[static_cast<std::size_t>(j) * static_cast<std::size_t>(land.water_columns) +
                    static_cast<std::size_t>(i)] != 0;
}

}  // namespace silvavis::shade
