#include "ghosttile/fill/fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "ghosttile/density/node.h"
#include "ghosttile/tile/create.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "tests/unit/ghosttile/tile/made_details.h"

namespace ghosttile::fill {
namespace {

using density::Kind;
using density::Node;

std::shared_ptr<const tile::GhostTile> ghost_tile(std::uint64_t seed = 1) {
  tile::CreateOptions options;
  options.side_m = 0.5f;
  options.seed = seed;
  tile::Spread lumps;
  lumps.count = 160;
  tile::Spread twigs;
  twigs.count = 160;
  twigs.tilts = {{0, 30, 1}};
  options.spreads = {lumps, twigs};
  return std::make_shared<tile::GhostTile>(
      tile::create({tile::lump(0.05f, 12, 3), tile::twig(0.25f, 0.012f, 11)}, options));
}

Node box_of(double x, double y, double z, double value = 1) {
  Node box;
  box.kind = Kind::box;
  box.points = {{0.2, 0.1, 0}};
  box.size = {x, y, z};
  if (value == 1) return box;
  Node scaled;
  scaled.kind = Kind::scale;
  scaled.value = static_cast<float>(value);
  scaled.children = {box};
  return scaled;
}

Node nothing() {
  Node zero;
  zero.value = 0;
  return zero;
}

Plan plan_of(const Node& lumps, const Node& twigs, Priority priority = Priority::random) {
  Plan plan;
  plan.tile = ghost_tile();
  plan.objects.resize(2);
  plan.objects[0].density = density::Field(lumps);
  plan.objects[1].density = density::Field(twigs);
  plan.priority = priority;
  plan.seed = 5;
  return plan;
}

using Instance = std::tuple<int, int, int, std::uint16_t>;  // tile, candidate
std::vector<Instance> all_of(const Details& details) {
  std::vector<Instance> all;
  for (std::size_t t = 0; t < details.tiles.size(); ++t)
    for (const std::uint16_t c : details.of(t))
      all.emplace_back(details.tiles[t].x, details.tiles[t].y, details.tiles[t].z, c);
  return all;
}

// All that block each other: instances and refused.
std::map<TilePlace, std::set<std::uint16_t>> standing_of(const Details& details) {
  std::map<TilePlace, std::set<std::uint16_t>> standing;
  for (std::size_t t = 0; t < details.tiles.size(); ++t)
    standing[details.tiles[t]] = {details.chosen.begin() + details.first[t],
                                  details.chosen.begin() + details.first[t + 1]};
  return standing;
}

bool barred(const tile::CollisionGraph& graph, const std::map<TilePlace, std::set<std::uint16_t>>& standing,
            const TilePlace& at, std::uint32_t candidate) {
  for (int z = -graph.reach; z <= graph.reach; ++z) {
    for (int y = -graph.reach; y <= graph.reach; ++y) {
      for (int x = -graph.reach; x <= graph.reach; ++x) {
        const auto found = standing.find({at.x + x, at.y + y, at.z + z});
        if (found == standing.end()) continue;
        for (const std::uint16_t other : found->second)
          if (graph.collides(candidate, other, {x, y, z})) return true;
      }
    }
  }
  return false;
}

class Priorities : public testing::TestWithParam<Priority> {};
INSTANTIATE_TEST_SUITE_P(All, Priorities, testing::Values(Priority::random, Priority::elevation, Priority::boundary));

TEST_P(Priorities, NothingCollidesAndNothingPlaceableIsLeft) {
  Node sphere;
  sphere.kind = Kind::point;
  sphere.points = {{1, 1, 0}};
  sphere.radius_m = 1.4;
  const Plan plan = plan_of(box_of(1.3, 1.1, 0.7), sphere, GetParam());
  const Details details = fill(plan, tiles_of(plan));
  ASSERT_GT(details.count(), 200u);
  const auto& graph = plan.tile->graph;
  const auto standing = standing_of(details);
  for (const auto& [place, candidates] : standing)
    for (const std::uint16_t c : candidates) ASSERT_FALSE(barred(graph, standing, place, c));
  // Every candidate whose anchor lies where its object's density is above 0 stands, or is barred by what stands.
  const TileBox box = tiles_of(plan);
  std::size_t tried = 0;
  for (int z = box.z0; z < box.z1; ++z) {
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const auto found = standing.find({x, y, z});
        for (std::uint32_t c = 0; c < graph.candidates; ++c) {
          const tile::Candidate& candidate = plan.tile->candidates[c];
          const V3d at(x * 0.5 + double{candidate.at.x}, y * 0.5 + double{candidate.at.y},
                       z * 0.5 + double{candidate.at.z});
          const bool inside = candidate.object == 0 ? std::abs(at.x - 0.2) < 1.299 && std::abs(at.y - 0.1) < 1.099 &&
                                                          std::abs(at.z) < 0.699
                                                    : (at - V3d(1, 1, 0)).length() < 1.399;
          if (!inside) continue;
          ++tried;
          const bool stands = found != standing.end() && found->second.contains(static_cast<std::uint16_t>(c));
          ASSERT_TRUE(stands || barred(graph, standing, {x, y, z}, c)) << x << " " << y << " " << z << " " << c;
        }
      }
    }
  }
  EXPECT_GT(tried, 3000u);
}

