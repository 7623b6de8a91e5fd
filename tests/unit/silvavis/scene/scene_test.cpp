#include "silvavis/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>

#include "../accel/made_forest.h"
#include "silvasim/base/error.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/pack.h"
#include "silvavis/scene/instance.h"
#include "silvavis/scene/tile_sites.h"

namespace silvavis::scene {

namespace {

silvasim::base::Stream random_numbers(std::uint32_t what) {
  return silvasim::base::Stream(11, silvasim::base::Purpose::rotation, what);
}

HeightRange range_of(const Pyramid& pyramid, const PyramidNode& node, std::size_t child) {
  return {pyramid.origin_m + pyramid.step_m * static_cast<float>(node.least[child]),
          pyramid.origin_m + pyramid.step_m * static_cast<float>(node.most[child])};
}

}  // namespace

TEST(Pyramid, EveryNodeHoldsWhatLiesBelow) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {4, 4}, {5, 3}, {70, 19}}) {
    auto random = random_numbers(static_cast<std::uint32_t>(columns));
    std::vector<HeightRange> ranges(static_cast<std::size_t>(columns * rows));
    for (HeightRange& range : ranges) {
      range.least_m = 100 * random.next_float();
      range.most_m =
          random.next_below(5) == 0 ? range.least_m - 1 : range.least_m + 30 * random.next_float();  // some empty
    }
    const Pyramid pyramid = make_pyramid(columns, rows, {0, 130}, [&, columns = columns](int i, int j) {
      return ranges[static_cast<std::size_t>(j * columns + i)];
    });
    ASSERT_EQ(pyramid.levels.back().nodes.size(), 1u);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const HeightRange& item = ranges[static_cast<std::size_t>(j * columns + i)];
        int x = i, y = j;
        for (const Pyramid::Level& level : pyramid.levels) {
          const PyramidNode& node = level.nodes[static_cast<std::size_t>(y / 4 * level.columns + x / 4)];
          const auto child = static_cast<std::size_t>(y % 4 * 4 + x % 4);
          if (item.least_m <= item.most_m) {
            EXPECT_LE(range_of(pyramid, node, child).least_m, item.least_m);
            EXPECT_GE(range_of(pyramid, node, child).most_m, item.most_m);
          } else if (&level == &pyramid.levels.front()) {
            EXPECT_GT(node.least[child], node.most[child]);
          }
          x /= 4;
          y /= 4;
        }
      }
    }
  }
}

TEST(TileSites, EverySiteIsInOneLeafWithinAllItsNodes) {
  for (const int count : {1, 8, 9, 16, 17, 126, 133, 256, 257, 300, 5000}) {
    auto random = random_numbers(static_cast<std::uint32_t>(count));
    silvasim::tiles::Tile tile;
    for (int i = 0; i < count; ++i)
      tile.sites.push_back({200 * random.next_float(), 200 * random.next_float(), 1 + 5 * random.next_float()});
    const TileSites sites = make_tile_sites(tile, 1.5f);
    std::multiset<std::uint32_t> found;
    // From the root down, with the box that holds all below.
    const std::function<void(std::uint32_t, std::array<float, 4>)> visit = [&](std::uint32_t index,
                                                                               std::array<float, 4> box) {
      const SiteNode& node = sites.nodes[index];
      for (std::size_t c = 0; c < 16; ++c) {
        if (node.least_x[c] > node.most_x[c]) continue;
        EXPECT_GE(node.least_x[c], box[0]);
        EXPECT_LE(node.most_x[c], box[1]);
        EXPECT_GE(node.least_y[c], box[2]);
        EXPECT_LE(node.most_y[c], box[3]);
        const std::uint32_t child = node.children[c];
        if (!node.above_leaves) {
          visit(child, {node.least_x[c], node.most_x[c], node.least_y[c], node.most_y[c]});
          continue;
        }
        const SiteLeaf leaf = SiteLeaf::of(child);
        for (std::uint32_t slot = leaf.first_slot; slot < leaf.first_slot + leaf.slots; ++slot) {
          if (sites.radius_m[slot] < 0) continue;
          found.insert(sites.site_ids[slot]);
          const auto& site = tile.sites[sites.site_ids[slot]];
          EXPECT_EQ(sites.x_m[slot], site.x_m);
          EXPECT_GE(site.x_m - 1.5f * site.radius_m, node.least_x[c]);
          EXPECT_LE(site.y_m + 1.5f * site.radius_m, node.most_y[c]);
        }
      }
    };
    constexpr float all = std::numeric_limits<float>::max();
    visit(0, {-all, all, -all, all});
    EXPECT_EQ(found.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(std::set<std::uint32_t>(found.begin(), found.end()).size(), static_cast<std::size_t>(count));
  }
}

TEST(Ground, IsTheTerrainWhereItHasDataAndContinuous) {
  silvasim::ecosystem::Terrain terrain;
  terrain.columns = 7;
  terrain.rows = 5;
  terrain.west = 1000;
  terrain.north = 2000;
  terrain.cell_width_m = 10;
  terrain.cell_height_m = 20;
  auto random = random_numbers(5);
  for (int i = 0; i < 35; ++i) terrain.heights_m.push_back(100 + 50 * random.next_float());
  terrain.heights_m[17] = std::nanf("");
  const Ground ground = make_ground(terrain, {1000, 1900, 1070, 2000}, {1030, 1950});
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      const double x = 1005 + 10 * column - 1030, y = 1990 - 20 * row - 1950;
      const float height = terrain.heights_m[static_cast<std::size_t>(row * 7 + column)];
      if (std::isnan(height)) {
        EXPECT_TRUE(std::isfinite(ground_at(ground, x, y).height_m));
      } else {
        EXPECT_NEAR(ground_at(ground, x, y).height_m, static_cast<double>(height), 1e-4);
      }
    }
  }
  for (int i = 0; i < 2000; ++i) {
    const double x = -40 + 90 * random.next_double(), y = -60 + 120 * random.next_double();
    EXPECT_NEAR(ground_at(ground, x, y).height_m, ground_at(ground, x + 1e-7, y + 1e-7).height_m, 1e-4);
    // The slope is that of the surface.
    const GroundPoint at = ground_at(ground, x, y), beside = ground_at(ground, x + 1e-4, y);
    if (at.slope_x == beside.slope_x && x > ground.west && x < ground.east() - 1) {
      EXPECT_NEAR((beside.height_m - at.height_m) / 1e-4, at.slope_x, 1e-3);
    }
  }
}

