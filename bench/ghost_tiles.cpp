// Ghost Tiles beside the paper's: Table 1 (making a tile and its graph) and Table 2 (filling and editing).
//
// ghost_tiles [--table 1|2] [--threads N] [--runs N]: prints Markdown. Times are the least of the runs, of the wall clock.
// Table 1: the paper's collision counts cannot come from the sizes that it states, so the threshold is set so that as many pairs collide
//   as there; the sphere sets are fitted before. The baseline tests every sphere of every pair and offset, on a part of the pairs.
// Table 2: scenes of configs/details; local rows are edits of the meadow and of the mushrooms.
// Source: Guérin et al. 2016, tables 1 and 2.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "ghosttile/config/scene.h"
#include "ghosttile/config/tile_xml.h"
#include "ghosttile/fill/edit.h"
#include "ghosttile/tile/create.h"
#include "silvasim/base/file.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"

namespace {

using namespace ghosttile;

struct Setup {
  int table = 0, threads = 0, runs = 3;
};

const std::string configs = SILVA_SOURCE_DIR "/configs/details/";

double seconds(const std::function<void()>& act) {
  const auto begin = std::chrono::steady_clock::now();
  act();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
double least_of(int runs, const std::function<void()>& act) {
  double least = 1e9;
  for (int r = 0; r < runs; ++r) least = std::min(least, seconds(act));
  return least;
}

std::uint64_t pairs_at(const config::TileXml& loaded, float delta_m) {
  tile::CreateOptions options = loaded.options;
  options.delta_m = delta_m;
  return tile::create(loaded.objects, options).graph.arcs() / 2;
}

// The threshold at which as many pairs collide.
float delta_for(const config::TileXml& loaded, double pairs) {
  float low = -0.3f, high = 0.7f;
  for (int step = 0; step < 14; ++step) {
    const float middle = (low + high) / 2;
    (static_cast<double>(pairs_at(loaded, middle)) < pairs ? low : high) = middle;
  }
  return (low + high) / 2;
}

// Sphere by sphere, no grid, no clusters: nanoseconds a pair of spheres, and how many there are in all.
struct Brute {
  double ns_a_test = 0, tests = 0;
};
Brute brute_force(const tile::GhostTile& tile) {
  struct Ball {
    float x, y, z, r;
  };
  std::vector<std::vector<Ball>> balls;
  double spheres = 0;
  for (const tile::Candidate& candidate : tile.candidates) {
    balls.emplace_back();
    for (const auto& sphere : tile.objects[candidate.object].spheres) {
      const auto at = candidate(sphere.centre);
      balls.back().push_back({at.x, at.y, at.z, sphere.radius_m * candidate.scale});
    }
    spheres += static_cast<double>(balls.back().size());
  }
  const double offsets = std::pow(tile.graph.side(), 3);
  std::uint64_t tests = 0, hits = 0;
  const std::size_t part = std::min<std::size_t>(24, balls.size());
  const double s = seconds([&] {
    for (std::size_t i = 0; i < part; ++i) {
      for (const auto& b : balls) {
        int hit = 0;
        for (const Ball& p : balls[i]) {
          for (const Ball& q : b) {
            const float x = p.x - q.x, y = p.y - q.y, z = p.z - q.z, sum = p.r + q.r + tile.delta_m;
            hit |= static_cast<int>(x * x + y * y + z * z <= sum * sum);
          }
          tests += b.size();
        }
        hits += static_cast<std::uint64_t>(hit);
      }
    }
  });
  if (hits == 12345678901) fmt::print("\n");
  return {s / static_cast<double>(tests) * 1e9, spheres * spheres * offsets / 2};
}

void table_1(const Setup& setup) {
  struct Row {
    std::string name, file;
    double pairs, paper_s, paper_kb, target_s, target_kb;
  };
  const std::vector<Row> rows = {{"Rocks", "rocks", 14e3, 0.17, 80, 0.02, 40},
                                 {"Branches, rocks", "branches", 990e3, 93, 4770, 2, 2200},
                                 {"Autumn leaves", "autumn-leaves", 102e3, 31, 454, 0, 0},
                                 {"Mushrooms", "mushrooms", 137e3, 87.5, 559, 0, 0},
                                 {"Pine needles, leaves", "needles", 941e3, 138, 4290, 3, 1400}};
  const silvasim::base::ThreadLimit one(1);
  fmt::print(
      "| tile | candidates | pairs | threshold mm | s | paper s | graph kB | paper kB | pairs looked at | ns a pair | "
      "brute force s | times |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    config::TileXml loaded = config::load_tile_xml(configs + "tiles/" + row.file + ".xml");
    loaded.options.delta_m = delta_for(loaded, row.pairs);
    tile::CreateCounts counts;
    tile::GhostTile tile;
    const double s = least_of(setup.runs, [&] { tile = tile::create(loaded.objects, loaded.options, {}, &counts); });
    const Brute brute = brute_force(tile);
    const double brute_s = brute.tests * brute.ns_a_test * 1e-9;
    fmt::print("| {} | {} | {} | {:.1f} | {:.3f} | {:g} | {:.0f} | {:g} | {} | {:.0f} | {:.1f} | {:.0f} |\n", row.name,
               tile.candidates.size(), counts.colliding, static_cast<double>(tile.delta_m) * 1000, s, row.paper_s,
               static_cast<double>(tile.graph.bytes()) / 1000, row.paper_kb, counts.looked_at,
               s * 1e9 / static_cast<double>(counts.looked_at), brute_s, brute_s / s);
  }
}

struct Filled {
  fill::DetailsFile file;
  std::unique_ptr<config::Scene> scene;
};

void print_row(const std::string& name, std::uint64_t instances, double candidates, double paper_candidates, double s,
               double paper_s, std::size_t bytes) {
  fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.4f} | {:g} | {:.1f} | {:.1f} |\n", name, instances, candidates / 1e6,
             paper_candidates / 1e6, s, paper_s, s * 1e9 / std::max(1.0, candidates),
             static_cast<double>(bytes) / std::max<double>(1, static_cast<double>(instances)));
}

