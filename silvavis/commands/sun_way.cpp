#include "silvavis/commands/sun_way.h"

#include <chrono>
#include <cmath>

#include "silvasim/base/error.h"

namespace silvavis::commands {

namespace {

namespace chrono = std::chrono;

double seconds_of(const shade::Moment& moment, double longitude_deg) {
  const chrono::year_month_day date{chrono::year(moment.year), chrono::month(static_cast<unsigned>(moment.month)),
                                    chrono::day(static_cast<unsigned>(moment.day))};
  const auto days = static_cast<double>(chrono::sys_days(date).time_since_epoch().count());
  return days * 86400 + moment.hour * 3600 + moment.minute * 60 + moment.second -
         60 * shade::offset_of(moment, longitude_deg);
}

shade::Moment moment_at(double seconds) {
  const double day = std::floor(seconds / 86400);
  const chrono::year_month_day date{chrono::sys_days(chrono::days(static_cast<int>(day)))};
  const double rest = seconds - day * 86400;
  shade::Moment moment;
  moment.year = static_cast<int>(date.year());
  moment.month = static_cast<int>(static_cast<unsigned>(date.month()));
  moment.day = static_cast<int>(static_cast<unsigned>(date.day()));
  moment.hour = static_cast<int>(rest / 3600);
  moment.minute = static_cast<int>((rest - moment.hour * 3600) / 60);
  moment.second = rest - moment.hour * 3600 - moment.minute * 60;
  moment.offset_min = 0;
  return moment;
}

}  // namespace

shade::Moment later(const shade::Moment& moment, double minutes, double longitude_deg) {
  const int offset_min = shade::offset_of(moment, longitude_deg);
  shade::Moment result = moment_at(seconds_of(moment, longitude_deg) + 60 * (minutes + offset_min));
  result.offset_min = offset_min;
  return result;
}

SunWay::SunWay(const StageOptions& options, const std::string& sun_to, const Stage& stage)
    : still_(stage.sun),
      moves_(!sun_to.empty()),
      longitude_deg_(stage.longitude_deg),
      latitude_deg_(stage.latitude_deg) {
  if (!moves_) return;
  if (!options.sun_direction.empty())
    silvasim::terminal::wrong_option("--sun-to goes with --sun, not with --sun-direction");
  from_s_ = seconds_of(moment_of("--sun", options.sun), longitude_deg_);
  to_s_ = seconds_of(moment_of("--sun-to", sun_to), longitude_deg_);
}

shade::SunPosition SunWay::at(double share) const {
  if (!moves_) return still_;
  return shade::sun_position(moment_at(from_s_ + (to_s_ - from_s_) * share), longitude_deg_, latitude_deg_);
}

}  // namespace silvavis::commands
