// The sun on its way from one moment to another.
#pragma once

#include <string>

#include "silvavis/commands/stage.h"

namespace silvavis::commands {

// That many minutes later (or earlier), at the same offset from Greenwich.
shade::Moment later(const shade::Moment& moment, double minutes, double longitude_deg);

class SunWay {
 public:
  // `sun_to` empty: the sun stays. Errors: base::ConfigError where --sun-direction says where it stands.
  SunWay(const StageOptions& options, const std::string& sun_to, const Stage& stage);

  shade::SunPosition at(double share) const;  // 0 to 1, evenly in time

 private:
  shade::SunPosition still_;
  bool moves_ = false;
  double from_s_ = 0, to_s_ = 0;  // since 1970, UTC
  double longitude_deg_ = 0, latitude_deg_ = 0;
};

}  // namespace silvavis::commands
