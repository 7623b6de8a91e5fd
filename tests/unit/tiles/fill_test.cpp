// The promises of fill_tiles(): A2 to A6 and what its header says, over seeds, sizes, colours and both modes.
#include "silvasim/tiles/fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "silvasim/base/parallel.h"
#include "silvasim/tiles/radii.h"
#include "tests/unit/tiles/measure.h"

namespace silvasim::tiles {
namespace {

using config::RadiusDistribution;
using config::TileMode;

struct Case {
  std::string name;
  config::TileSettings settings;
};

std::vector<Case> cases(TileMode mode) {
  std::vector<Case> all;
  const auto add = [&](const std::string& name, const config::TileSettings& settings) {
    all.push_back({name, settings});
  };
  add("puget", settings_with(mode, 5, 9, 200));
  add("default", settings_with(mode, 2, 8, 200));
  add("dense", settings_with(mode, 2, 8, 200, 0.6));
  add("thin", settings_with(mode, 2, 8, 200, 0.1));
  add("equal", settings_with(mode, 6, 6, 150));
  add("smallest side", settings_with(mode, 2, 8, 64.001));
  add("odd side", settings_with(mode, 0.37, 1.1, 33.3333333));
  add("four colours", settings_with(mode, 3, 7, 120, 0.5, 4, 2));
  add("four colours, three variants", settings_with(mode, 3, 7, 120, 0.5, 4, 3));
  add("six colours", settings_with(mode, 4, 6, 90, 0.5, 6, 5));
  add("five colours, wide", settings_with(mode, 0.8, 8, 70, 0.55, 5, 2));
  config::TileSettings lognormal = settings_with(mode, 1, 8, 150, 0.5);
  lognormal.distribution = RadiusDistribution::lognormal;
  lognormal.mean_radius_m = 2.5;
  lognormal.deviation_radius_m = 1.2;
  add("lognormal", lognormal);
  config::TileSettings normal = settings_with(mode, 2, 9, 150, 0.5);
  normal.distribution = RadiusDistribution::normal;
  add("normal", normal);
  return all;
}

class EveryMode : public testing::TestWithParam<TileMode> {};
INSTANTIATE_TEST_SUITE_P(Modes, EveryMode, testing::Values(TileMode::paper, TileMode::seamless),
                         [](const auto& mode) { return mode.param == TileMode::paper ? "paper" : "seamless"; });

TEST_P(EveryMode, SitesAreOrderedInsideAndApart) {
  for (const Case& c : cases(GetParam())) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(c.name + ", seed " + std::to_string(seed));
      const TileSet set = fill_tiles(c.settings, seed);
      ASSERT_EQ(set.tiles.size(), empty_tiles(c.settings).tiles.size());
      EXPECT_EQ(set.side_m, c.settings.side_m);
      EXPECT_EQ(set.most_radius_m, c.settings.most_radius_m);
      for (const Tile& tile : set.tiles) {
        ASSERT_FALSE(tile.sites.empty());
        for (std::size_t i = 0; i < tile.sites.size(); ++i) {
          const Site& site = tile.sites[i];
          ASSERT_TRUE(site.x_m >= 0 && static_cast<double>(site.x_m) < set.side_m);
          ASSERT_TRUE(site.y_m >= 0 && static_cast<double>(site.y_m) < set.side_m);
          ASSERT_LE(static_cast<double>(site.radius_m), set.most_radius_m);
          ASSERT_GE(site.radius_m, static_cast<float>(c.settings.least_radius_m));
          if (i > 0) {
            const Site& last = tile.sites[i - 1];
            ASSERT_TRUE(std::tie(last.y_m, last.x_m, last.radius_m) < std::tie(site.y_m, site.x_m, site.radius_m));
          }
          for (std::size_t j = 0; j < i; ++j) ASSERT_FALSE(overlap(site, tile.sites[j]));
        }
      }
    }
  }
}

// A2. Strips of a colour on a side are the same in all tiles that bear it, away from the corners.
TEST(Paper, StripsAreShared) {
  for (const Case& c : cases(TileMode::paper)) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(c.name + ", seed " + std::to_string(seed));
      const TileSet set = fill_tiles(c.settings, seed);
      const double side = set.side_m, r = set.most_radius_m;
      std::map<std::pair<char, int>, std::vector<Site>> strips;
      std::size_t shared = 0;
      for (const Tile& tile : set.tiles) {
        std::map<char, std::vector<Site>> own;
        for (const Site& site : tile.sites) {
          const double x = static_cast<double>(site.x_m), y = static_cast<double>(site.y_m);
          if (from_vertex(x, y, side) <= 4 * r) continue;
          if (y < 2 * r) own['s'].push_back(site);
          if (y > side - 2 * r) own['n'].push_back(site);
          if (x < 2 * r) own['w'].push_back(site);
          if (x > side - 2 * r) own['e'].push_back(site);
        }
        const EdgeColours& e = tile.colours;
        for (const auto& [name, colour] : std::initializer_list<std::pair<char, int>>{
                 {'n', e.north}, {'e', e.east}, {'s', e.south}, {'w', e.west}}) {
          const auto [known, first] = strips.try_emplace({name, colour}, own[name]);
          if (!first) {
            ASSERT_EQ(known->second, own[name]) << name << colour;
          }
          shared += own[name].size();
        }
      }
      EXPECT_EQ(strips.size(), static_cast<std::size_t>(4 * set.colours));
      if (side > 10 * r) {
        EXPECT_GT(shared, 0u);
      }
    }
  }
}

