#include "silvavis/shade/sun.h"

#include <fmt/format.h>
#include <libnova/dynamical_time.h>
#include <libnova/earth.h>
#include <libnova/julian_day.h>
#include <libnova/precession.h>
#include <libnova/sidereal_time.h>
#include <libnova/solar.h>

#include <array>
#include <cmath>
#include <mutex>

#include "silvasim/base/error.h"
#include "silvasim/base/words.h"

namespace silvavis::shade {

namespace {

using silvasim::base::Error;

constexpr double radians = 0.017453292519943295;
constexpr int first_year = 1600, last_year = 3000;

// Reads a text from left to right; any of its steps may fail, and then all do.
class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}

  int digits(std::size_t count) {
    int value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const char c = next();
      if (c < '0' || c > '9') good_ = false;
      value = 10 * value + (c - '0');
    }
    return good_ ? value : 0;
  }
  void expect(char wanted) { good_ = next() == wanted && good_; }
  bool take(char wanted) {
    const bool there = at_ < text_.size() && text_[at_] == wanted;
    at_ += there ? 1 : 0;
    return there;
  }
  bool good() const { return good_ && at_ == text_.size(); }

 private:
  char next() {
    if (at_ < text_.size()) return text_[at_++];
    good_ = false;
    return '0';
  }

  const std::string& text_;
  std::size_t at_ = 0;
  bool good_ = true;
};

int days_in(int year, int month) {
  static constexpr std::array<int, 12> days = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return days[static_cast<std::size_t>(month - 1)] + (leap && month == 2 ? 1 : 0);
}

// What is wrong with it, or nothing.
std::string fault_of(const Moment& m) {
  if (m.year < first_year || m.year > last_year) {
    return fmt::format("the year is {}; it can be {} to {}", m.year, first_year, last_year);
  }
  if (m.month < 1 || m.month > 12) return fmt::format("the month is {}; it can be 1 to 12", m.month);
  if (m.day < 1 || m.day > days_in(m.year, m.month)) {
    return fmt::format("the day is {}; that month has {}", m.day, days_in(m.year, m.month));
  }
  if (m.hour < 0 || m.hour > 23) return fmt::format("the hour is {}; it can be 0 to 23", m.hour);
  if (m.minute < 0 || m.minute > 59) return fmt::format("the minute is {}; it can be 0 to 59", m.minute);
  if (!(m.second >= 0 && m.second < 60)) return fmt::format("the second is {}; it can be 0 to 59", m.second);
  constexpr int most_offset_min = 14 * 60;
  if (m.offset_min && (*m.offset_min < -most_offset_min || *m.offset_min > most_offset_min)) {
    return "the offset from UTC is more than 14 hours";
  }
  return {};
}

// Days from noon UTC of 1 January 4713 before Christ.
double julian_day(const Moment& m, int offset_min) {
  ln_date date{};
  date.years = m.year;
  date.months = m.month;
  date.days = m.day;
  const double at_midnight = ln_get_julian_day(&date);
  return at_midnight + ((m.hour * 60 + m.minute - offset_min) * 60 + m.second) / 86400.0;
}

// Right ascension and declination of the mean equinox of date. libnova's own ln_get_solar_equ_coords() leaves out
// precession, which is a third of a degree by now, and aberration. Nutation is left out here and in the sidereal time: the
// two differ by at most 0.003 degrees.
ln_equ_posn mean_place(double universal) {
  // Planets keep dynamical time, which is a minute or so before the clocks.
  const double dynamical = ln_get_jde(universal);
  ln_helio_posn ecliptic{};
  double distance_au = 1;
  {
    // libnova keeps its last answers in static variables.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    ln_get_solar_geom_coords(dynamical, &ecliptic);
    distance_au = ln_get_earth_solar_dist(dynamical);
  }
  constexpr double aberration_deg = 20.4898 / 3600, tilt = 23.4392911 * radians;  // the ecliptic's, in 2000
  const double length = (ecliptic.L - aberration_deg / distance_au) * radians, width = ecliptic.B * radians;
  ln_equ_posn in_2000{}, of_date{};
  in_2000.ra =
      std::atan2(std::sin(length) * std::cos(tilt) - std::tan(width) * std::sin(tilt), std::cos(length)) / radians;
  in_2000.dec =
      std::asin(std::sin(width) * std::cos(tilt) + std::cos(width) * std::sin(tilt) * std::sin(length)) / radians;
  ln_get_equ_prec(&in_2000, dynamical, &of_date);
  return of_date;
}

}  // namespace