TEST_P(Priorities, AreTheSameOnAnyNumberOfThreads) {
  const Plan plan = plan_of(box_of(6, 5, 0.6), box_of(4, 7, 0.4), GetParam());
  const silvasim::base::ThreadLimit one(1);
  const Details a = fill(plan, tiles_of(plan));
  const silvasim::base::ThreadLimit many(4);
  EXPECT_EQ(a, fill(plan, tiles_of(plan)));
}

// The promise that a renderer needs: what stands at a place is the same however much land is filled.
TEST_P(Priorities, APartHoldsWhatTheWholeHolds) {
  const Plan plan = plan_of(box_of(8, 8, 0.4), box_of(8, 8, 0.4, 0.5), GetParam());
  const Details whole = fill(plan, tiles_of(plan));
  for (const TileBox box :
       {TileBox{-3, -2, -9, 4, 3, 9}, TileBox{5, 5, -9, 6, 6, 9}, TileBox{-30, 0, -9, -12, 30, 9}}) {
    FillCounts counts;
    const Details part = fill(plan, box, {}, &counts);
    std::vector<Instance> expected = all_of(whole);
    std::erase_if(expected,
                  [&](const Instance& i) { return !box.holds(std::get<0>(i), std::get<1>(i), std::get<2>(i)); });
    EXPECT_EQ(all_of(part), expected);
    EXPECT_GT(part.count(), 0u);
    std::printf("margin %d\n", counts.margin);
  }
}

// Many candidates, so that many of one stage are possible at once.
std::shared_ptr<const tile::GhostTile> crowded_tile() {
  tile::CreateOptions options;
  options.side_m = 0.5f;
  options.spreads.resize(1);
  options.spreads[0].count = 3000;
  return std::make_shared<tile::GhostTile>(
      tile::create({tile::detail_of({objects::Sphere{{0, 0, 0}, 0.05f}})}, options));
}

TEST_P(Priorities, APartOfACrowdHoldsWhatTheWholeHolds) {
  Plan plan;
  plan.tile = crowded_tile();
  plan.objects.resize(1);
  plan.objects[0].density = density::Field(box_of(7, 7, 0.6));
  plan.priority = GetParam();
  const Details whole = fill(plan, tiles_of(plan));
  const TileBox box{-2, -1, -9, 2, 2, 9};
  std::vector<Instance> expected = all_of(whole);
  std::erase_if(expected,
                [&](const Instance& i) { return !box.holds(std::get<0>(i), std::get<1>(i), std::get<2>(i)); });
  EXPECT_EQ(all_of(fill(plan, box)), expected);
  ASSERT_GT(expected.size(), 500u);
}

TEST(Fill, SaysWhatHasNoEnd) {
  Plan plan = plan_of(nothing(), nothing());
  Node everywhere;
  plan.objects[0].density = density::Field(everywhere);
  EXPECT_THROW(fill(plan, {0, 0, -farthest_tile, 4, 4, farthest_tile + 1}), silvasim::base::Error);
}

// E4 of docs/ghost-tiles.md: refusal after selection keeps the count in proportion to the density.
TEST(Refusal, CountIsProportionalToDensity) {
  const auto count_at = [](double density) {
    const Plan plan = plan_of(box_of(8, 8, 0.5, density), nothing());
    return static_cast<double>(fill(plan, tiles_of(plan)).count());
  };
  const double full = count_at(1);
  ASSERT_GT(full, 4000);
  for (const double density : {0.1, 0.25, 0.5, 0.75}) EXPECT_NEAR(count_at(density) / full, density, 0.02) << density;
  EXPECT_NEAR(count_at(2) / full, 1, 0.001);
}

// E5: no stripes. Tiles are coloured as they are when they are worked on; no colour has more instances than another.
TEST_P(Priorities, NoColourOfTilesIsFavoured) {
  Plan plan;
  plan.tile = crowded_tile();
  plan.objects.resize(1);
  plan.objects[0].density = density::Field(box_of(30, 30, 0.25));
  plan.priority = GetParam();
  const Details details = fill(plan, tiles_of(plan));
  std::map<std::pair<int, int>, std::pair<double, double>> colours;  // instances, tiles
  for (std::size_t t = 0; t < details.tiles.size(); ++t) {
    const TilePlace& place = details.tiles[t];
    if (std::max(std::abs(place.x), std::abs(place.y)) > 56) continue;
    auto& [instances, tiles] = colours[{(place.x + 300) % 3, (place.y + 300) % 3}];
    instances += static_cast<double>(details.of(t).size());
    tiles += place.z == 0 ? 1 : 0;
  }
  ASSERT_EQ(colours.size(), 9u);
  double least = 1e9, most = 0;
  for (const auto& [colour, sums] : colours) {
    least = std::min(least, sums.first / sums.second);
    most = std::max(most, sums.first / sums.second);
  }
  EXPECT_LT((most - least) / least, 0.05);
}

