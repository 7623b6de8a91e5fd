// What is said about wrong tile settings, word for word where a user depends on it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "silvasim/base/error.h"
#include "silvasim/tiles/check.h"
#include "silvasim/tiles/fill.h"

namespace silvasim::tiles {
namespace {

using config::RadiusDistribution;
using testing::HasSubstr;

template <typename Change>
std::string message_after(Change&& change) {
  config::TileSettings settings;
  settings.place = {"ecosystem.xml", 12, 3};
  change(settings);
  const auto found = faults(settings);
  std::string all;
  for (const auto& finding : found) {
    EXPECT_EQ(finding.place, settings.place);
    all += finding.message + "\n";
  }
  if (found.empty()) return "nothing";
  try {
    fill_tiles(settings, 1);
    ADD_FAILURE() << "filled in spite of: " << all;
  } catch (const base::ConfigError& error) {
    EXPECT_EQ(error.diagnostics(), found);
  }
  return all;
}

TEST(TileSettings, DefaultsAreGood) { EXPECT_TRUE(faults({}).empty()); }

TEST(TileSettings, SideNamesBothNumbers) {
  EXPECT_EQ(message_after([](auto& s) { s.side_m = 64; }),
            "side=\"64 m\" must be larger than 8 times the largest radius (most=\"8 m\"), that is larger than 64 m\n");
  EXPECT_EQ(message_after([](auto& s) { s.side_m = 64.001; }), "nothing");
}

TEST(TileSettings, ColoursAndVariants) {
  EXPECT_THAT(message_after([](auto& s) { s.colours = 2, s.variants = 1; }),
              HasSubstr("colours=\"2\" must be 3 to 16"));
  EXPECT_THAT(message_after([](auto& s) { s.colours = 17; }), HasSubstr("colours=\"17\" must be 3 to 16"));
  EXPECT_THAT(message_after([](auto& s) { s.colours = -3; }), HasSubstr("colours=\"-3\""));
  EXPECT_THAT(message_after([](auto& s) { s.variants = 3; }), HasSubstr("variants=\"3\" must be 2 to 2"));
  EXPECT_THAT(message_after([](auto& s) { s.variants = 1; }), HasSubstr("variants=\"1\" must be 2 to 2"));
  EXPECT_EQ(message_after([](auto& s) { s.colours = 6, s.variants = 5; }), "nothing");
}

TEST(TileSettings, Radii) {
  EXPECT_THAT(message_after([](auto& s) { s.least_radius_m = 0; }), HasSubstr("larger than 0 m"));
  EXPECT_THAT(message_after([](auto& s) { s.least_radius_m = 9; }),
              HasSubstr("most=\"8 m\" must not be smaller than least=\"9 m\""));
  EXPECT_THAT(message_after([](auto& s) { s.mean_radius_m = 5; }), HasSubstr("not to \"uniform\""));
  const auto normal = [](double mean, double deviation) {
    return message_after([&](auto& s) {
      s.distribution = RadiusDistribution::normal;
      s.mean_radius_m = mean, s.deviation_radius_m = deviation;
    });
  };
  EXPECT_THAT(normal(10, 1), HasSubstr("mean=\"10 m\" must lie between least=\"2 m\" and most=\"8 m\""));
  EXPECT_THAT(normal(-1, 1), HasSubstr("must lie between"));
  EXPECT_THAT(normal(5, -1), HasSubstr("deviation=\"-1 m\" must be at least 0.0008 m"));
  EXPECT_EQ(normal(5, 1), "nothing");
}

TEST(TileSettings, Coverage) {
  EXPECT_THAT(message_after([](auto& s) { s.coverage = 0; }), HasSubstr("larger than 0 and at most 0.6"));
  EXPECT_THAT(message_after([](auto& s) { s.coverage = 0.61; }), HasSubstr("larger than 0 and at most 0.6"));
  EXPECT_EQ(message_after([](auto& s) { s.coverage = 0.6; }), "nothing");
  EXPECT_EQ(message_after([](auto& s) { s.least_radius_m = 8, s.coverage = 0.51; }), "nothing");
  EXPECT_THAT(
      message_after([](auto& s) { s.least_radius_m = 8, s.coverage = 0.52; }),
      HasSubstr("coverage=\"0.52\" cannot be reached with radii of 8 m to 8 m, which are too much alike: at most "
                "0.51"));
}

TEST(TileSettings, NoNumberAtAll) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, -1.0}) {
    EXPECT_NE(message_after([&](auto& s) { s.side_m = bad; }), "nothing") << bad;
    EXPECT_NE(message_after([&](auto& s) { s.least_radius_m = bad; }), "nothing") << bad;
    EXPECT_NE(message_after([&](auto& s) { s.most_radius_m = bad; }), "nothing") << bad;
    EXPECT_NE(message_after([&](auto& s) { s.coverage = bad; }), "nothing") << bad;
    for (const auto d : {RadiusDistribution::normal, RadiusDistribution::lognormal}) {
      EXPECT_NE(message_after([&](auto& s) { s.distribution = d, s.mean_radius_m = bad; }), "nothing") << bad;
      EXPECT_NE(message_after([&](auto& s) { s.distribution = d, s.deviation_radius_m = bad; }), "nothing") << bad;
    }
  }
}

TEST(TileSettings, TooManySites) {
  EXPECT_THAT(message_after([](auto& s) { s.side_m = 1e7; }), HasSubstr("at most 1e+06 are allowed: choose a side of"));
}

TEST(TileSettings, FindsEverythingAtOnce) {
  config::TileSettings settings;
  settings.side_m = 1, settings.colours = 1, settings.coverage = 2;
  EXPECT_EQ(faults(settings).size(), 3u);
}

}  // namespace
}  // namespace silvasim::tiles