// All pairs of tiles that can ever touch: side by side where the colours agree, corner to corner always.
template <typename Visit>
void for_all_neighbours(const TileSet& set, Visit&& visit) {
  for (const Tile& a : set.tiles) {
    for (const Tile& b : set.tiles) {
      if (a.colours.east == b.colours.west) visit(a, b, 1, 0);
      if (a.colours.north == b.colours.south) visit(a, b, 0, 1);
      visit(a, b, 1, 1);
      visit(a, b, -1, 1);
    }
  }
}

// A4. No overlap in any tiling.
TEST(Seamless, NothingOverlapsInAnyTiling) {
  for (const Case& c : cases(TileMode::seamless)) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(c.name + ", seed " + std::to_string(seed));
      const TileSet set = fill_tiles(c.settings, seed);
      std::size_t pairs = 0;
      for_all_neighbours(set, [&](const Tile& a, const Tile& b, int dx, int dy) {
        overlaps_between(a, b, dx, dy, set.side_m, set.most_radius_m, [&](const Site&, const Site&) { ++pairs; });
      });
      ASSERT_EQ(pairs, 0u);
    }
  }
}

// The same where it is hardest: equal radii, thrown to their limit, the smallest tiles, many strips that must not know each other.
TEST(Seamless, NothingOverlapsWithEqualRadii) {
  std::size_t pairs = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const TileSet set = fill_tiles(settings_with(TileMode::seamless, 8, 8, 64.01, 0.51, 6, 2), seed);
    for_all_neighbours(set, [&](const Tile& a, const Tile& b, int dx, int dy) {
      overlaps_between(a, b, dx, dy, set.side_m, set.most_radius_m, [&](const Site&, const Site&) { ++pairs; });
    });
  }
  EXPECT_EQ(pairs, 0u);
}

// A3. Overlaps are near one vertex: both sites within 4 Rmax of it, Chebyshev. Over all pairs of tiles that can touch.
TEST(Paper, OverlapsAreNearOneVertex) {
  std::size_t pairs = 0;
  for (const Case& c : cases(TileMode::paper)) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(c.name + ", seed " + std::to_string(seed));
      const TileSet set = fill_tiles(c.settings, seed);
      const double side = set.side_m, reach = 4 * set.most_radius_m;
      std::size_t astray = 0;
      for_all_neighbours(set, [&](const Tile& a, const Tile& b, int dx, int dy) {
        overlaps_between(a, b, dx, dy, side, set.most_radius_m, [&](const Site& p, const Site& q) {
          ++pairs;
          const double px = static_cast<double>(p.x_m), py = static_cast<double>(p.y_m);
          const double qx = static_cast<double>(q.x_m) + dx * side, qy = static_cast<double>(q.y_m) + dy * side;
          const double vx = std::round((px + qx) / 2 / side) * side, vy = std::round((py + qy) / 2 / side) * side;
          const auto far = [&](double x, double y) { return std::max(std::fabs(x - vx), std::fabs(y - vy)) > reach; };
          if (far(px, py) || far(qx, qy)) ++astray;
        });
      });
      EXPECT_EQ(astray, 0u);
    }
  }
  EXPECT_GT(pairs, 1000u) << "there was nothing to look at";
}

// A3 in a tiling of 100 x 100: few pairs a vertex. The literal algorithm leaves about 22.
TEST(Paper, FewPairsAVertex) {
  double least = 1e9, most = 0, sum = 0;
  constexpr int seeds = 6;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const TileSet set = fill_tiles(settings_with(TileMode::paper, 5, 9, 200), seed);
    const Tiling land = tile_land(set, 100, 100, seed);
    std::size_t pairs = 0;
    const auto count = [&](int column, int row, int dx, int dy) {
      if (column + dx < 0 || column + dx >= land.columns || row - dy < 0) return;
      overlaps_between(set.tiles[land.at(column, row)], set.tiles[land.at(column + dx, row - dy)], dx, dy, set.side_m,
                       set.most_radius_m, [&](const Site&, const Site&) { ++pairs; });
    };
    for (int row = 0; row < land.rows; ++row) {
      for (int column = 0; column < land.columns; ++column) {
        count(column, row, 1, 0), count(column, row, 0, 1), count(column, row, 1, 1), count(column, row, -1, 1);
      }
    }
    const double a_vertex = static_cast<double>(pairs) / (99.0 * 99.0);
    least = std::min(least, a_vertex), most = std::max(most, a_vertex), sum += a_vertex;
  }
  RecordProperty("pairs_a_vertex",
                 std::to_string(sum / seeds) + " (" + std::to_string(least) + " to " + std::to_string(most) + ")");
  EXPECT_GT(sum / seeds, 0.1);
  EXPECT_LT(most, 5);
}

