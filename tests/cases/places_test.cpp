// Real places: they grow, and what grows agrees with what was measured there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "silvasim/ecosystem/file.h"
#include "tests/cases/program.h"

namespace silvasim::cases {
namespace {

std::string shared(const std::string& path) { return std::string(SILVA_SHARED_DIR) + "/data/" + path; }

std::map<std::string, double> mean_elevations(const ecosystem::Ecosystem& e) {
  std::map<std::string, std::pair<double, double>> sums;
  for (const auto& layer : e.layers) {
    ecosystem::for_each_plant(layer, ecosystem::site_offsets(layer.tile_set, layer.tiling), 0, layer.tiling.rows,
                              [&](const ecosystem::Plant& plant) {
                                auto& [sum, count] = sums[layer.species[plant.species].name];
                                sum += ecosystem::height_at(e.terrain, plant.at);
                                count += 1;
                              });
  }
  std::map<std::string, double> means;
  for (const auto& [name, sum] : sums) means[name] = sum.first / sum.second;
  return means;
}

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<double> ranks;
  for (const double v : values) {
    const auto below = std::count_if(values.begin(), values.end(), [&](double o) { return o < v; });
    const auto equal = std::count(values.begin(), values.end(), v);
    ranks.push_back(static_cast<double>(below) + (static_cast<double>(equal) - 1) / 2);
  }
  return ranks;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ma += a[i] / n;
    mb += b[i] / n;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

// Mean elevation of each species in the mapped stands, weighed by stems a hectare.
std::map<std::string, double> stands_by_code() {
  std::ifstream file(shared("rainier/stand_composition.csv"));
  std::string line;
  std::getline(file, line);
  std::map<std::string, std::pair<double, double>> sums;
  while (std::getline(file, line)) {
    std::erase(line, '"');
    std::istringstream fields(line);
    std::string stand, elevation, species, stems;
    std::getline(fields, stand, ',');
    std::getline(fields, elevation, ',');
    std::getline(fields, species, ',');
    std::getline(fields, stems, ',');
    sums[species].first += std::stod(elevation) * std::stod(stems);
    sums[species].second += std::stod(stems);
  }
  std::map<std::string, double> means;
  for (const auto& [code, sum] : sums) means[code] = sum.first / sum.second;
  return means;
}

TEST(Places, RainiersSpeciesStandInTheOrderOfTheStands) {
  if (!std::filesystem::exists(shared("rainier"))) GTEST_SKIP() << "SKIPPED: there is no " << shared("rainier");
  const Folder folder;
  const Outcome outcome =
      silvasim({"run", source("tests/places/rainier/ecosystem.xml"), "-o", folder / "r.silva", "--json", "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto grown = mean_elevations(ecosystem::read(folder / "r.silva"));
  const auto measured = stands_by_code();
  const std::map<std::string, std::string> codes = {
      {"TSHE", "Tsuga heterophylla"}, {"PSME", "Pseudotsuga menziesii"}, {"THPL", "Thuja plicata"},
      {"ABAM", "Abies amabilis"},     {"TSME", "Tsuga mertensiana"},     {"CANO", "Callitropsis nootkatensis"},
      {"ABLA", "Abies lasiocarpa"},   {"ABPR", "Abies procera"},         {"ABGR", "Abies grandis"},
      {"PIEN", "Picea engelmannii"},  {"PISI", "Picea sitchensis"},      {"ALRU", "Alnus rubra"},
      {"PIMO", "Pinus monticola"},    {"PICO", "Pinus contorta"},        {"TABR", "Taxus brevifolia"}};
  std::vector<double> simulated, real;
  for (const auto& [code, elevation] : measured) {
    const auto name = codes.find(code);
    if (name == codes.end() || !grown.contains(name->second)) continue;
    simulated.push_back(grown.at(name->second));
    real.push_back(elevation);
    std::cout << code << " " << name->second << ": stands " << elevation << " m, grown " << grown.at(name->second)
              << " m\n";
  }
  ASSERT_GE(simulated.size(), 6u);
  const double rho = correlation(ranks(simulated), ranks(real));
  std::cout << "rank correlation of mean elevation over " << real.size() << " species: " << rho << "\n";
  EXPECT_GT(rho, 0.7);
}

TEST(Places, NorthCarolinaGrowsFromThreeCoordinateSystems) {
  if (!std::filesystem::exists(shared("nc_wake"))) GTEST_SKIP() << "SKIPPED: there is no " << shared("nc_wake");
  const Folder folder;
  const Outcome outcome =
      silvasim({"run", source("tests/places/nc_wake/ecosystem.xml"), "-o", folder / "n.silva", "--json", "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(outcome.json()["plants"].get<long>(), 10000);
}

}  // namespace
}  // namespace silvasim::cases