TEST(Scene, PlantsStandOnTheGroundWhereTheEcosystemSays) {
  const testing::MadeForest made;
  const auto ecosystem = testing::made_ecosystem(made);
  const Scene scene = testing::made_forest(made);
  std::uint64_t plants = 0;
  for (std::size_t k = 0; k < ecosystem.layers.size(); ++k) {
    const auto& from = ecosystem.layers[k];
    const PlantLayer& layer = scene.layers[k];
    const auto offsets = silvasim::ecosystem::site_offsets(from.tile_set, from.tiling);
    silvasim::ecosystem::for_each_plant(
        from, offsets, 0, from.tiling.rows, [&](const silvasim::ecosystem::Plant& plant) {
          if (plant.species == 2) return;  // has no model
          ++plants;
          const int row = layer.rows - 1 - plant.row;
          const TileSites& tile = layer.tile_sites[layer.tiles[layer.position(plant.column, row)]];
          const auto slot = static_cast<std::uint32_t>(
              std::find(tile.site_ids.begin(), tile.site_ids.end(), plant.site) - tile.site_ids.begin());
          ASSERT_LT(slot, tile.count);
          const std::uint8_t species = layer.plant_species[layer.first_slot[layer.position(plant.column, row)] + slot];
          ASSERT_EQ(species, plant.species);
          const Instance instance = instance_at(scene, layer, plant.column, row, slot, species);
          ASSERT_NEAR(instance.foot.x + scene.origin.x, plant.at.x, 1e-3);
          ASSERT_NEAR(instance.foot.y + scene.origin.y, plant.at.y, 1e-3);
          const GroundPoint ground = ground_at(scene.ground, instance.foot.x, instance.foot.y);
          // Never above the ground; sunk by no more than the foot's width on the slope asks for.
          const double slope = std::hypot(ground.slope_x, ground.slope_y);
          const double foot =
              static_cast<double>(scene.models[layer.species[species].first_model]->foot_m * instance.scale);
          ASSERT_LE(instance.foot.z, ground.height_m + 0.005);
          ASSERT_GE(instance.foot.z, ground.height_m - foot * slope - 0.005);
          ASSERT_NEAR(instance.scale, plant.radius_m / layer.species[species].model_radius_m, 1e-6);
        });
  }
  EXPECT_EQ(plants, scene.plants);
  EXPECT_GT(plants, 500u);
}

std::string refusal(silvasim::ecosystem::Ecosystem e) {
  const std::vector<std::vector<SpeciesModelSet>> none(e.layers.size(), std::vector<SpeciesModelSet>(3));
  try {
    make_scene(std::move(e), none);
  } catch (const silvasim::base::Error& error) {
    return error.what();
  }
  return {};
}

