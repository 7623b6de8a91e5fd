// The land that rays meet is the triangles between its heights: each of them asked, one after another, in doubles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"

namespace silvavis::testing {

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

struct MadeLand {
  const char* name;
  int columns, rows;  // of the terrain
  double cell_x_m, cell_y_m;
  double heights_m;    // between 0 and that
  double tile_side_m;  // 0: no layer
  int tile_columns, tile_rows;
  double west_m, south_m;    // of the tiling, seen from the terrain's south-western corner
  double easting, northing;  // of that corner
  int flat_every = 0;        // every such vertex has the height of the one before
};

silvasim::base::Stream numbers(std::uint32_t what) {
  return silvasim::base::Stream(17, silvasim::base::Purpose::rotation, what);
}

scene::Scene scene_of(const MadeLand& made) {
  silvasim::ecosystem::Ecosystem e;
  e.terrain.columns = made.columns;
  e.terrain.rows = made.rows;
  e.terrain.cell_width_m = made.cell_x_m;
  e.terrain.cell_height_m = made.cell_y_m;
  e.terrain.west = made.easting;
  e.terrain.north = made.northing + made.rows * made.cell_y_m;
  auto random = numbers(1);
  for (int i = 0; i < made.columns * made.rows; ++i) {
    const bool flat = made.flat_every > 0 && i % made.flat_every != 0;
    e.terrain.heights_m.push_back(flat ? e.terrain.heights_m.back()
                                       : static_cast<float>(made.heights_m * random.next_double()));
  }
  const double west = made.easting + made.west_m, south = made.northing + made.south_m;
  e.extent = {west, south, west + 10, south + 10};
  std::vector<std::vector<scene::SpeciesModelSet>> models;
  if (made.tile_side_m > 0) {
    const double side = made.tile_side_m;
    e.extent = {west, south, west + made.tile_columns * side, south + made.tile_rows * side};
    silvasim::ecosystem::Layer layer;
    layer.name = "bare";
    layer.tile_set.side_m = side;
    layer.tile_set.most_radius_m = side;
    layer.tile_set.colours = layer.tile_set.variants = 1;
    layer.tile_set.tiles.emplace_back();
    const auto positions = static_cast<std::size_t>(made.tile_columns * made.tile_rows);
    layer.tiling = {made.tile_columns, made.tile_rows, std::vector<std::uint16_t>(positions, 0)};
    layer.north_west = {west, e.extent.north};
    e.layers.push_back(std::move(layer));
    models.emplace_back();
  }
  return scene::make_scene(std::move(e), models);
}

// Where a ray first comes from above through one of the triangles: by the triangles' planes and edges (Möller and Trumbore
// 1997). `doubt`: a hair decides whether it does at all.
struct Truth {
  double distance = none;
  bool doubt = false;
};
Truth brute_force(const scene::Ground& ground, const accel::Ray& ray) {
  Truth truth;
  double doubtful = none;
  const V3d direction(ray.direction);
  const auto vertex = [&](int i, int j) {
    return V3d(ground.west + i * ground.cell_x_m, ground.south + j * ground.cell_y_m,
               static_cast<double>(ground.at(i, j)));
  };
  for (int j = 0; j + 1 < ground.rows; ++j) {
    for (int i = 0; i + 1 < ground.columns; ++i) {
      const V3d corners[2][3] = {{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)},
                                 {vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)}};
      for (const auto& c : corners) {
        const V3d e1 = c[1] - c[0], e2 = c[2] - c[0];
        const V3d normal = e1.cross(e2);  // up
        const double facing = normal.dot(direction);
        if (facing == 0) continue;
        const V3d from = ray.origin - c[0];
        const double t = -normal.dot(from) / facing;
        const V3d p = direction.cross(e2), q = from.cross(e1);
        const double per = 1 / e1.dot(p), u = from.dot(p) * per, v = direction.dot(q) * per;
        // Past an edge by what a double's rounding over some kilometres makes.
        const double hair = 1e-7, least = std::min({u, v, 1 - u - v});
        if (least < -hair || t < ray.least - 0.05 || t > ray.most + 0.05) continue;
        if (least < hair || std::abs(facing) < 1e-6 * normal.length() || std::abs(t - ray.least) < 0.05 ||
            std::abs(t - ray.most) < 0.05)
          doubtful = std::min(doubtful, t);
        if (facing < 0 && least >= 0 && t >= ray.least && t <= ray.most) truth.distance = std::min(truth.distance, t);
      }
    }
  }
  truth.doubt = doubtful <= truth.distance;
  return truth;
}