// Figure 13: piles are compact where the lowest come first. With many candidates, so that there is a choice.
TEST(Elevation, PacksTheLowestFirstAndDenserThanChance) {
  tile::CreateOptions options;
  options.side_m = 0.5f;
  options.spreads.resize(1);
  options.spreads[0].count = 3000;
  const auto balls =
      std::make_shared<tile::GhostTile>(tile::create({tile::detail_of({objects::Sphere{{0, 0, 0}, 0.06f}})}, options));
  const auto count_by = [&](Priority priority) {
    Plan plan;
    plan.tile = balls;
    plan.objects.resize(1);
    plan.objects[0].density = density::Field(box_of(2, 2, 1));
    plan.priority = priority;
    return static_cast<double>(fill(plan, tiles_of(plan)).count());
  };
  const double by_chance = count_by(Priority::random), by_height = count_by(Priority::elevation);
  EXPECT_GT(by_height, 1.04 * by_chance);
}

class Edits : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Edits, testing::Values(1, 2, 3));

// An edit: a ball of stones is put on the litter, and taken away again.
TEST_P(Edits, KeepTheRestCollideWithNothingAndCanBeUndone) {
  Plan plan = plan_of(box_of(8, 8, 0.3), box_of(8, 8, 0.3, 0.4));
  plan.seed = GetParam();
  const Details before = fill(plan, tiles_of(plan));
  Node ball;
  ball.kind = Kind::sphere;
  ball.points = {{1, -1, 0.3}};
  ball.size = {1.5, 0, 0};
  Node with_ball;
  with_ball.kind = Kind::unite;
  with_ball.children = {box_of(8, 8, 0.3), ball};
  Plan edited = plan;
  edited.objects[0].density = density::Field(with_ball);
  const TileBox touched = tiles_within(plan, {{-0.8, -2.8, -1.5}, {2.8, 0.8, 2.1}});
  const Details after = refill(edited, before, touched);
  EXPECT_GT(after.count(), before.count() + 100);
  const auto standing = standing_of(after);
  for (const auto& [place, candidates] : standing)
    for (const std::uint16_t c : candidates) ASSERT_FALSE(barred(plan.tile->graph, standing, place, c));
  const auto outside = [&](const Details& details) {
    std::vector<Instance> all = all_of(details);
    std::erase_if(all,
                  [&](const Instance& i) { return touched.holds(std::get<0>(i), std::get<1>(i), std::get<2>(i)); });
    return all;
  };
  EXPECT_EQ(outside(before), outside(after));
  EXPECT_EQ(refill(plan, after, touched), before);
}

// Land that an edit covers as densely as what is beside it shows no seam: along the edit's rim there is as much as elsewhere.
TEST(EditedLand, HasNoSeamAtTheEditsRim) {
  const auto half = [](double from, double to) {
    Node box;
    box.kind = Kind::box;
    box.points = {{(from + to) / 2, 0, 0}};
    box.size = {(to - from) / 2, 30, 0.3};
    Node scaled;
    scaled.kind = Kind::scale;
    scaled.value = 0.7f;
    scaled.children = {box};
    return scaled;
  };
  Plan plan;
  plan.tile = crowded_tile();
  plan.objects.resize(1);
  plan.objects[0].density = density::Field(half(-12, 0.2));
  plan.seed = 3;
  const Details before = fill(plan, tiles_of(plan));
  Node both;
  both.kind = Kind::unite;
  both.children = {half(-12, 0.2), half(0.2, 12)};
  plan.objects[0].density = density::Field(both);
  const auto reach = static_cast<double>(tile::reach_of(*plan.tile));
  const Details after = refill(plan, before, tiles_within(plan, {{0.2 - reach, -31, -1}, {13, 31, 1}}));
  // Instances a metre of x, away from the ends.
  const auto between = [&](double from, double to) {
    double count = 0;
    for (std::size_t t = 0; t < after.tiles.size(); ++t) {
      for (const std::uint16_t c : after.of(t)) {
        const double x = after.tiles[t].x * 0.5 + static_cast<double>(plan.tile->candidates[c].at.x);
        count += x >= from && x < to ? 1 : 0;
      }
    }
    return count / (to - from);
  };
  const double inside = between(3, 10), outside = between(-10, -3), rim = between(-0.3, 0.7);
  ASSERT_GT(rim, 1000);
  EXPECT_NEAR(rim / inside, 1, 0.05);
  EXPECT_NEAR(outside / inside, 1, 0.05);
}

}  // namespace
}  // namespace ghosttile::fill
