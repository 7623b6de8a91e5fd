#include "assets/leaf.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>

namespace assets {

namespace {

using Words = std::initializer_list<std::string_view>;

// Part of a word is enough, since names run together: "LeavesOak", "tree_leaf01".
bool mentions(const std::string& lower, Words words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

}  // namespace

Foliage foliage(const LeafSigns& signs) {
  std::string lower = signs.names;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // A picture with holes called "branch" is a spray of leaves; without holes it is wood.
  const bool wood =
      mentions(lower, {"bark", "trunk", "wood", "log", "stump", "rock", "stone", "cliff", "dirt", "snow", "soil"}) ||
      (!signs.cut_out && mentions(lower, {"branch", "twig", "stem"}));
  if (mentions(lower, {"needle"}) ||
      (signs.cut_out && !wood && mentions(lower, {"pine", "spruce", "conifer", "larch"}))) {
    return Foliage::needle;
  }
  if (mentions(lower, {"leaf", "leav", "foliage", "frond", "fern", "petal", "flower", "blossom", "clover", "ivy"})) {
    return Foliage::leaf;
  }
  if (wood) return Foliage::none;
  if (signs.cut_out || mentions(lower, {"grass"})) return Foliage::leaf;
  const bool green = signs.colour.y > 1.15f * signs.colour.x && signs.colour.y > 1.15f * signs.colour.z;
  return signs.two_sided && green ? Foliage::leaf : Foliage::none;
}

LeafColour leaf_colour(Foliage foliage, const Rgb& colour, const Rgb& texture_mean) {
  LeafColour leaf{colour, Rgb(0.0f, 0.0f, 0.0f)};
  if (foliage == Foliage::none) return leaf;
  const Rgb share = Rgb(0.6f, 0.9f, 0.4f) * (foliage == Foliage::needle ? 0.5f : 1.0f);
  float most = 0;
  for (int c = 0; c < 3; ++c) {
    const float bright = std::clamp(1.5f * texture_mean[c], 0.01f, 1.0f);
    most = std::max(most, (1.0f + share[c]) * colour[c] * bright);
  }
  if (most > 0.95f) leaf.reflectance *= 0.95f / most;
  leaf.transmittance = share * leaf.reflectance;
  return leaf;
}

}  // namespace assets
