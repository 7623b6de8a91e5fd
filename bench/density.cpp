// Density fields: haystacks over a layer of litter on rough ground, cut down by halving to tiles and evaluated there, beside the
// whole tree evaluated at every point.
//
// density [--stacks N] [--side M] [--tile M] [--points N] [--runs N]: prints Markdown. One thread; medians of the runs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "ghosttile/density/ground_plane.h"
#include "ghosttile/density/node.h"
#include "silvasim/base/random.h"

namespace {

using namespace ghosttile::density;

struct Setup {
  int stacks = 40, side_tiles = 64, tiles_high = 8, points = 610, runs = 5;
  double tile_m = 0.5;
};

double share(std::uint32_t a, std::uint32_t b) {
  return static_cast<double>(silvasim::base::uniform_at(1, silvasim::base::Purpose::density_warp, a, b, 0));
}

Terrain rough_ground(double side_m) {
  Terrain terrain;
  terrain.cell_width_m = terrain.cell_height_m = 1;
  terrain.columns = terrain.rows = static_cast<int>(side_m);
  terrain.north = side_m;
  for (int row = 0; row < terrain.rows; ++row)
    for (int column = 0; column < terrain.columns; ++column)
      terrain.heights_m.push_back(static_cast<float>(
          0.3 + 0.2 * share(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)) + 0.01 * row));
  return terrain;
}

Node haystacks(const Setup& setup, const Terrain& terrain) {
  const double side_m = setup.side_tiles * setup.tile_m;
  Node ground, all;
  ground.kind = Kind::layer;
  ground.plane = ground_plane(terrain);
  ground.to_m = 0.05;
  ground.radius_m = 0.1;
  all.kind = Kind::blend;
  all.children = {ground};
  for (int i = 0; i < setup.stacks; ++i) {
    const double x = side_m * share(1000000, static_cast<std::uint32_t>(i)),
                 y = side_m * share(1000001, static_cast<std::uint32_t>(i));
    Node stack;
    stack.kind = Kind::cylinder;
    stack.points = {V3d(x, y, 0.3), V3d(x, y, 2)};
    stack.size.x = 0.9;
    stack.radius_m = 0.3;
    all.children.push_back(stack);
  }
  return all;
}

struct Work {
  const Setup& setup;
  std::vector<float> x, y, z, values;
  Scratch scratch;
  double sum = 0, evaluating_s = 0;
  std::uint64_t tiles = 0, empty_tiles = 0, evaluated = 0;
  bool evaluates = true;

  void evaluate(const Compiled& field) {
    for (std::size_t i = 0; i < x.size(); i += block_size) {
      const std::size_t count = std::min(block_size, x.size() - i);
      field.evaluate({x.data() + i, y.data() + i, z.data() + i, count}, scratch, values.data() + i);
      evaluated += count;
    }
    for (const float value : values) sum += static_cast<double>(value);
  }

  void halve(const Field& field, const int* least, const int* most) {
    const auto at = [&](const int* tile) { return V3d(tile[0], tile[1], tile[2]) * setup.tile_m; };
    const Box3 box{at(least), at(most)};
    int longest = 0;
    for (int k = 1; k < 3; ++k)
      if (most[k] - least[k] > most[longest] - least[longest]) longest = k;
    if (most[longest] - least[longest] == 1) {
      ++tiles;
      const Compiled compiled = field.compiled(box.least, box);
      if (compiled.empty()) {
        ++empty_tiles;
      } else if (evaluates) {
        evaluate(compiled);
      }
      return;
    }
    const Field inner = field.within(box);
    if (inner.empty()) {
      const auto count = static_cast<std::uint64_t>((most[0] - least[0]) * (most[1] - least[1]) * (most[2] - least[2]));
      tiles += count;
      empty_tiles += count;
      return;
    }
    int middle[2][3];
    std::copy_n(most, 3, middle[0]);
    std::copy_n(least, 3, middle[1]);
    middle[0][longest] = middle[1][longest] = (least[longest] + most[longest]) / 2;
    halve(inner, least, middle[0]);
    halve(inner, middle[1], most);
  }
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int main(int argc, char** argv) {
  Setup setup;
  CLI::App app("Density fields cut down to tiles, beside the whole tree at every point");
  app.add_option("--stacks", setup.stacks, "cylinders")->check(CLI::NonNegativeNumber);
  app.add_option("--side", setup.side_tiles, "tiles along a side of the land")->check(CLI::PositiveNumber);
  app.add_option("--tile", setup.tile_m, "side of a tile, metres")->check(CLI::PositiveNumber);
  app.add_option("--points", setup.points, "in a tile")->check(CLI::PositiveNumber);
  app.add_option("--runs", setup.runs, "of which the median counts")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);

