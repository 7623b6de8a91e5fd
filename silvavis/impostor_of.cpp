#include "silvavis/impostor_of.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"

namespace silvavis {

namespace {

using scene::Impostor;
using scene::ImpostorView;

constexpr double texels_from_side = 1000;  // of a grid seen from the side, about
constexpr int rays_across = 2, rays_a_texel = rays_across * rays_across;
constexpr int shades_a_texel = 2;  // of the maps of depth towards the lamps, along a texel's side

void set_measures(const scene::PlantModel& model, Impostor& impostor) {
  impostor.radius_m = std::max(model.reach_m, 1e-3f) * 1.001f;
  impostor.least_m = model.least.z;
  impostor.most_m = std::max(model.most.z, model.least.z + 1e-3f);
  const double width = 2 * static_cast<double>(impostor.radius_m),
               height = static_cast<double>(impostor.most_m - impostor.least_m);
  // From above, mats that are far wider than high would need texels without end.
  impostor.texel_m =
      static_cast<float>(std::max({std::sqrt(width * height / texels_from_side), height / 200, width / 100}));
  impostor.columns =
      std::max(2u, static_cast<std::uint32_t>(std::lround(width / static_cast<double>(impostor.texel_m))));
  std::uint32_t texels = 0;
  for (int e = 0; e < Impostor::elevations; ++e) {
    const ImpostorView view(impostor, scene::impostor_direction(e, 0));
    const auto k = static_cast<std::size_t>(e);
    impostor.rows[k] =
        std::max(2u, static_cast<std::uint32_t>(std::lround((view.top_m - view.bottom_m) / impostor.texel_m)));
    impostor.first[k] = texels;
    texels += impostor.rows[k] * impostor.columns * Impostor::sides;
  }
  impostor.covered.resize(texels);
  impostor.points.resize(texels);
}

// How deep the light of each lamp reaches into the model, over a grid finer than an impostor's.
class Shades {
 public:
  Shades(const scene::PlantModel& model, const Impostor& impostor) : bias_m_(0.5f * model.leaf_m) {
    std::vector<accel::ModelRay> rays;
    std::vector<accel::ModelPoint> met;
    for (int lamp = 0; lamp < Impostor::lamp_bands * Impostor::lamp_azimuths; ++lamp) {
      const V3 direction = -scene::lamp_direction(lamp / Impostor::lamp_azimuths, lamp % Impostor::lamp_azimuths);
      Map map{ImpostorView(impostor, direction), direction, impostor.columns * shades_a_texel, 0, {}};
      map.rows = static_cast<std::uint32_t>(
          std::max(2.0f, (map.view.top_m - map.view.bottom_m) / impostor.texel_m * shades_a_texel));
      rays.clear();
      for (std::uint32_t row = 0; row < map.rows; ++row) {
        for (std::uint32_t column = 0; column < map.columns; ++column) {
          const float across =
              ((static_cast<float>(column) + 0.5f) / static_cast<float>(map.columns) * 2 - 1) * impostor.radius_m;
          const float up = map.view.bottom_m + (static_cast<float>(row) + 0.5f) / static_cast<float>(map.rows) *
                                                   (map.view.top_m - map.view.bottom_m);
          rays.push_back({map.view.point(across, up), direction, -1e30f});
        }
      }
      met.resize(rays.size());
      accel::trace_model(model, rays, met);
      map.depths_m.resize(met.size());
      for (std::size_t i = 0; i < met.size(); ++i) map.depths_m[i] = met[i].t;
      maps_.push_back(std::move(map));
    }
    radius_m_ = impostor.radius_m;
  }

  // The lamps whose light ends before the point.
  std::uint32_t barred(const V3& at) const {
    std::uint32_t bits = 0;
    for (std::size_t lamp = 0; lamp < maps_.size(); ++lamp) {
      const Map& map = maps_[lamp];
      const float x = (map.view.across_m(at) / radius_m_ + 1) * 0.5f * static_cast<float>(map.columns);
      const float y =
          (map.view.up_m(at) - map.view.bottom_m) / (map.view.top_m - map.view.bottom_m) * static_cast<float>(map.rows);
      const auto column = static_cast<std::uint32_t>(std::clamp(x, 0.0f, static_cast<float>(map.columns - 1)));
      const auto row = static_cast<std::uint32_t>(std::clamp(y, 0.0f, static_cast<float>(map.rows - 1)));
      if (map.depths_m[row * map.columns + column] < at.dot(map.direction) - bias_m_) bits |= 1u << lamp;
    }
    return bits;
  }

 private:
  struct Map {
    ImpostorView view;
    V3 direction;
    std::uint32_t columns, rows;
    std::vector<float> depths_m;  // row by row; infinite: nothing there
  };
  std::vector<Map> maps_;
  float bias_m_, radius_m_ = 1;
};

}  // namespace

Impostor impostor_of(const scene::PlantModel& model) {
  Impostor impostor;
  set_measures(model, impostor);
  const Shades shades(model, impostor);
  std::array<accel::ModelRay, rays_a_texel> rays;
  std::array<accel::ModelPoint, rays_a_texel> met;
  std::uint32_t texel = 0;
  for (int elevation = 0; elevation < Impostor::elevations; ++elevation) {
    for (int side = 0; side < Impostor::sides; ++side) {
      const V3 direction = scene::impostor_direction(elevation, side);
      const ImpostorView view(impostor, direction);
      const std::uint32_t rows = impostor.rows[static_cast<std::size_t>(elevation)];
      const float wide = 2 * impostor.radius_m / static_cast<float>(impostor.columns),
                  high = (view.top_m - view.bottom_m) / static_cast<float>(rows);
      for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < impostor.columns; ++column, ++texel) {
          silvasim::base::Stream random(0, silvasim::base::Purpose::impostor, texel);
          for (std::size_t i = 0; i < rays_a_texel; ++i) {
            const float x = (static_cast<float>(i % rays_across) + random.next_float()) / rays_across,
                        y = (static_cast<float>(i / rays_across) + random.next_float()) / rays_across;
            rays[i] = {view.point((static_cast<float>(column) + x) * wide - impostor.radius_m,
                                  view.bottom_m + (static_cast<float>(row) + y) * high),
                       direction, -1e30f};
          }
          accel::trace_model(model, rays, met);
          // One of those that met something, each as likely as the others.
          std::uint32_t count = 0;
          std::size_t kept = 0;
          for (std::size_t i = 0; i < met.size(); ++i) {
            if (std::isfinite(met[i].t) && random.next_below(++count) == 0) kept = i;
          }
          impostor.covered[texel] = static_cast<std::uint8_t>((count * 255 + rays_a_texel / 2) / rays_a_texel);
          if (count == 0) continue;
          Impostor::Point& point = impostor.points[texel];
          point.slot = met[kept].slot;
          point.depth_m = met[kept].t;
          point.u = static_cast<std::uint16_t>(std::lround(met[kept].u * 65535));
          point.v = static_cast<std::uint16_t>(std::lround(met[kept].v * 65535));
          point.barred = shades.barred(rays[kept].origin + direction * met[kept].t);
        }
      }
    }
  }
  return impostor;
}

}  // namespace silvavis