// Whether the ray comes to the hit from beneath the land, or from beyond its rim: a sheet may be met there by whoever passes it
// by no more than the rounding that the walk allows for.
bool comes_from_below(const scene::Ground& ground, const accel::Ray& ray, double distance) {
  constexpr double rounding_m = 0.02;
  const V3d at = ray.origin + V3d(ray.direction) * distance;
  if (std::abs(at.z - scene::ground_at(ground, at.x, at.y).height_m) > rounding_m + 1e-3) return false;
  const V3d before = at - V3d(ray.direction) * 1e-3;
  const bool outside =
      before.x <= ground.west || before.x >= ground.east() || before.y <= ground.south || before.y >= ground.north();
  return outside || before.z < scene::ground_at(ground, before.x, before.y).height_m;
}

// Half of them towards what is special: rims of cells, tile positions and their quarters.
accel::Ray ray_over(const scene::Scene& scene, const MadeLand& made, int number, silvasim::base::Stream& random) {
  const scene::Ground& g = scene.ground;
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  const auto place = [&] {
    V3d at(between(g.west, g.east()), between(g.south, g.north()), 0);
    const double quarter = made.tile_side_m / scene::quarters;
    switch (random.next_below(4)) {
      case 0:
        at.x = g.west + std::floor((at.x - g.west) / g.cell_x_m) * g.cell_x_m;
        break;
      case 1:
        at.y = g.south + std::floor((at.y - g.south) / g.cell_y_m) * g.cell_y_m;
        break;
      case 2:
        if (quarter > 0 && !scene.layers.empty())
          at.x = scene.layers[0].west + std::floor((at.x - scene.layers[0].west) / quarter) * quarter;
        break;
      default:
        break;
    }
    at.z = scene::ground_at(g, at.x, at.y).height_m;
    return at;
  };
  accel::Ray ray;
  const V3d target = place();
  switch (number % 6) {
    case 0:  // straight down, or up from below
      ray.origin = target + V3d(0, 0, random.next_below(4) == 0 ? -between(1, 100) : between(0.1, 3000));
      ray.direction = {0, 0, ray.origin.z > target.z ? -1.0f : 1.0f};
      return ray;
    case 1: {  // level, along an axis
      const auto axis = static_cast<int>(random.next_below(2));
      ray.origin = target + V3d(0, 0, between(-0.3, 0.3) * made.heights_m);
      ray.origin[axis] -= between(-1, 1) * 2000;
      ray.direction = V3(0, 0, 0);
      ray.direction[axis] = random.next_below(2) == 0 ? 1.0f : -1.0f;
      return ray;
    }
    case 2:  // from far away
      ray.origin = target + V3d(between(-1, 1), between(-1, 1), between(0.02, 1)) * 40000.0;
      break;
    case 3:  // close to the ground, at a low angle
      ray.origin = place() + V3d(0, 0, between(0.1, 3));
      break;
    default:
      ray.origin = place() + V3d(between(-20, 20), between(-20, 20), between(1, 200));
      break;
  }
  ray.direction = V3((target - ray.origin).normalized()).normalized();
  if (number % 5 == 0) ray.most = between(1, 1.2) * (target - ray.origin).length();
  if (number % 13 == 0) ray.least = between(0, 1.1) * (target - ray.origin).length();
  return ray;
}

}  // namespace

class LandOf : public ::testing::TestWithParam<MadeLand> {};