// A4's bands, for both modes: ground under discs by the distance from the nearest edge, against the interior's.
TEST_P(EveryMode, CoverageIsEvenAcrossTheEdges) {
  for (const auto& [least, most, coverage] :
       {std::array{5.0, 9.0, 0.5}, {2.0, 8.0, 0.5}, {2.0, 8.0, 0.6}, {2.0, 8.0, 0.2}}) {
    SCOPED_TRACE(testing::Message() << least << ".." << most << " coverage " << coverage);
    constexpr int bands = 10;  // each half an Rmax wide; the last is the interior
    std::array<double, bands + 1> points{}, under{};
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const TileSet set = fill_tiles(settings_with(GetParam(), least, most, 200, coverage), seed);
      const Tiling land = tile_land(set, 20, 20, seed);
      const Ground ground(set, land);
      base::Stream random(seed, base::Purpose::rotation);
      for (int i = 0; i < 200'000; ++i) {
        const double x = set.side_m * (1 + 18 * random.next_double()), y = set.side_m * (1 + 18 * random.next_double());
        const double edge = from_edge(std::fmod(x, set.side_m), std::fmod(y, set.side_m), set.side_m);
        const std::size_t band = static_cast<std::size_t>(std::min<double>(bands, edge / (0.5 * most)));
        points[band] += 1;
        under[band] += ground.covered(x, y) ? 1 : 0;
      }
    }
    const double interior = under[bands] / points[bands];
    double all_points = 0, all_under = 0;
    std::string profile;
    for (int b = 0; b <= bands; ++b) {
      const std::size_t i = static_cast<std::size_t>(b);
      all_points += points[i], all_under += under[i];
      profile += " " + std::to_string(under[i] / points[i] / interior).substr(0, 5);
      EXPECT_NEAR(under[i] / points[i] / interior, 1, 0.2) << "band " << b;
    }
    EXPECT_NEAR(all_under / all_points / coverage, 1, 0.02) << "overall";
    RecordProperty("bands_" + std::to_string(static_cast<int>(most)) + "_" + std::to_string(coverage).substr(0, 4),
                   profile);
  }
}

double mean_of(const TileSet& set) {
  double sum = 0, count = 0;
  for (const Tile& tile : set.tiles) {
    for (const Site& site : tile.sites) sum += static_cast<double>(site.radius_m), count += 1;
  }
  return sum / count;
}

double count_of(const TileSet& set) {
  double count = 0;
  for (const Tile& tile : set.tiles) count += static_cast<double>(tile.sites.size());
  return count;
}

// Kolmogorov-Smirnov distance between the accepted radii and the asked distribution.
double distance_of(const TileSet& set, const Radii& radii) {
  std::vector<float> accepted;
  for (const Tile& tile : set.tiles) {
    for (const Site& site : tile.sites) accepted.push_back(site.radius_m);
  }
  std::sort(accepted.begin(), accepted.end());
  double worst = 0;
  constexpr int steps = 1000;
  for (int i = 1; i < steps; ++i) {
    const double u = static_cast<double>(i) / steps;
    const auto above = std::upper_bound(accepted.begin(), accepted.end(), radii.quantile(u));
    const double share = static_cast<double>(above - accepted.begin()) / static_cast<double>(accepted.size());
    worst = std::max(worst, std::fabs(share - u));
  }
  return worst;
}

// A5. The accepted radii have the asked distribution: mean within 3 % for every seed, Kolmogorov-Smirnov distance below 0.05 on average
// (the few sites of the strips are repeated in many tiles, which makes it larger than that of independent draws).
TEST_P(EveryMode, AcceptedRadiiAreThoseAsked) {
  for (const Case& c : cases(GetParam())) {
    if (c.settings.side_m < 12 * c.settings.most_radius_m || c.name == "equal") continue;
    SCOPED_TRACE(c.name);
    const Radii radii(c.settings);
    double distance = 0;
    constexpr int seeds = 8;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const TileSet set = fill_tiles(c.settings, seed);
      EXPECT_NEAR(mean_of(set) / radii.mean_m(), 1, 0.03) << "seed " << seed;
      distance += distance_of(set, radii) / seeds;
    }
    EXPECT_LT(distance, 0.05);
  }
}

