#include "silvasim/tiles/radii.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "silvasim/base/math.h"

namespace silvasim::tiles {

namespace {

constexpr int intervals = 4096;
constexpr double pi = 3.14159265358979323846;
constexpr double reach = 8;  // in standard deviations beyond which nothing is left

// Density up to a constant factor, and the range that holds all of it.
struct Density {
  bool logarithmic = false;
  double centre = 0, deviation = 1;  // of r, or of log(r)
  double from = 0, to = 0;

  double at(double radius) const {
    const double z = ((logarithmic ? base::log(radius) : radius) - centre) / deviation;
    return base::exp(-0.5 * z * z) / (logarithmic ? radius : 1.0);
  }
};

Density density(const config::TileSettings& settings) {
  const double range = settings.most_radius_m - settings.least_radius_m;
  const double mean =
      settings.mean_radius_m > 0 ? settings.mean_radius_m : 0.5 * (settings.least_radius_m + settings.most_radius_m);
  const double deviation = settings.deviation_radius_m > 0 ? settings.deviation_radius_m : range / 6;
  Density result{false, mean, deviation, mean - reach * deviation, mean + reach * deviation};
  if (settings.distribution == config::RadiusDistribution::lognormal) {
    // Mean and deviation are those of the radius; its logarithm is normal with these.
    const double variance = base::log(1 + (deviation / mean) * (deviation / mean));
    result.logarithmic = true;
    result.centre = base::log(mean) - 0.5 * variance;
    result.deviation = std::sqrt(variance);
    result.from = base::exp(result.centre - reach * result.deviation);
    result.to = base::exp(result.centre + reach * result.deviation);
  }
  result.from = std::max(result.from, settings.least_radius_m);
  result.to = std::min(result.to, settings.most_radius_m);
  return result;
}

}  // namespace

Radii::Radii(const config::TileSettings& settings) : least_(settings.least_radius_m), most_(settings.most_radius_m) {
  if (settings.distribution == config::RadiusDistribution::uniform || most_ - least_ < 1e-4 * most_) {
    mean_ = 0.5 * (least_ + most_);
    mean_square_ = (least_ * least_ + least_ * most_ + most_ * most_) / 3;
    return;
  }
  const Density density_of = density(settings);
  from_ = density_of.from;
  step_ = (density_of.to - density_of.from) / intervals;
  share_.assign(intervals + 1, 0.0);
  double first_moment = 0, second_moment = 0;
  double left = from_, left_density = density_of.at(left);
  for (int i = 0; i < intervals; ++i) {
    const double middle = from_ + (i + 0.5) * step_, right = from_ + (i + 1) * step_;
    const double middle_density = density_of.at(middle), right_density = density_of.at(right);
    const auto simpson = [&](double a, double b, double c) { return (a + 4 * b + c) * (step_ / 6); };
    share_[static_cast<std::size_t>(i) + 1] =
        share_[static_cast<std::size_t>(i)] + simpson(left_density, middle_density, right_density);
    first_moment += simpson(left * left_density, middle * middle_density, right * right_density);
    second_moment +=
        simpson(left * left * left_density, middle * middle * middle_density, right * right * right_density);
    left = right;
    left_density = right_density;
  }
  const double total = share_.back();
  for (double& share : share_) share /= total;
  mean_ = first_moment / total;
  mean_square_ = second_moment / total;
}

float Radii::quantile(double u) const {
  double radius = least_ + u * (most_ - least_);
  if (!share_.empty()) {
    const auto above = std::upper_bound(share_.begin() + 1, share_.end() - 1, u);
    const auto below = above - 1;
    const double inside = *above > *below ? (u - *below) / (*above - *below) : 0.0;
    radius = from_ + (static_cast<double>(below - share_.begin()) + std::clamp(inside, 0.0, 1.0)) * step_;
  }
  // Rounding to float must not leave the range; above all not upwards, where no float lies in it.
  float rounded = static_cast<float>(radius);
  if (static_cast<double>(rounded) < least_) rounded = std::nextafter(rounded, std::numeric_limits<float>::max());
  if (static_cast<double>(rounded) > most_) rounded = std::nextafter(rounded, 0.0f);
  return rounded;
}

double Radii::deviation_m() const { return std::sqrt(std::max(0.0, mean_square_ - mean_ * mean_)); }

double Radii::sites_per_m2(double coverage) const { return coverage / (pi * mean_square_); }

}  // namespace silvasim::tiles