  const Terrain terrain = rough_ground(setup.side_tiles * setup.tile_m);
  const Field field(haystacks(setup, terrain));
  Work work{setup, {}, {}, {}, {}, {}};
  const auto count = static_cast<std::size_t>(setup.points);
  for (std::uint32_t i = 0; i < count; ++i) {
    work.x.push_back(static_cast<float>(setup.tile_m * share(2000000, i)));
    work.y.push_back(static_cast<float>(setup.tile_m * share(2000001, i)));
    work.z.push_back(static_cast<float>(setup.tile_m * share(2000002, i)));
  }
  work.values.resize(count);
  const int least[3] = {0, 0, 0}, most[3] = {setup.side_tiles, setup.side_tiles, setup.tiles_high};

  const auto median = [&](bool evaluates) {
    std::vector<double> times;
    for (int run = 0; run < setup.runs; ++run) {
      work.sum = 0;
      work.tiles = work.empty_tiles = work.evaluated = 0;
      work.evaluates = evaluates;
      const auto begin = std::chrono::steady_clock::now();
      work.halve(field, least, most);
      times.push_back(seconds_since(begin));
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
  };
  const double cutting_s = median(false), both_s = median(true), sum = work.sum;
  const double points = static_cast<double>(work.tiles) * setup.points;

  // The whole tree, compiled for each tile's corner without being cut.
  const double side_m = setup.side_tiles * setup.tile_m;
  const Box3 land{V3d(0), V3d(side_m, side_m, setup.tiles_high * setup.tile_m)};
  Work whole{setup, work.x, work.y, work.z, work.values, {}};
  const auto begin = std::chrono::steady_clock::now();
  for (int z = 0; z < setup.tiles_high; ++z)
    for (int y = 0; y < setup.side_tiles; ++y)
      for (int x = 0; x < setup.side_tiles; ++x) whole.evaluate(field.compiled(V3d(x, y, z) * setup.tile_m, land));
  const double whole_s = seconds_since(begin);

  fmt::print("{} cylinders over a layer, {} tiles of {} m, {:.1f} million points; {:.0f} % of the tiles are empty.\n\n",
             setup.stacks, work.tiles, setup.tile_m, points / 1e6,
             100.0 * static_cast<double>(work.empty_tiles) / static_cast<double>(work.tiles));
  fmt::print("| | seconds | ns a point | ns a point evaluated |\n|---|---|---|---|\n");
  fmt::print("| cut down and evaluated | {:.3f} | {:.2f} | {:.2f} |\n", both_s, both_s / points * 1e9,
             both_s / static_cast<double>(work.evaluated) * 1e9);
  fmt::print("| the whole tree | {:.3f} | {:.2f} | {:.2f} |\n\n", whole_s, whole_s / points * 1e9,
             whole_s / points * 1e9);
  fmt::print(
      "Cutting and compiling: {:.2f} us a tile, {:.2f} us a tile that is not empty. Ratio {:.1f}; sums {} and {}.\n",
      cutting_s / static_cast<double>(work.tiles) * 1e6,
      cutting_s / static_cast<double>(work.tiles - work.empty_tiles) * 1e6, whole_s / both_s, sum, whole.sum);
  return sum == whole.sum || std::abs(sum - whole.sum) < 1e-9 * sum ? 0 : 1;
}