TEST_P(LandOf, RaysMeetTheNearestTriangleFromAbove) {
  const MadeLand& made = GetParam();
  const scene::Scene scene = scene_of(made);
  const auto tracer = accel::make_nested(scene);
  auto random = numbers(2);
  const int cells = (scene.ground.columns - 1) * (scene.ground.rows - 1);
  const int count = std::clamp(20'000'000 / cells, 4000, 15000);
  int hits = 0, doubts = 0, wrong = 0;
  for (int number = 0; number < count; ++number) {
    const accel::Ray ray = ray_over(scene, made, number, random);
    // A ray that begins a hair below the ground counts as one that begins on it.
    const double above = ray.origin.z - scene::ground_at(scene.ground, ray.origin.x, ray.origin.y).height_m;
    if (std::abs(above) < 0.06) continue;
    const Truth truth = brute_force(scene.ground, ray);
    accel::Hit hit;
    tracer->nearest({&ray, 1}, {&hit, 1});
    std::uint8_t barred = 2;
    tracer->occluded({&ray, 1}, {&barred, 1});
    EXPECT_EQ(barred, hit.surface == accel::Surface::none ? 0 : 1);
    if (truth.doubt || (hit.distance < truth.distance && comes_from_below(scene.ground, ray, hit.distance))) {
      ++doubts;
      continue;
    }
    hits += truth.distance < none ? 1 : 0;
    const bool same = truth.distance == none ? hit.surface == accel::Surface::none
                                             : std::abs(hit.distance - truth.distance) < 1e-6 * truth.distance + 1e-3;
    if (!same && ++wrong <= 5)
      ADD_FAILURE() << made.name << ", ray " << number << " from (" << ray.origin.x << ", " << ray.origin.y << ", "
                    << ray.origin.z << ") towards (" << ray.direction.x << ", " << ray.direction.y << ", "
                    << ray.direction.z << ") within [" << ray.least << ", " << ray.most << "] meets the ground after "
                    << hit.distance << " m, not " << truth.distance;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(hits, count / 4);
  EXPECT_LT(doubts, count * 2 / 3);
}

INSTANTIATE_TEST_SUITE_P(
    Ground, LandOf,
    ::testing::Values(MadeLand{"without a layer", 30, 20, 10, 10, 40, 0, 0, 0, 0, 0, 0, 0},
                      MadeLand{"as large as the tiling", 40, 40, 9, 9, 60, 60, 6, 6, 0, 0, 500000, 5600000},
                      MadeLand{"smaller than the tiling", 9, 7, 17, 13, 50, 60, 8, 6, -133, -71, 500000, 5600000},
                      MadeLand{"larger than the tiling", 60, 50, 21, 19, 200, 100, 2, 3, 411, 277, 500000, 5600000},
                      MadeLand{"of cells larger than tiles", 5, 4, 333, 217, 300, 40, 20, 15, 100, 50, 500000, 5600000},
                      MadeLand{"of one cell", 1, 1, 500, 500, 30, 60, 6, 6, 0, 0, 0, 0},
                      MadeLand{"of needles", 40, 40, 1, 1, 300, 10, 4, 4, 0, 0, 500000, 5600000},
                      MadeLand{"of long cells", 4, 90, 200, 0.7, 12, 30, 20, 2, 10, 1, 500000, 5600000},
                      MadeLand{"with terraces", 40, 40, 5, 5, 20, 37, 5, 5, 3, 4, 500000, 5600000, 9},
                      MadeLand{"quite level", 30, 30, 11, 11, 0, 50, 6, 6, 0, 0, 500000, 5600000},
                      MadeLand{"far from the origin", 30, 30, 30, 30, 90, 200, 4, 4, 50, 50, 1e7, 1e7},
                      MadeLand{"of 40 km", 70, 70, 600, 600, 900, 500, 80, 80, 700, 700, 500000, 5600000},
                      MadeLand{"below the sea", 30, 30, 10, 10, -400, 50, 6, 6, 0, 0, 700000, 3500000}),
    [](const auto& land) {
      std::string name = land.param.name;
      for (char& c : name) c = c == ' ' ? '_' : c;
      return name;
    });

}  // namespace silvavis::testing
