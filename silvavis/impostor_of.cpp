#include "silvavis/impostor_of.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"

namespace silvavis {

namespace {

using scene::Impostor;
using scene::ImpostorView;

constexpr double texels_from_side = 1000;                                         // of a grid seen from the side, about
constexpr std::size_t rays_across = 4, rays_a_block = rays_across * rays_across;  // of four texels

Impostor empty_impostor(const scene::PlantModel& model) {
  Impostor impostor;
  impostor.radius_m = std::max(model.reach_m, 1e-3f) * 1.001f;
  impostor.least_m = model.least.z;
  impostor.most_m = std::max(model.most.z, model.least.z + 1e-3f);
  const double width = 2 * static_cast<double>(impostor.radius_m),
               height = static_cast<double>(impostor.most_m - impostor.least_m);
  // From above, mats that are far wider than high would need texels without end.
  impostor.texel_m =
      static_cast<float>(std::max({std::sqrt(width * height / texels_from_side), height / 200, width / 90}));
  const auto even = [&](double length) {
    return 2 *
           std::max(1u, static_cast<std::uint32_t>(std::lround(length / static_cast<double>(impostor.texel_m) / 2)));
  };
  impostor.columns = even(width);
  std::uint32_t texels = 0;
  for (int e = 0; e < Impostor::elevations; ++e) {
    const ImpostorView view(impostor, scene::impostor_direction(e, 0));
    const auto k = static_cast<std::size_t>(e);
    impostor.rows[k] = even(static_cast<double>(view.top_m - view.bottom_m));
    impostor.first[k] = texels;
    texels += impostor.rows[k] * impostor.columns * Impostor::sides;
  }
  impostor.covered.resize(texels);
  impostor.points.resize(texels / 4 * Impostor::points_a_block);
  return impostor;
}

void keep(const scene::PlantModel& model, const accel::ModelRay& ray, Impostor::Point& point) {
  accel::ModelPoint met;
  accel::trace_model(model, std::span(&ray, 1), std::span(&met, 1));
  point.slot = met.slot;
  point.depth_m = met.t;
  point.u = static_cast<std::uint16_t>(std::lround(met.u * 65535));
  point.v = static_cast<std::uint16_t>(std::lround(met.v * 65535));
}

// The texels of one grid and their points.
void fill(const scene::PlantModel& model, int elevation, int side, Impostor& impostor) {
  const V3 direction = scene::impostor_direction(elevation, side);
  const ImpostorView view(impostor, direction);
  const std::uint32_t rows = impostor.rows[static_cast<std::size_t>(elevation)], columns = impostor.columns;
  const std::uint32_t first =
      impostor.first[static_cast<std::size_t>(elevation)] + static_cast<std::uint32_t>(side) * rows * columns;
  const float wide = 2 * impostor.radius_m / static_cast<float>(columns),
              high = (view.top_m - view.bottom_m) / static_cast<float>(rows);
  std::array<accel::ModelRay, rays_a_block> rays;
  std::array<std::uint8_t, rays_a_block> met;
  for (std::uint32_t row = 0; row < rows; row += 2) {
    for (std::uint32_t column = 0; column < columns; column += 2) {
      const std::uint32_t block = first / 4 + row / 2 * (columns / 2) + column / 2;
      silvasim::base::Stream random(0, silvasim::base::Purpose::impostor, block);
      for (std::size_t i = 0; i < rays_a_block; ++i) {
        const float x = (static_cast<float>(i % rays_across) + random.next_float()) * (2.0f / rays_across),
                    y = (static_cast<float>(i / rays_across) + random.next_float()) * (2.0f / rays_across);
        rays[i] = {view.point((static_cast<float>(column) + x) * wide - impostor.radius_m,
                              view.bottom_m + (static_cast<float>(row) + y) * high),
                   direction, -1e30f};
      }
      // Whether anything is there is asked of all rays, what it is only of those that are kept.
      accel::bar_model(model, rays, met);
      std::array<std::uint32_t, 4> hits{};
      std::array<std::size_t, rays_a_block> order;  // of those that met something, by chance
      std::uint32_t count = 0;
      for (std::size_t i = 0; i < rays_a_block; ++i) {
        if (!met[i]) continue;
        ++hits[i / (rays_a_block / 2) * 2 + i % rays_across / (rays_across / 2)];
        order[count] = i;
        std::swap(order[count], order[random.next_below(count + 1)]);
        ++count;
      }
      constexpr std::uint32_t rays_a_texel = rays_a_block / 4;
      for (std::uint32_t k = 0; k < 4; ++k)
        impostor.covered[first + (row + k / 2) * columns + column + k % 2] =
            static_cast<std::uint8_t>((hits[k] * 255 + rays_a_texel / 2) / rays_a_texel);
      if (count == 0) continue;
      for (std::uint32_t k = 0; k < Impostor::points_a_block; ++k) {
        Impostor::Point& point = impostor.points[block * Impostor::points_a_block + k];
        // A point at a hole's rim may be rounded into the hole: then the next ray's counts.
        for (std::uint32_t next = 0; next < count; ++next) {
          keep(model, rays[order[(k + next) % count]], point);
          if (!scene::is_hole(model, point.slot, point.weight_1(), point.weight_2())) break;
        }
      }
    }
  }
}

}  // namespace

Impostor impostor_of(const scene::PlantModel& model) {
  Impostor impostor = empty_impostor(model);
  for (int elevation = 0; elevation < Impostor::elevations; ++elevation)
    for (int side = 0; side < Impostor::sides; ++side) fill(model, elevation, side, impostor);
  return impostor;
}

}  // namespace silvavis
