#include "silvasim/tiles/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "silvasim/tiles/radii.h"

namespace silvasim::tiles {

namespace {

constexpr int least_colours = 3, most_colours = 16;
constexpr double most_sites_in_tile = 1e6;
constexpr double most_sites_in_set = 5e7;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

std::string metres(double value) { return text(value) + " m"; }

void check_colours(const config::TileSettings& settings, std::vector<std::string>& found) {
  if (settings.colours < least_colours || settings.colours > most_colours) {
    found.push_back("colours=\"" + std::to_string(settings.colours) + "\" must be " + std::to_string(least_colours) +
                    " to " + std::to_string(most_colours) + " (3 is the paper's set of 18 tiles)");
  } else if (settings.variants < 2 || settings.variants > settings.colours - 1) {
    // One variant would make every row follow from the first, and the land repeat.
    found.push_back("variants=\"" + std::to_string(settings.variants) + "\" must be 2 to " +
                    std::to_string(settings.colours - 1) + ", less than the number of colours");
  }
}

bool check_radii(const config::TileSettings& settings, std::vector<std::string>& found) {
  const double least = settings.least_radius_m, most = settings.most_radius_m;
  if (!(least > 0) || !std::isfinite(least)) {
    found.push_back("least=\"" + metres(least) + "\" must be a radius larger than 0 m");
    return false;
  }
  if (!(most >= least) || !std::isfinite(most)) {
    found.push_back("most=\"" + metres(most) + "\" must not be smaller than least=\"" + metres(least) + "\"");
    return false;
  }
  const double mean = settings.mean_radius_m, deviation = settings.deviation_radius_m;
  if (settings.distribution == config::RadiusDistribution::uniform) {
    if (mean != 0 || deviation != 0) {
      found.push_back("mean and deviation belong to distribution=\"normal\" or \"lognormal\", not to \"uniform\"");
    }
    return true;
  }
  bool good = true;
  if (mean != 0 && !(mean >= least && mean <= most)) {
    found.push_back("mean=\"" + metres(mean) + "\" must lie between least=\"" + metres(least) + "\" and most=\"" +
                    metres(most) + "\"");
    good = false;
  }
  const double least_deviation = 1e-4 * most;
  if (deviation != 0 && (!(deviation >= least_deviation) || !std::isfinite(deviation))) {
    found.push_back("deviation=\"" + metres(deviation) + "\" must be at least " + metres(least_deviation) +
                    "; for equal radii write least and most alike");
    good = false;
  }
  return good;
}

}  // namespace

double most_coverage(const config::TileSettings& settings) {
  // Random throwing of equal discs jams at 0.547 (Feder 1980) and is slow before; measured, 0.51 is reached, and half
  // of the radii's coefficient of variation more.
  const Radii radii(settings);
  return std::min(0.6, 0.51 + 0.5 * radii.deviation_m() / radii.mean_m());
}

std::vector<base::Diagnostic> faults(const config::TileSettings& settings) {
  std::vector<std::string> found;
  check_colours(settings, found);
  const bool good_radii = check_radii(settings, found);

  const double side = settings.side_m, most = settings.most_radius_m;
  bool good_side = side > 0 && std::isfinite(side);
  if (!good_side) found.push_back("side=\"" + metres(side) + "\" must be a length larger than 0 m");
  if (good_side && good_radii && !(side > 8 * most)) {
    found.push_back("side=\"" + metres(side) + "\" must be larger than 8 times the largest radius (most=\"" +
                    metres(most) + "\"), that is larger than " + metres(8 * most));
    good_side = false;
  }

  bool good_coverage = settings.coverage > 0 && settings.coverage <= 0.6;
  if (!good_coverage) {
    found.push_back("coverage=\"" + text(settings.coverage) + "\" must be larger than 0 and at most 0.6");
  } else if (good_radii) {
    const double reachable = std::floor(1000 * most_coverage(settings)) / 1000;
    if (settings.coverage > std::max(reachable, 0.51)) {
      found.push_back("coverage=\"" + text(settings.coverage) + "\" cannot be reached with radii of " +
                      metres(settings.least_radius_m) + " to " + metres(most) + ", which are too much alike: at most " +
                      text(reachable));
      good_coverage = false;
    }
  }

  if (good_radii && good_side && good_coverage && found.empty()) {
    const double sites = Radii(settings).sites_per_m2(settings.coverage) * side * side;
    const double tiles = static_cast<double>(settings.colours * settings.colours * settings.variants);
    const double allowed = std::min(most_sites_in_tile, most_sites_in_set / tiles);
    if (sites > allowed) {
      found.push_back("a tile of side=\"" + metres(side) + "\" would hold " + text(sites) + " sites, at most " +
                      text(std::floor(allowed)) + " are allowed: choose a side of at most " +
                      metres(std::floor(side * std::sqrt(allowed / sites))));
    }
  }

  std::vector<base::Diagnostic> diagnostics;
  for (std::string& message : found) diagnostics.push_back({settings.place, std::move(message)});
  return diagnostics;
}

}  // namespace silvasim::tiles
