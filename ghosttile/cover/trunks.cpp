#include "ghosttile/cover/trunks.h"

#include <algorithm>

namespace ghosttile::cover {

std::vector<density::Node> trunks(const Chosen& chosen, const density::Box3& box, const TrunkOptions& options) {
  std::vector<density::Node> nodes;
  const Plants& plants = *chosen.plants;
  // A layer's thickest stem is at most its widest crown's of any species.
  std::vector<float> thickest(plants.layer_count(), 0.0f);
  for (std::size_t s = 0; s < plants.species().size(); ++s) {
    if (!chosen.selection.species[s]) continue;
    const std::size_t layer = plants.species()[s].layer;
    const Stem widest{0, 0, chosen.selection.layers[layer].most_radius_m, static_cast<std::uint32_t>(s)};
    thickest[layer] = std::max(thickest[layer], plants.stem_radius_m(widest));
  }
  const Box flat{box.least.x, box.least.y, box.most.x, box.most.y};
  for (std::size_t l = 0; l < plants.layer_count(); ++l) {
    const Box around = grown(flat, static_cast<double>(thickest[l] + options.gap_m));
    plants.for_each(l, around, chosen.selection, [&](const Stem& stem) {
      const float radius = plants.stem_radius_m(stem);
      if (radius < options.least_m) return true;
      const double wide = static_cast<double>(radius + options.gap_m);
      const double beside_x = std::max({flat.west - stem.x_m, stem.x_m - flat.east, 0.0});
      const double beside_y = std::max({flat.south - stem.y_m, stem.y_m - flat.north, 0.0});
      if (beside_x * beside_x + beside_y * beside_y > wide * wide) return true;
      const double ground = silvasim::ecosystem::height_at(plants.ecosystem().terrain, {stem.x_m, stem.y_m});
      const double foot = ground - static_cast<double>(options.foot_m);
      const double top = ground + static_cast<double>(options.height_share * plants.height_m(stem));
      if (top < box.least.z || foot > box.most.z) return true;
      density::Node node;
      node.kind = density::Kind::cylinder;
      node.points = {{stem.x_m, stem.y_m, foot}, {stem.x_m, stem.y_m, top}};
      node.size = {wide, 0, 0};
      nodes.push_back(std::move(node));
      return true;
    });
  }
  return nodes;
}

}  // namespace ghosttile::cover
