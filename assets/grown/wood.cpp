#include "assets/grown/wood.h"

#include <algorithm>

namespace assets::grown {

namespace {

// How finely one axis is drawn.
struct Cut {
  int sides = 0;  // 0: not at all
  int joints = 0;
  std::size_t triangles() const { return static_cast<std::size_t>(sides) * static_cast<std::size_t>(joints) * 2; }
};

Cut cut_of(const Axis& axis, float thickness, float fineness) {
  const float worth = std::sqrt(thickness);  // thickness: share of the thickest stem
  if (axis.order > 0 && worth * fineness < 0.035f) return {};
  Cut cut;
  cut.sides = std::clamp(static_cast<int>(2.2f + 9 * fineness * worth), 3, 28);
  const float joints = static_cast<float>(axis.count - 1) * std::min(1.0f, fineness * (0.25f + worth));
  cut.joints = std::clamp(static_cast<int>(joints + 0.5f), axis.order == 0 ? 3 : 1, static_cast<int>(axis.count) - 1);
  return cut;
}

void add_tube(Model& model, const Skeleton& skeleton, const Axis& axis, const Cut& cut,
              const BarkMaterials& materials) {
  std::vector<Node> rings;
  if (axis.order == 0) {
    // Below the ground by two radii and 0.3 m, straight on.
    const Node& foot = skeleton.nodes[axis.first];
    rings.push_back({foot.position - V3(0, 0, 2 * foot.radius + 0.3f), foot.radius});
  }
  for (int j = 0; j <= cut.joints; ++j) {
    const auto i = static_cast<std::uint32_t>(j) * (axis.count - 1) / static_cast<std::uint32_t>(cut.joints);
    rings.push_back(skeleton.nodes[axis.first + i]);
  }
  // The texture runs around once for thin branches, a whole number of times for thick ones, with square texels.
  const float girth = 2 * pi * rings.front().radius;
  const float around = std::max(1.0f, std::round(girth / 1.2f));
  const float per_metre = around / std::max(girth, 1e-4f);
  const auto base = static_cast<std::uint32_t>(model.positions.size());
  const auto ring_size = static_cast<std::uint32_t>(cut.sides) + 1;
  V3 u = across(unit(rings[1].position - rings[0].position));
  float v = 0;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const V3 before = rings[r == 0 ? 0 : r - 1].position, after = rings[std::min(r + 1, rings.size() - 1)].position;
    const V3 along = unit(after - before);
    u = beside(u, along);
    const V3 w = along.cross(u);
    if (r > 0) v += length_of(rings[r].position - before) * std::min(per_metre, 2.0f);
    for (std::uint32_t k = 0; k < ring_size; ++k) {
      const float share = static_cast<float>(k % static_cast<std::uint32_t>(cut.sides)) / static_cast<float>(cut.sides);
      const SinCos a = sin_cos(2 * pi * share);
      const V3 out = u * a.cos + w * a.sin;
      model.positions.push_back(rings[r].position + out * rings[r].radius);
      model.normals.push_back(unit(out));
      model.uvs.push_back({around * static_cast<float>(k) / static_cast<float>(cut.sides), -v});
    }
  }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r) {
    const float z = rings[r].position.z;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(cut.sides); ++k) {
      const std::uint32_t a = base + r * ring_size + k, b = a + 1, c = a + ring_size, d = c + 1;
      // The change of bark has a ragged edge.
      const float edge = materials.upper_from_m + (k % 2 == 0 ? 0.0f : 0.6f);
      std::uint16_t material = z > edge ? materials.upper : materials.lower;
      if (axis.order > 0 && rings.front().radius < 0.012f) material = materials.twig;
      model.triangles.push_back({a, b, d});
      model.triangles.push_back({a, d, c});
      model.triangle_materials.insert(model.triangle_materials.end(), 2, material);
    }
  }
}

}  // namespace

std::size_t add_wood(Model& model, const Skeleton& skeleton, const BarkMaterials& materials,
                     std::size_t most_triangles) {
  float thickest = 1e-6f;
  for (const Axis& axis : skeleton.axes) thickest = std::max(thickest, skeleton.nodes[axis.first].radius);
  const auto cuts = [&](float fineness, auto&& use) {
    std::size_t sum = 0;
    for (const Axis& axis : skeleton.axes) {
      const Cut cut = cut_of(axis, skeleton.nodes[axis.first].radius / thickest, fineness);
      sum += cut.triangles() + (axis.order == 0 ? static_cast<std::size_t>(cut.sides) * 2 : 0);
      use(axis, cut);
    }
    return sum;
  };
  // The finest cut that is within the budget.
  float low = 0.02f, high = 4;
  for (int i = 0; i < 14; ++i) {
    const float middle = std::sqrt(low * high);
    (cuts(middle, [](const Axis&, const Cut&) {}) <= most_triangles ? low : high) = middle;
  }
  return cuts(low, [&](const Axis& axis, const Cut& cut) {
    if (cut.sides > 0) add_tube(model, skeleton, axis, cut, materials);
  });
}

}  // namespace assets::grown
