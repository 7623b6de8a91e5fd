#include "silvavis/ground_details.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include "silvasim/base/parallel.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"
#include "silvavis/accel/pack.h"
#include "silvavis/levels/thin.h"
#include "silvavis/shade/surface.h"

namespace silvavis {

namespace {

// Simpler levels, each an eighth of the one before, of what has leaves enough. There is no impostor: those know plants upright only.
std::shared_ptr<const scene::PlantModel> packed_detail(const assets::Model& model, bool levels) {
  auto full = std::make_shared<scene::PlantModel>(accel::pack(model));
  full->leaf_m = levels::leaf_size(model);
  if (!levels) return full;
  for (double share = 1.0 / 8; static_cast<double>(model.triangles.size()) * share > 60; share /= 8) {
    const levels::Thinned simpler = levels::thinned(model, share);
    if (simpler.model.triangles.size() < 8) break;
    auto level = std::make_shared<scene::PlantModel>(accel::pack(simpler.model, full->looks));
    level->leaf_m = full->leaf_m * std::max(simpler.enlarged, static_cast<float>(0.7 / std::sqrt(share)));
    full->coarser.push_back(std::move(level));
  }
  return full;
}

struct Spot {
  V3d at;           // of a column of tiles: anywhere on the ground there
  float depth = 0;  // DetailColumn::depth in metres squared a metre squared
  Rgb colour{0, 0, 0};
};

// About so many columns, evenly over all.
std::vector<Spot> some_columns(const scene::Ground& ground, const scene::DetailLayer& layer, std::size_t count) {
  std::vector<Spot> spots;
  silvasim::base::Stream random(1, silvasim::base::Purpose::picture, 7);
  const std::size_t step = std::max<std::size_t>(1, layer.columns.size() / count);
  const auto list = [&](auto& self, std::uint32_t index, int level, int column, int row) -> void {
    const scene::DetailNode& node = layer.nodes[index];
    std::uint32_t child = node.first;
    for (std::uint32_t bits = node.children; bits != 0; bits &= bits - 1, ++child) {
      const int at = std::countr_zero(bits), x = column * 4 + (at & 3), y = row * 4 + (at >> 2);
      if (level > 0) {
        self(self, child, level - 1, x, y);
        continue;
      }
      if (child % step != 0) continue;
      const scene::DetailColumn& own = layer.columns[child];
      const auto k = static_cast<std::size_t>(at);
      Spot spot;
      spot.at.x = layer.corner.x + (x + random.next_double()) * layer.side_m;
      spot.at.y = layer.corner.y + (y + random.next_double()) * layer.side_m;
      spot.at.z = std::clamp(scene::ground_at(ground, spot.at.x, spot.at.y).height_m,
                             static_cast<double>(node.least_m[k]), static_cast<double>(node.most_m[k]));
      spot.depth = static_cast<float>(own.depth) * scene::detail_depth_step;
      for (int c = 0; c < 3; ++c) {
        const float root = static_cast<float>(own.colour[static_cast<std::size_t>(c)]) * (1.0f / 255);
        spot.colour[c] = root * root;
      }
      spots.push_back(spot);
    }
  };
  list(list, 0, layer.levels - 1, 0, 0);
  return spots;
}

// Where from: straight down, and as one sees far land from a flight or a hill. Suns and a sky as the light of level_light.h.
const V3 views[] = {V3(0, 0, -1), V3(0.94f, 0, -0.342f), V3(-0.66f, 0.67f, -0.342f), V3(-0.3f, -0.89f, -0.342f)};
struct Lamp {
  V3 towards;
  float light;
};
const Lamp lamps[] = {
    {V3(0.75f, 0.433f, 0.5f), 0.5f}, {V3(-0.196f, -0.539f, 0.819f), 0.5f}, {V3(0, 0, 1), 0.1f},
    {V3(0.8f, 0.2f, 0.566f), 0.06f}, {V3(-0.7f, 0.5f, 0.51f), 0.06f},      {V3(-0.3f, -0.85f, 0.433f), 0.06f},
    {V3(0.2f, 0.9f, 0.387f), 0.06f}};

// Light that comes to a surface, by the lamps that no detail bars: on its front, on its back.
struct Lit {
  float front = 0, back = 0;
};
Lit lit(const scene::Scene& probe, const V3d& at, const V3& normal, const V3& plane, double lift_m) {
  accel::Ray rays[std::size(lamps)];
  accel::Hit hits[std::size(lamps)];
  for (std::size_t k = 0; k < std::size(lamps); ++k) {
    rays[k].direction = lamps[k].towards.normalized();
    rays[k].origin = at + V3d(plane) * (plane.dot(rays[k].direction) > 0 ? lift_m : -lift_m);
  }
  accel::trace_details(probe, rays, hits);
  Lit sum;
  for (std::size_t k = 0; k < std::size(lamps); ++k) {
    if (hits[k].surface != accel::Surface::none) continue;
    const float facing = normal.dot(rays[k].direction);
    (facing > 0 ? sum.front : sum.back) += std::abs(facing) * lamps[k].light;
  }
  return sum;
}

// How much of the ground details hide, how bright they are among each other, and how much they shade what they do not hide,
// measured in the layer itself: ground that stands in for them then sends as much light. `probe` holds the layer.
void match_far_look(const scene::Ground& ground, scene::Scene& probe) {
  scene::DetailLayer& layer = probe.details.front();
  if (layer.nodes.empty()) return;
  const std::vector<Spot> spots = some_columns(ground, layer, 2000);
  std::vector<accel::Ray> rays;
  for (const Spot& spot : spots) {
    for (const V3& view : views) {
      accel::Ray ray;
      ray.direction = view.normalized();
      ray.most = 3;  // as far as the ground
      ray.origin = spot.at - V3d(ray.direction) * ray.most;
      rays.push_back(ray);
    }
  }
  std::vector<accel::Hit> hits(rays.size());
  accel::trace_details(probe, rays, hits);

  const shade::Land plain;
  const V3 up(0, 0, 1);
  double met = 0;
  Rgb seen(0, 0, 0), flat(0, 0, 0);
  float gaps = 0, free_gaps = 0, level_light = 0;
  for (const Lamp& lamp : lamps) level_light += lamp.light * lamp.towards.normalized().z;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Spot& spot = spots[i / std::size(views)];
    if (hits[i].surface == accel::Surface::none) {
      gaps += lit(probe, spot.at, up, up, 2e-3).front;
      free_gaps += level_light;
      continue;
    }
    ++met;
    const shade::SurfacePoint point = shade::surface_at(probe, plain, rays[i], hits[i]);
    const Lit own = lit(probe, point.at, point.normal, point.plane, 2e-4);
    seen += point.reflectance * own.front + point.transmittance * own.back;
    flat += spot.colour * level_light;
  }
  layer.gap_light = free_gaps > 0 ? gaps / free_gaps : 1;
  if (met == 0) return;
  for (int c = 0; c < 3; ++c) layer.tint[c] = flat[c] > 0 ? std::clamp(seen[c] / flat[c], 0.1f, 3.0f) : 1.0f;
  // What scale of the depths gives this cover: it grows with the scale.
  const double cover = met / static_cast<double>(hits.size());
  double low = 0.01, high = 20;
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    double sum = 0;
    for (const Spot& spot : spots) sum += 1 - std::exp(-static_cast<double>(spot.depth) * middle);
    (sum / static_cast<double>(spots.size()) < cover ? low : high) = middle;
  }
  layer.depth_scale = static_cast<float>(std::sqrt(low * high));
}

}  // namespace

