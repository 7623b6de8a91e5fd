// The sun against published positions and what every almanac knows.
#include "silvavis/shade/sun.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

#include "silvasim/base/error.h"

namespace silvavis::shade {
namespace {

using silvasim::base::Error;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

SunPosition at(const std::string& moment, double longitude_deg, double latitude_deg) {
  return sun_position(parse_moment(moment), longitude_deg, latitude_deg);
}

// The true elevation whose refraction is taken off again.
double without_refraction(double seen_deg) {
  double truth = seen_deg;
  for (int i = 0; i < 30; ++i) truth = seen_deg - refraction_deg(truth);
  return truth;
}

// The highest stand of a day, minute by minute.
SunPosition highest(const std::string& day, double longitude_deg, double latitude_deg) {
  SunPosition best;
  best.elevation_deg = -90;
  Moment moment = parse_moment(day + "T00:00");
  for (int minute = 0; minute < 24 * 60; ++minute) {
    moment.hour = minute / 60;
    moment.minute = minute % 60;
    const SunPosition position = sun_position(moment, longitude_deg, latitude_deg);
    if (position.elevation_deg > best.elevation_deg) best = position;
  }
  return best;
}

TEST(Sun, StandsWhereThePublishedExampleSays) {
  // Reda and Andreas, Solar Position Algorithm, NREL/TP-560-34302 (2008), appendix A.5: Golden, Colorado; topocentric
  // elevation without refraction 39.872046, azimuth 194.340241 degrees.
  const SunPosition sun = at("2003-10-17T12:30:30-07:00", -105.1786, 39.742476);
  EXPECT_NEAR(sun.azimuth_deg, 194.340241, 0.005);
  EXPECT_NEAR(without_refraction(sun.elevation_deg), 39.872046, 0.004);  // the report also takes off the parallax
}

TEST(Sun, NoonIsAsHighAsGeometrySays) {
  constexpr double tilt = 23.436;
  for (const double latitude : {0.0, 30.0, 47.0, 60.0}) {
    for (const double side : {1.0, -1.0}) {
      const SunPosition june = highest("2026-06-21", 10, side * latitude);
      const SunPosition december = highest("2026-12-21", 10, side * latitude);
      const double summer = 90 - std::abs(latitude - tilt), winter = 90 - latitude - tilt;
      EXPECT_NEAR(without_refraction(june.elevation_deg), side > 0 ? summer : winter, 0.02) << latitude * side;
      EXPECT_NEAR(without_refraction(december.elevation_deg), side > 0 ? winter : summer, 0.02) << latitude * side;
    }
  }
  // South of the tropics noon is in the north, north of them in the south.
  EXPECT_NEAR(highest("2026-06-21", 10, 47).azimuth_deg, 180, 1);
  const double south = highest("2026-06-21", 150, -33.9).azimuth_deg;
  EXPECT_NEAR(std::remainder(south, 360), 0, 1);
}

TEST(Sun, RisesInTheEastAtTheEquinox) {
  // 2026-03-20 14:46 UTC is the equinox; the sun rises due east and sets due west everywhere, within its day's drift.
  for (const double latitude : {-50.0, 0.0, 47.0}) {
    double rise = -1, set = -1;
    Moment moment = parse_moment("2026-03-20T00:00");
    double before = sun_position(moment, 8, latitude).elevation_deg;
    for (int minute = 1; minute < 24 * 60; ++minute) {
      moment.hour = minute / 60;
      moment.minute = minute % 60;
      const SunPosition now = sun_position(moment, 8, latitude);
      if (before < 0 && now.elevation_deg >= 0) rise = now.azimuth_deg;
      if (before >= 0 && now.elevation_deg < 0) set = now.azimuth_deg;
      before = now.elevation_deg;
    }
    EXPECT_NEAR(rise, 90, 1.2) << latitude;
    EXPECT_NEAR(set, 270, 1.2) << latitude;
  }
}

TEST(Sun, ThePolesHaveHalfAYearOfDay) {
  for (const char* hour : {"T00:00Z", "T06:00Z", "T12:00Z", "T18:00Z"}) {
    EXPECT_NEAR(at("2026-06-21" + std::string(hour), 0, 90).elevation_deg, 23.44 + refraction_deg(23.44), 0.02);
    EXPECT_NEAR(at("2026-06-21" + std::string(hour), 0, -90).elevation_deg, -23.44 + refraction_deg(-23.44), 0.02);
  }
  EXPECT_GT(at("2026-06-21T23:30", 25.8, 71.2).elevation_deg, 0);  // midnight sun at the North Cape
  EXPECT_LT(at("2026-12-21T12:00", 25.8, 71.2).elevation_deg, 0);
}

TEST(Sun, TimeZonesMeetAtTheSameInstant) {
  const SunPosition utc = at("2026-06-21T10:00Z", 8, 47);
  EXPECT_EQ(utc, at("2026-06-21T12:00+02:00", 8, 47));
  EXPECT_EQ(utc, at("2026-06-21T11:00", 8, 47));  // zone time: 8 degrees are half a zone and a bit
  EXPECT_EQ(utc, at("2026-06-21T04:30:00-05:30", 8, 47));
  // Over midnight, into another year.
  EXPECT_EQ(at("2026-12-31T23:30-02:00", 8, 47), at("2027-01-01T01:30Z", 8, 47));
  EXPECT_EQ(offset_of(parse_moment("2026-06-21T10:00"), 7), 0);
  EXPECT_EQ(offset_of(parse_moment("2026-06-21T10:00"), 8), 60);
  EXPECT_EQ(offset_of(parse_moment("2026-06-21T10:00"), -121.7), -480);
  EXPECT_EQ(offset_of(parse_moment("2026-06-21T10:00"), 180), 720);
  EXPECT_EQ(offset_of(parse_moment("2026-06-21T10:00+05:45"), -121.7), 345);
}

TEST(Sun, ReadsMomentsAndTellsWhatIsWrongWithOthers) {
  const Moment m = parse_moment("2024-02-29T07:08:09-03:30");
  EXPECT_EQ(m, (Moment{2024, 2, 29, 7, 8, 9, -210}));
  EXPECT_FALSE(parse_moment("2026-06-21T10:00").offset_min);
  EXPECT_EQ(parse_moment("2026-06-21T10:00Z").offset_min, 0);
  for (const char* text : {"", "2026", "2026-06-21", "2026-06-21 10:00", "26-06-21T10:00", "2026-6-21T10:00",
                           "2026-06-21T10", "2026-06-21T10:00z", "2026-06-21T10:00Zx", "2026-06-21T10:00+2",
                           "2026-06-21T10:00+02", "2026-06-21T10:00:5", "+026-06-21T10:00", "2026-06-21T10:00 "}) {
    EXPECT_THAT([&] { parse_moment(text); }, ThrowsMessage<Error>(HasSubstr("2026-06-21T10:00"))) << text;
  }
  const auto refused = [](const std::string& text, const std::string& why) {
    EXPECT_THAT([&] { parse_moment(text); }, ThrowsMessage<Error>(AllOf(HasSubstr(text), HasSubstr(why))));
  };
  refused("2026-13-21T10:00", "the month is 13");
  refused("2026-00-21T10:00", "the month is 0");
  refused("2026-02-29T10:00", "that month has 28");
  refused("1900-02-29T10:00", "that month has 28");
  refused("2026-06-31T10:00", "that month has 30");
  refused("2026-06-21T24:00", "the hour is 24");
  refused("2026-06-21T10:60", "the minute is 60");
  refused("2026-06-21T10:00:60", "the second is 60");
  refused("0001-06-21T10:00", "the year is 1");
  refused("2026-06-21T10:00+15:00", "more than 14 hours");
  refused("2026-06-21T10:00+02:75", "offset's minutes");
  EXPECT_THAT([] { parse_moment(std::string(100000, '9')); }, ThrowsMessage<Error>(testing::SizeIs(testing::Lt(300u))));
}

TEST(Sun, RefusesPlacesBesideTheEarth) {
  const Moment moment = parse_moment("2026-06-21T10:00");
  EXPECT_THROW(sun_position(moment, 181, 0), Error);
  EXPECT_THROW(sun_position(moment, 0, 91), Error);
  EXPECT_THROW(sun_position(moment, std::nan(""), 0), Error);
  Moment wrong = moment;
  wrong.month = 0;
  EXPECT_THROW(sun_position(wrong, 0, 0), Error);
}

TEST(Sun, RefractionIsTheAlmanacs) {
  EXPECT_NEAR(refraction_deg(-0.575) * 60, 34.5, 1);  // 34 minutes of arc at the seen horizon
  EXPECT_NEAR(refraction_deg(10) * 60, 5.3, 0.2);
  EXPECT_NEAR(refraction_deg(45) * 60, 0.97, 0.02);
  EXPECT_EQ(refraction_deg(90), 0);
  // It never turns the order of elevations round, and fades far below.
  double before = -91;
  for (double h = -90; h <= 90; h += 0.01) {
    const double seen = h + refraction_deg(h);
    EXPECT_GT(seen, before - 0.02) << h;
    before = seen;
  }
  EXPECT_LT(refraction_deg(-10), 0.05);
}

TEST(Sun, DirectionTurnsWithTheGrid) {
  const auto near = [](const V3& a, const V3& b) { return (a - b).length() < 1e-6f; };
  EXPECT_TRUE(near(sun_direction({90, 0}), V3(1, 0, 0)));
  EXPECT_TRUE(near(sun_direction({180, 0}), V3(0, -1, 0)));
  EXPECT_TRUE(near(sun_direction({0, 90}), V3(0, 0, 1)));
  // Where the grid's north points 2 degrees east of true north, the true south-east is turned 2 degrees back.
  EXPECT_TRUE(near(sun_direction({135, 30}, 2), sun_direction({133, 30})));
  EXPECT_NEAR(sun_direction({221, 33}, -1.5).length(), 1, 1e-6);
}

TEST(Sun, ManyThreadsGetTheSame) {
  const SunPosition truth = at("2026-06-21T10:00Z", 8, 47);
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 100; ++i) {
        at("2025-01-0" + std::to_string(1 + i % 9) + "T03:00Z", static_cast<double>(i), -40);
        wrong[t] += at("2026-06-21T10:00Z", 8, 47) == truth ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace silvavis::shade
