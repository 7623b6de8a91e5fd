#include "assets/grown/strip.h"

namespace assets::grown {

void add_ribbon(Model& model, std::span<const Rib> ribs, const Ribbon& ribbon) {
  const auto width = static_cast<std::uint32_t>(ribbon.columns) + 1;
  const auto base = static_cast<std::uint32_t>(model.positions.size());
  const bool pointed = ribs.back().half_width <= 0;
  for (std::size_t r = 0; r < ribs.size(); ++r) {
    const Rib& rib = ribs[r];
    const bool point = pointed && r + 1 == ribs.size();
    for (std::uint32_t c = 0; c < (point ? 1 : width); ++c) {
      const float share = point ? 0.5f : static_cast<float>(c) / static_cast<float>(ribbon.columns);
      const float x = 2 * share - 1;
      model.positions.push_back(rib.middle +
                                (rib.across * x + rib.normal * (std::abs(x) * ribbon.fold)) * rib.half_width);
      model.normals.push_back(unit(rib.normal - rib.across * (x * ribbon.fold), rib.normal));
      model.uvs.push_back({mix(ribbon.u_low, ribbon.u_high, share), rib.v});
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    model.triangles.push_back({base + a, base + b, base + c});
    model.triangle_materials.push_back(ribbon.material);
  };
  const auto rows = static_cast<std::uint32_t>(ribs.size()) - 1;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c + 1 < width; ++c) {
      const std::uint32_t a = r * width + c, d = a + width;
      if (pointed && r + 1 == rows) {
        add(a, a + 1, rows * width);
      } else {
        add(a, a + 1, d + 1);
        add(a, d + 1, d);
      }
    }
  }
}

}  // namespace assets::grown