scene::DetailKind add_detail_kind(scene::Scene& scene, const ghosttile::tile::GhostTile& tile,
                                  const DetailOptions& options) {
  std::vector<std::uint32_t> numbers;
  const std::size_t first = scene.models.size();
  scene.models.resize(first + tile.objects.size());
  silvasim::base::parallel_for(tile.objects.size(), [&](std::size_t k) {
    scene.models[first + k] = packed_detail(tile.objects[k].model, options.levels);
  });
  for (std::size_t k = 0; k < tile.objects.size(); ++k) numbers.push_back(static_cast<std::uint32_t>(first + k));
  return scene::detail_kind(tile, numbers);
}

scene::DetailLayer detail_layer(const scene::Scene& scene, const scene::DetailKind& kind,
                                const ghosttile::fill::Details& details, const std::string& name,
                                const DetailOptions& options) {
  scene::DetailLayer layer = scene::make_detail_layer(kind, details, scene.origin, name);
  if (!options.fades) return layer;
  layer.fades = true;
  if (options.like) {
    layer.depth_scale = options.like->depth_scale;
    layer.tint = options.like->tint;
    layer.gap_light = options.like->gap_light;
    return layer;
  }
  scene::Scene probe;
  probe.models = scene.models;
  probe.details.push_back(std::move(layer));
  match_far_look(scene.ground, probe);
  return std::move(probe.details.front());
}

}  // namespace silvavis