// A5 where chance is small: 20,000 sites a tile.
TEST_P(EveryMode, ManySitesFollowTheDistributionClosely) {
  config::TileSettings settings = settings_with(GetParam(), 0.25, 0.8, 200);
  settings.distribution = RadiusDistribution::lognormal;
  settings.mean_radius_m = 0.45;
  settings.deviation_radius_m = 0.15;
  const Radii radii(settings);
  const TileSet set = fill_tiles(settings, 1);
  EXPECT_GT(count_of(set), 18 * 20'000);
  EXPECT_NEAR(mean_of(set) / radii.mean_m(), 1, 0.002);
  EXPECT_LT(distance_of(set, radii), 0.004);
}

// The asked coverage is reached up to its limit, also with equal radii, whose limit is lower.
TEST_P(EveryMode, ReachesTheAskedCoverage) {
  for (const auto& [least, most, coverage] : {std::array{2.0, 8.0, 0.6},
                                              {4.0, 8.0, 0.6},
                                              {6.0, 8.0, 0.55},
                                              {7.0, 8.0, 0.52},
                                              {8.0, 8.0, 0.51},
                                              {8.0, 8.0, 0.3}}) {
    const auto settings = settings_with(GetParam(), least, most, 400, coverage);
    double sites = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) sites += count_of(fill_tiles(settings, seed)) / 3;
    const double asked = Radii(settings).sites_per_m2(coverage) * 400 * 400 * 18;
    EXPECT_NEAR(sites / asked, 1, 0.02) << least << ".." << most << " coverage " << coverage;
  }
}

// A6. Radii are metres: with fixed radii sites grow as the area does.
TEST_P(EveryMode, SitesGrowAsTheArea) {
  std::array<double, 3> sites{};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (int i = 0; i < 3; ++i) {
      sites[static_cast<std::size_t>(i)] +=
          count_of(fill_tiles(settings_with(GetParam(), 5, 9, 300.0 * (i + 1)), seed));
    }
  }
  EXPECT_NEAR(sites[1] / sites[0], 4, 0.06);
  EXPECT_NEAR(sites[2] / sites[0], 9, 0.13);
}

// Table 1's Puget Sound has about 125 plants on a tile of 200 m.
TEST_P(EveryMode, FiveToNineMetresGiveTheDensityOfPugetSound) {
  double sites = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    sites += count_of(fill_tiles(settings_with(GetParam(), 5, 9, 200), seed)) / 8 / 18;
  }
  EXPECT_NEAR(sites, 126, 3);
}

TEST_P(EveryMode, SameSeedSameBytes) {
  for (const Case& c : cases(GetParam())) {
    SCOPED_TRACE(c.name);
    const TileSet once = fill_tiles(c.settings, 7, 1);
    for (const int threads : {1, 2, 3, 8}) {
      const base::ThreadLimit limit(threads);
      ASSERT_EQ(fill_tiles(c.settings, 7, 1), once) << threads << " threads";
    }
    EXPECT_NE(fill_tiles(c.settings, 8, 1), once);
    EXPECT_NE(fill_tiles(c.settings, 7, 2), once);
  }
}

// No two tiles of a set are alike, and none is another's mirror image by accident of the streams.
TEST_P(EveryMode, TilesDiffer) {
  const TileSet set = fill_tiles(settings_with(GetParam(), 2, 8, 200), 3);
  std::set<std::pair<float, float>> seen;
  std::size_t interior = 0;
  for (const Tile& tile : set.tiles) {
    for (const Site& site : tile.sites) {
      if (from_edge(static_cast<double>(site.x_m), static_cast<double>(site.y_m), 200) < 17) continue;
      ++interior;
      EXPECT_TRUE(seen.insert({site.x_m, site.y_m}).second);
    }
  }
  EXPECT_GT(interior, 1000u);
}

// What a seed means may not change by accident. Stored, for nothing else can tell.
TEST_P(EveryMode, BytesDoNotChange) {
  config::TileSettings settings = settings_with(GetParam(), 1, 8, 150);
  settings.distribution = RadiusDistribution::lognormal;
  settings.mean_radius_m = 3;
  settings.deviation_radius_m = 1.5;
  std::uint64_t digest = 0;
  for (const Tile& tile : fill_tiles(settings, 42).tiles) {
    for (const Site& site : tile.sites) {
      for (const float value : {site.x_m, site.y_m, site.radius_m}) {
        digest = (digest ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15u;
        digest ^= digest >> 29;
      }
    }
  }
  EXPECT_EQ(digest, GetParam() == TileMode::paper ? 15800837029354343833u : 10865974077934534636u);
}

}  // namespace
}  // namespace silvasim::tiles
