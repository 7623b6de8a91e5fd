// Scenes at the limits of what an ecosystem file may hold: the nested trees still see what the flat structure sees.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "made_forest.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/accel/pack.h"

namespace silvavis::testing {

namespace {

namespace ecosystem = silvasim::ecosystem;
using accel::Hit;
using accel::Ray;
using accel::Surface;
using Models = std::vector<std::vector<scene::SpeciesModelSet>>;

std::shared_ptr<const scene::PlantModel> packed(const assets::Model& model) {
  return std::make_shared<const scene::PlantModel>(accel::pack(model));
}

assets::Model model_of(const std::vector<std::array<V3, 3>>& triangles) {
  assets::Model model;
  model.name = "made";
  model.materials.resize(1);
  for (const auto& corners : triangles) {
    const auto first = static_cast<std::uint32_t>(model.positions.size());
    const V3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    for (const V3& corner : corners) {
      model.positions.push_back(corner);
      model.normals.push_back(normal);
      model.uvs.push_back({0, 0});
    }
    model.triangles.push_back({first, first + 1, first + 2});
    model.triangle_materials.push_back(0);
  }
  return model;
}

// Leaves of a ball, moved and stretched: plants that overhang far, float, hang or reach into the ground.
assets::Model moved(assets::Model model, const V3& by, const V3& stretch = V3(1)) {
  for (V3& p : model.positions) p = p * stretch + by;
  return model;
}

// What is put on sites of radius 2 to 6 m, made for 4.2 m.
Models all(const ecosystem::Ecosystem& e, const std::vector<scene::SpeciesModelSet>& sets) {
  Models models;
  for (const auto& layer : e.layers) {
    models.emplace_back();
    for (std::size_t s = 0; s < layer.species.size(); ++s) models.back().push_back(sets[s % sets.size()]);
  }
  return models;
}

struct Case {
  const char* name;
  std::function<scene::Scene()> make;
};

MadeForest sparse() {
  MadeForest made;
  made.coverage = 0.15;
  return made;
}

std::vector<Case> cases() {
  const auto ball = [] { return packed(leaf_ball(60, 14, 4, true, 3)); };
  return {
      {"one_triangle_upright",
       [] {
         const auto e = made_ecosystem({});
         return scene::make_scene(e, all(e, {{packed(model_of({{V3(-3, 0, 0), V3(3, 0, 0), V3(0, 1, 12)}}))}}));
       }},
      {"one_level_triangle",
       [] {
         const auto e = made_ecosystem({});
         return scene::make_scene(e, all(e, {{packed(model_of({{V3(-3, -2, 2), V3(3, -2, 2), V3(0, 4, 2)}}))}}));
       }},
      {"needles",
       [] {
         const auto e = made_ecosystem({});
         return scene::make_scene(e, all(e, {{packed(model_of({{V3(-.1f, 0, 0), V3(.1f, 0, 0), V3(0, 0, 25)},
                                                               {V3(0, -.1f, 0), V3(0, .1f, 0), V3(0, 0, 25)}}))}}));
       }},
      {"beside_the_stem",
       [] {
         const auto e = made_ecosystem(sparse());
         return scene::make_scene(e, all(e, {{packed(moved(leaf_ball(60, 14, 4, true, 3), {25, -12, 0}))}}));
       }},
      {"in_the_air_and_in_the_ground",
       [] {
         const auto e = made_ecosystem(sparse());
         const assets::Model ball_of_leaves = leaf_ball(60, 14, 4, true, 3);
         return scene::make_scene(e, all(e, {{packed(moved(ball_of_leaves, {0, 0, 30}))},
                                             {packed(moved(ball_of_leaves, {0, 0, -11}))},
                                             {packed(moved(ball_of_leaves, {1, 0, -40}, {1, 1, 4}))}}));
       }},
      {"steep_land",
       [] {
         MadeForest made;
         made.hills_m = 900;
         return made_forest(made);
       }},
      {"few_large_cells",
       [] {
         MadeForest made;
         made.cell_m = 700;
         return made_forest(made);
       }},
      {"terrain_beneath_a_corner_only",
       [ball] {
         auto e = made_ecosystem({});
         e.terrain.columns = e.terrain.rows = 3;
         e.terrain.heights_m = {300, 320, 310, 290, 350, 300, 280, 300, 310};
         e.terrain.west -= 20;
         return scene::make_scene(e, all(e, {{ball()}}));
       }},
      {"terrain_far_larger",
       [ball] {
         auto e = made_ecosystem({});
         e.terrain.cell_width_m *= 30;
         e.terrain.cell_height_m *= 30;
         e.terrain.west -= 2000;
         e.terrain.north += 3000;
         return scene::make_scene(e, all(e, {{ball()}}));
       }},
      {"one_tile_position",
       [] {
         MadeForest made;
         made.columns = made.rows = 1;
         return made_forest(made);
       }},
      {"tiles_without_sites",
       [ball] {
         auto e = made_ecosystem({});
         for (ecosystem::Layer& layer : e.layers) {
           for (std::size_t t = 0; t < layer.tile_set.tiles.size(); t += 2) layer.tile_set.tiles[t].sites.clear();
           layer.plants.assign(ecosystem::site_offsets(layer.tile_set, layer.tiling).back(), 0);
         }
         return scene::make_scene(e, all(e, {{ball()}}));
       }},
      {"nothing_grows",
       [ball] {
         auto e = made_ecosystem({});
         for (ecosystem::Layer& layer : e.layers) layer.plants.assign(layer.plants.size(), ecosystem::no_plant);
         return scene::make_scene(e, all(e, {{ball()}}));
       }},
      {"the_smallest_tiles_first",
       [ball] {
         auto e = made_ecosystem({});
         std::swap(e.layers[0], e.layers[1]);
         return scene::make_scene(e, all(e, {{ball()}}));
       }},
      {"254_species",
       [ball] {
         auto e = made_ecosystem({});
         for (ecosystem::Layer& layer : e.layers) {
           layer.species.resize(254);
           for (std::size_t s = 0; s < 254; ++s) {
             layer.species[s].name = "species " + std::to_string(s);
             layer.species[s].model_radius_m = 2 + 0.02f * static_cast<float>(s);
           }
           for (std::size_t i = 0; i < layer.plants.size(); ++i)
             layer.plants[i] = static_cast<ecosystem::PlantId>((i * 37 + 200) % 254);
         }
         return scene::make_scene(e, all(e, {{ball()}, {}, {ball(), ball(), ball()}}));
       }},
      {"at_ten_million_metres",
       [] {
         MadeForest made;
         made.west = made.south = 1e7;
         return made_forest(made);
       }},
      {"without_terrain",
       [] {
         MadeForest made;
         made.hills_m = 0;
         return made_forest(made);
       }},
      {"plants_of_a_tenth_of_a_millimetre",
       [ball] {
         auto e = made_ecosystem({});
         for (auto& tile : e.layers[0].tile_set.tiles)
           for (std::size_t i = 0; i < tile.sites.size(); i += 3) tile.sites[i].radius_m = 1e-4f;
         return scene::make_scene(e, all(e, {{ball()}}));
       }},
      {"sites_on_the_tiles_rims",
       [ball] {
         auto e = made_ecosystem(sparse());
         for (ecosystem::Layer& layer : e.layers) {
           const auto last = std::nextafter(static_cast<float>(layer.tile_set.side_m), 0.0f);
           const float quarter = static_cast<float>(layer.tile_set.side_m / 4);
           for (auto& tile : layer.tile_set.tiles) {
             for (std::size_t i = 0; i < tile.sites.size(); ++i) {
               auto& site = tile.sites[i];
               if (i % 4 == 0) site.x_m = 0;
               if (i % 4 == 1) site.x_m = last;
               if (i % 4 == 2) site.y_m = std::floor(site.y_m / quarter) * quarter;
               if (i % 8 == 3) site.y_m = last;
             }
           }
         }
         return scene::make_scene(e, all(e, {{ball()}}));
       }},
  };
}

Ray random_ray(const scene::Scene& scene, silvasim::base::Stream& random) {
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  const auto within = [&] {
    V3d at(between(scene.extent.west - 40, scene.extent.east + 40),
           between(scene.extent.south - 40, scene.extent.north + 40), 0);
    at.z = scene::ground_at(scene.ground, at.x, at.y).height_m;
    return at;
  };
  Ray ray;
  const V3d target = within() + V3d(0, 0, between(-2, 16));
  switch (random.next_below(5)) {
    case 0:
      ray.origin = target + V3d(between(-1, 1), between(-1, 1), between(0.05, 1)) * 4000.0;
      break;
    case 1:
      ray.origin = target + V3d(0, 0, between(20, 300));
      ray.direction = {0, 0, -1};
      return ray;
    case 2:  // from within the crowns
      ray.origin = within() + V3d(0, 0, between(0.5, 10));
      break;
    case 3: {
      ray.origin = within() + V3d(0, 0, between(1, 14));
      const auto axis = static_cast<int>(random.next_below(2));
      ray.direction = V3(0, 0, 0);
      ray.direction[axis] = random.next_below(2) == 0 ? 1.0f : -1.0f;
      return ray;
    }
    default:
      ray.origin = target + V3d(between(-80, 80), between(-80, 80), between(5, 120));
      break;
  }
  ray.direction = V3((target - ray.origin).normalized()).normalized();
  return ray;
}

bool below_ground(const scene::Scene& scene, const V3d& at) {
  return at.z < scene::ground_at(scene.ground, at.x, at.y).height_m + 0.1;
}

// Where the land ends, and where it is met from below, the two may differ: it is a sheet without thickness.
bool land_decides(const scene::Scene& scene, const Ray& ray, const Hit& hit) {
  if (hit.surface != Surface::ground) return false;
  const V3d at = ray.origin + V3d(ray.direction) * hit.distance, before = at - V3d(ray.direction) * 0.1;
  const scene::Ground& g = scene.ground;
  return std::min({at.x - g.west, g.east() - at.x, at.y - g.south, g.north() - at.y}) < 0.05 ||
         before.z < scene::ground_at(g, before.x, before.y).height_m;
}

}  // namespace

TEST(HostileScenes, LookTheSameInBothTrees) {
  for (const Case& hostile : cases()) {
    SCOPED_TRACE(hostile.name);
    const scene::Scene scene = hostile.make();
    const auto nested = accel::make_nested(scene), flat = accel::make_embree(scene, accel::Flat::exact);
    silvasim::base::Stream random(23, silvasim::base::Purpose::rotation);
    std::vector<Ray> rays;
    for (int i = 0; i < 20000; ++i) {
      const Ray ray = random_ray(scene, random);
      if (!below_ground(scene, ray.origin)) rays.push_back(ray);
    }
    std::vector<Hit> a(rays.size()), b(rays.size());
    nested->nearest(rays, a);
    flat->nearest(rays, b);
    int plants = 0, ground = 0, others = 0, depths = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (land_decides(scene, rays[i], a[i]) || land_decides(scene, rays[i], b[i])) continue;
      plants += b[i].surface == Surface::plant ? 1 : 0;
      ground += b[i].surface == Surface::ground ? 1 : 0;
      const bool same = a[i].surface == b[i].surface &&
                        (a[i].surface != Surface::plant ||
                         (a[i].layer == b[i].layer && a[i].column == b[i].column && a[i].row == b[i].row &&
                          a[i].site_slot == b[i].site_slot && a[i].species == b[i].species));
      if (!same) {
        ++others;
      } else if (a[i].surface != Surface::none && std::abs(a[i].distance - b[i].distance) > 0.05) {
        ++depths;
      }
    }
    EXPECT_GT(plants + ground, 2500);
    // Edges of leaves and of the land's cells, met within a float's last bits.
    EXPECT_LE(others, 4);
    EXPECT_LE(depths, 4);
  }
}

}  // namespace silvavis::testing
