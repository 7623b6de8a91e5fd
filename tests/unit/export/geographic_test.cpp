#include "silvasim/export/geographic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "made_land.h"
#include "silvasim/base/error.h"
#include "silvasim/base/random.h"
#include "silvasim/fields/crs.h"

namespace silvasim::exports {
namespace {

// A degree of latitude has about 111 km.
double metres_apart(base::Point a, base::Point b) {
  const double north = (a.y - b.y) * 111e3;
  const double east = (a.x - b.x) * 111e3 * std::cos(a.y * 3.14159265 / 180);
  return std::sqrt(north * north + east * east);
}

TEST(Geographic, agrees_with_the_crs_to_a_millimetre) {
  constexpr std::uint64_t seed = 5;
  struct Case {
    const char* crs;
    base::Box box;
  };
  const Case cases[] = {
      {"EPSG:32610", {585000, 5180000, 605000, 5200000}},
      {"EPSG:32610", {300000, 5000000, 700000, 5400000}},  // 400 km, beyond the net's finest cells
      {"EPSG:32633", {500000, 8700000, 640000, 8900000}},  // Svalbard
      {"EPSG:32760", {690000, 8000000, 720000, 8010000}},  // Fiji, beside the date line
      {"EPSG:32601", {300000, 7000000, 301000, 7000300}},
      {"EPSG:2056", {2600000, 1190000, 2640000, 1230000}},  // Switzerland's oblique Mercator
      {"EPSG:3035", {4000000, 2800000, 4100000, 2900000}},
  };
  base::Stream random(seed, base::Purpose::selection);
  for (const Case& each : cases) {
    const fields::Crs crs = fields::crs_from_text(each.crs);
    const Geographic geographic(fields::wkt_of(crs), each.box);
    ASSERT_TRUE(geographic.known());
    const fields::Transformation way(crs, fields::wgs84());
    for (int i = 0; i < 2000; ++i) {
      const base::Point point{each.box.west + random.next_double() * each.box.width(),
                              each.box.south + random.next_double() * each.box.height()};
      const auto wanted = way.apply(point);
      ASSERT_TRUE(wanted.has_value());
      EXPECT_LT(metres_apart(geographic.at(point), *wanted), 1e-3) << each.crs << " seed " << seed << " round " << i;
    }
  }
}

TEST(Geographic, without_a_crs_nothing_is_known) {
  EXPECT_FALSE(Geographic("", {0, 0, 10, 10}).known());
  EXPECT_THROW(Geographic("nonsense", {0, 0, 10, 10}), base::Error);
  EXPECT_EQ(crs_name(""), "local metres");
  EXPECT_EQ(crs_name("nonsense"), "unknown CRS");
  EXPECT_EQ(crs_name(testing::utm_10_north()), "WGS 84 / UTM zone 10N (EPSG:32610)");
}

}  // namespace
}  // namespace silvasim::exports