Moment parse_moment(const std::string& text) {
  const auto fail = [&](const std::string& why) -> Error {
    return Error("\"" + silvasim::base::shortened(text, 60) + "\" is no date and time: " + why);
  };
  Reader reader(text);
  Moment m;
  m.year = reader.digits(4);
  reader.expect('-');
  m.month = reader.digits(2);
  reader.expect('-');
  m.day = reader.digits(2);
  reader.expect('T');
  m.hour = reader.digits(2);
  reader.expect(':');
  m.minute = reader.digits(2);
  if (reader.take(':')) m.second = reader.digits(2);
  bool offset_good = true;
  if (reader.take('Z')) {
    m.offset_min = 0;
  } else {
    const bool east = reader.take('+');
    if (east || reader.take('-')) {
      const int hours = reader.digits(2);
      reader.expect(':');
      const int minutes = reader.digits(2);
      offset_good = minutes < 60;
      m.offset_min = (east ? 1 : -1) * (60 * hours + minutes);
    }
  }
  if (!reader.good()) throw fail("write it as 2026-06-21T10:00, and Z or +02:00 behind it where it is no zone time");
  if (!offset_good) throw fail("the offset's minutes can be 0 to 59");
  if (const std::string fault = fault_of(m); !fault.empty()) throw fail(fault);
  return m;
}

int offset_of(const Moment& moment, double longitude_deg) {
  return moment.offset_min ? *moment.offset_min : 60 * static_cast<int>(std::lround(longitude_deg / 15));
}

double refraction_deg(double true_elevation_deg) {
  const double h = true_elevation_deg;
  if (h > 85) return 0;
  const double t = std::tan(h * radians);
  // NOAA's approximation in arc seconds, three pieces; the last lets it fade below the horizon.
  double seconds = 0;
  if (h > 5) {
    seconds = 58.1 / t - 0.07 / (t * t * t) + 0.000086 / (t * t * t * t * t);
  } else if (h > -0.575) {
    seconds = 1735 + h * (-518.2 + h * (103.4 + h * (-12.79 + h * 0.711)));
  } else if (h > -89) {
    seconds = -20.774 / t;
  }
  return seconds / 3600;
}

SunPosition sun_position(const Moment& moment, double longitude_deg, double latitude_deg) {
  if (const std::string fault = fault_of(moment); !fault.empty()) throw Error("the sun's date and time: " + fault);
  if (!(std::abs(longitude_deg) <= 180) || !(std::abs(latitude_deg) <= 90)) {
    throw Error(fmt::format("the sun's place: longitude {} and latitude {} degrees are not on the earth", longitude_deg,
                            latitude_deg));
  }
  const double universal = julian_day(moment, offset_of(moment, longitude_deg));
  const ln_equ_posn sun = mean_place(universal);
  // Hour angle, and from it the horizon's coordinates (Meeus, Astronomical Algorithms, equations 13.5 and 13.6).
  const double sidereal_deg = ln_get_mean_sidereal_time(universal) * 15;
  const double hour = (sidereal_deg + longitude_deg - sun.ra) * radians;
  const double declination = sun.dec * radians, latitude = latitude_deg * radians;
  const double up =
      std::sin(latitude) * std::sin(declination) + std::cos(latitude) * std::cos(declination) * std::cos(hour);
  const double north =
      std::sin(declination) * std::cos(latitude) - std::cos(declination) * std::sin(latitude) * std::cos(hour);
  const double east = -std::cos(declination) * std::sin(hour);
  const double elevation = std::atan2(up, std::hypot(north, east)) / radians;

  SunPosition position;
  position.azimuth_deg = std::atan2(east, north) / radians;
  if (position.azimuth_deg < 0) position.azimuth_deg += 360;
  position.elevation_deg = elevation + refraction_deg(elevation);
  return position;
}

V3 sun_direction(const SunPosition& position, double convergence_deg) {
  const double azimuth = (position.azimuth_deg - convergence_deg) * radians;
  const double elevation = position.elevation_deg * radians;
  return V3(V3d(std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation)));
}

}  // namespace silvavis::shade