Filled global(const Setup& setup, const std::string& name, const std::string& file, double paper_candidates,
              double paper_s) {
  Filled filled;
  filled.scene = std::make_unique<config::Scene>(configs + "scenes/" + file + ".xml");
  const density::Box3 region = config::everywhere();
  const fill::Plan plan = filled.scene->plan(region);
  filled.file.tile = filled.scene->tile();
  filled.file.filled = fill::tiles_of(plan);
  fill::FillCounts counts;
  const double s =
      least_of(setup.runs, [&] { filled.file.details = fill::fill(plan, filled.file.filled, {}, &counts); });
  if (!name.empty())
    print_row(name, filled.file.details.count(), static_cast<double>(counts.candidates), paper_candidates, s, paper_s,
              filled.file.details.bytes());
  return filled;
}

void local(const Setup& setup, const std::string& name, Filled& filled, const std::string& strokes,
           double paper_candidates, double paper_s) {
  const auto reach = static_cast<double>(tile::reach_of(*filled.file.tile));
  double s = 1e9, candidates = 0;
  std::uint64_t instances = 0;
  for (int r = 0; r < 5 * setup.runs; ++r) {
    fill::DetailsFile file = filled.file;
    s = std::min(s, seconds([&] {
                   const density::Box3 box = filled.scene->touched_by(strokes, "strokes");
                   const density::Box3 around{box.least - density::V3d(reach, reach, reach),
                                              box.most + density::V3d(reach, reach, reach)};
                   const fill::Plan plan = filled.scene->plan(around, {strokes});
                   fill::edit(plan, file, fill::tiles_within(plan, around), strokes);
                 }));
    const fill::TileBox& box = file.edits.back().touched;
    candidates = static_cast<double>(box.x1 - box.x0) * (box.y1 - box.y0) * (box.z1 - box.z0) *
                 static_cast<double>(filled.file.tile->candidates.size());
    instances = fill::part_of(file.details, box).count();
  }
  print_row(name, instances, candidates, paper_candidates, s, paper_s, 0);
}

void table_2(const Setup& setup) {
  fmt::print(
      "| scene | instances | candidates, M | paper's, M | s | paper s | ns a candidate | bytes an instance "
      "|\n|---|---|---|---|---|---|---|---|\n");
  Filled meadow = global(setup, "", "meadow", 0, 0);
  const auto stroke = [](double radius_m) {
    return fmt::format("<strokes><add object=\"stone\"><sphere at=\"1, 1, 0\" size=\"{} m\"/></add></strokes>",
                       radius_m);
  };
  local(setup, "Meadow, local", meadow, stroke(0.2), 58e3, 0.3);
  local(setup, "Meadow, local", meadow, stroke(0.9), 320e3, 1.2);
  local(setup, "Meadow, local", meadow, stroke(1.3), 577e3, 3.4);
  Filled mushrooms = global(setup, "", "mushrooms", 0, 0);
  local(setup, "Mushrooms, local", mushrooms,
        "<strokes><add object=\"mushroom\"><sphere at=\"0, 0, 0\" size=\"1.2 m\"/></add></strokes>", 219e3, 0.9);
  global(setup, "Field", "field", 37e6, 54.6);
  global(setup, "Beaver", "beaver-dam", 26.3e6, 10.7);
  global(setup, "Haystack", "haystacks", 10.5e6, 6.8);
  global(setup, "Borie", "hut", 33.9e6, 16.8);
  fmt::print("\nPeak of the process: {:.0f} MB\n", static_cast<double>(silvasim::base::peak_rss_bytes()) / 1e6);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Ghost Tiles beside the paper's tables 1 and 2", "ghost_tiles");
  Setup setup;
  app.add_option("--table", setup.table, "1 or 2 (default: both)")->check(CLI::Range(1, 2));
  app.add_option("--threads", setup.threads, "Threads for table 2 (default: one a core)")->check(CLI::Range(1, 1024));
  app.add_option("--runs", setup.runs, "The least of so many runs (default: 3)")->check(CLI::Range(1, 100));
  CLI11_PARSE(app, argc, argv);
  try {
    const silvasim::base::ThreadLimit threads(setup.threads);
    if (setup.table != 2) table_1(setup);
    if (setup.table == 0) fmt::print("\n");
    if (setup.table != 1) table_2(setup);
  } catch (const std::exception& error) {
    fmt::print(stderr, "ghost_tiles: error: {}\n", error.what());
    return 1;
  }
  return 0;
}