// All of them pass the check of an ecosystem file.
TEST(Scene, RefusesTerrainsThatNoPictureHolds) {
  const auto made = testing::made_ecosystem({});
  EXPECT_EQ(refusal(made), "");
  auto e = made;
  e.terrain.cell_width_m = 1e9;
  EXPECT_THAT(refusal(e), ::testing::HasSubstr("larger than the tiles of layer \"trees\""));
  e = made;
  e.terrain.west = -1e9;
  e.terrain.north = 1e9;
  EXPECT_THAT(refusal(e), ::testing::HasSubstr("larger than the tiles"));
  e = made;
  e.layers[0].tile_set.side_m = 1e-4;
  for (auto& tile : e.layers[0].tile_set.tiles) tile.sites.clear();
  EXPECT_THAT(refusal(e), ::testing::HasSubstr("larger than the tiles"));
  e = made;
  e.terrain.heights_m[5] = -3.4028235e38f;
  EXPECT_THAT(refusal(e), ::testing::HasSubstr("no data value"));
  e.terrain.heights_m[5] = 3.4e38f;
  EXPECT_THAT(refusal(e), ::testing::HasSubstr("no data value"));
}

TEST(Scene, TakesLessThanSixBytesAPlant) {
  testing::MadeForest made;
  made.columns = made.rows = 40;
  made.side_m = 100;
  made.shrubs = false;
  const Scene scene = testing::made_forest(made);
  EXPECT_LT(static_cast<double>(scene.plant_bytes()) / static_cast<double>(scene.plants), 6.0);
}

TEST(Instance, LocalRayAndWorldRayMeetTheSamePoint) {
  auto random = random_numbers(9);
  for (int i = 0; i < 1000; ++i) {
    Instance instance;
    instance.foot = {20000 * random.next_double(), 20000 * random.next_double(), 500 * random.next_double()};
    instance.scale = 0.5f + random.next_float();
    instance.turn = turns()[random.next_below(256)];
    const V3 point(4 * random.next_float() - 2, 4 * random.next_float() - 2, 20 * random.next_float());
    const V3 moved = turned(instance.turn, point) * instance.scale;
    const V3d world = instance.foot + V3d(moved);
    const V3d eye = world + V3d(random.next_double() - 0.5, random.next_double() - 0.5, random.next_double()) * 30000.0;
    const V3d way = world - eye;
    const V3 direction = V3(way.normalized()).normalized();
    const LocalRay ray = local_ray(instance, eye, direction);
    const double t = (way.length() - ray.start) / static_cast<double>(instance.scale);
    const V3 met = ray.origin + ray.direction * static_cast<float>(t);
    // A float direction is off by 1e-7 of 30 km.
    EXPECT_NEAR((met - point).length(), 0, 0.01);
  }
}

TEST(Normals, InTwoBytesAreWithinADegreeAndAHalf) {
  auto random = random_numbers(2);
  for (int i = 0; i < 5000; ++i) {
    const V3 normal =
        V3(random.next_float() - 0.5f, random.next_float() - 0.5f, random.next_float() - 0.5f).normalized();
    EXPECT_GT(normal.dot(unpacked_normal(packed_normal(normal))), std::cos(0.026f));
  }
}

// Every triangle of the model is in one block, inside all boxes above it, and in the hull.
TEST(Pack, HoldsEveryTriangleInItsBoxes) {
  const assets::Model model = testing::leaf_ball(700, 18, 5, true, 3);
  const PlantModel packed = accel::pack(model);
  EXPECT_EQ(packed.triangles, model.triangles.size());
  std::size_t triangles = 0;
  const std::function<void(std::uint32_t, V3, V3)> visit = [&](std::uint32_t index, V3 least, V3 most) {
    const TreeNode& node = packed.nodes[index];
    std::uint32_t next_node = node.first_node, next_block = node.first_block;
    for (std::size_t c = 0; c < node_size; ++c) {
      const bool inner = node.inner >> c & 1, leaf = node.leaves >> c & 1;
      EXPECT_FALSE(inner && leaf);
      if (!inner && !leaf) continue;
      V3 low, high;
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        low[axis] = node.origin[a] + node.step(a) * static_cast<float>(node.least[a][c]);
        high[axis] = node.origin[a] + node.step(a) * static_cast<float>(node.most[a][c]);
      }
      if (inner) {
        visit(next_node++, low, high);
        continue;
      }
      const std::uint32_t block = next_block++;
      for (std::uint32_t slot = block * block_size; slot < (block + 1) * block_size; ++slot) {
        const V3 a = packed.position_of(slot, 0), b = packed.position_of(slot, 1), d = packed.position_of(slot, 2);
        if ((b - a).cross(d - a).length2() > 0) ++triangles;
        for (const V3& p : {a, b, d}) {
          for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(p[axis], low[axis] - 1e-5f);
            EXPECT_LE(p[axis], high[axis] + 1e-5f);
          }
          bool in_hull = false;
          for (std::size_t k = 0; k < hull_size; ++k)
            in_hull = in_hull || (p.z >= packed.hull.edges_m[k] && p.z <= packed.hull.edges_m[k + 1] &&
                                  std::hypot(p.x, p.y) <= packed.hull.radii_m[k]);
          EXPECT_TRUE(in_hull);
        }
      }
    }
    (void)least;
    (void)most;
  };
  visit(0, packed.least, packed.most);
  EXPECT_EQ(triangles, packed.triangles);
}

}  // namespace silvavis::scene
