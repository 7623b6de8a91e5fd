#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "files.h"
#include "made_land.h"
#include "silvasim/base/parallel.h"
#include "silvasim/export/formats.h"
#include "silvasim/fields/crs.h"

namespace silvasim::exports {
namespace {

using testing::content;
using testing::Folder;
using testing::MadeLand;
using testing::make_land;

// RFC 4180, read the plain way.
std::vector<std::vector<std::string>> parsed(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      row.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      row.emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back(row);
      row.assign(1, "");
    } else {
      row.back() += c;
    }
  }
  return rows;
}

std::string csv_of(const ecosystem::Ecosystem& land) {
  const Folder folder;
  export_to(land, "csv", folder / "f.csv");
  return content(folder / "f.csv");
}

TEST(Csv, holds_every_plant_and_what_the_ecosystem_says_of_it) {
  MadeLand made;
  made.crs_wkt = testing::utm_10_north();
  made.columns = 20;  // several portions
  made.rows = 31;
  ecosystem::Ecosystem land = make_land(made);
  add_shrubs(land, made);
  land.layers[1].probabilities.clear();
  const auto rows = parsed(csv_of(land));
  ASSERT_EQ(rows[0], (std::vector<std::string>{"id", "layer", "species", "common_name", "x_m", "y_m", "z_m",
                                               "longitude", "latitude", "height_m", "crown_radius_m", "scale",
                                               "probability", "tile_column", "tile_row", "site"}));
  const fields::Transformation way(fields::crs_from_text(land.crs_wkt), fields::wgs84());
  std::size_t at = 1;
  for (const ecosystem::Layer& layer : land.layers) {
    const auto offsets = ecosystem::site_offsets(layer.tile_set, layer.tiling);
    ecosystem::for_each_plant(layer, offsets, 0, layer.tiling.rows, [&](const ecosystem::Plant& plant) {
      ASSERT_LT(at, rows.size());
      const auto& row = rows[at++];
      ASSERT_EQ(row.size(), 16u);
      const ecosystem::Species& species = layer.species[plant.species];
      const auto position = static_cast<std::size_t>(plant.row * layer.tiling.columns + plant.column);
      EXPECT_EQ(row[0], std::to_string(offsets[position] + plant.site));
      EXPECT_EQ(row[1], layer.name);
      EXPECT_EQ(row[2], species.name);
      EXPECT_EQ(row[3], species.common_name);
      EXPECT_NEAR(std::stod(row[4]), plant.at.x, 6e-4);
      EXPECT_NEAR(std::stod(row[5]), plant.at.y, 6e-4);
      EXPECT_NEAR(std::stod(row[6]), ecosystem::height_at(land.terrain, plant.at), 6e-3);
      if (at % 97 == 0) {
        const auto geographic = way.apply(plant.at);
        EXPECT_NEAR(std::stod(row[7]), geographic->x, 1e-8);
        EXPECT_NEAR(std::stod(row[8]), geographic->y, 1e-8);
      }
      const double scale = static_cast<double>(plant.radius_m) / static_cast<double>(species.model_radius_m);
      EXPECT_NEAR(std::stod(row[9]), static_cast<double>(species.height_m) * scale, 6e-4);
      EXPECT_NEAR(std::stod(row[10]), static_cast<double>(plant.radius_m), 6e-4);
      EXPECT_NEAR(std::stod(row[11]), scale, 6e-5);
      if (layer.probabilities.empty()) {
        EXPECT_EQ(row[12], "");
      } else {
        EXPECT_NEAR(std::stod(row[12]), static_cast<double>(plant.probability), 6e-6);
      }
      EXPECT_EQ(row[13], std::to_string(plant.column));
      EXPECT_EQ(row[14], std::to_string(plant.row));
      EXPECT_EQ(row[15], std::to_string(plant.site));
    });
  }
  EXPECT_EQ(at, rows.size());
  EXPECT_GT(rows.size(), 50000u);
}

TEST(Csv, leaves_out_columns_that_nobody_knows) {
  MadeLand made;
  made.probabilities = false;
  const std::string text = csv_of(make_land(made));
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "id,layer,species,common_name,x_m,y_m,z_m,height_m,crown_radius_m,scale,tile_column,tile_row,site");
  ecosystem::Ecosystem bare = make_land(made);
  std::fill(bare.layers[0].plants.begin(), bare.layers[0].plants.end(), ecosystem::no_plant);
  EXPECT_EQ(parsed(csv_of(bare)).size(), 1u);
}

TEST(Csv, ids_stay_when_other_plants_go) {
  ecosystem::Ecosystem land = make_land({});
  const auto before = parsed(csv_of(land));
  std::set<std::string> places;
  const auto place = [](const std::vector<std::string>& row) { return row[0] + " " + row[4] + " " + row[5]; };
  for (std::size_t i = 1; i < before.size(); ++i) EXPECT_TRUE(places.insert(place(before[i])).second);
  for (std::size_t i = 0; i < land.layers[0].plants.size(); i += 2) land.layers[0].plants[i] = ecosystem::no_plant;
  const auto after = parsed(csv_of(land));
  EXPECT_LT(after.size(), before.size());
  for (std::size_t i = 1; i < after.size(); ++i) EXPECT_TRUE(places.contains(place(after[i])));
}

TEST(Csv, quotes_what_would_break_a_row) {
  ecosystem::Ecosystem land = make_land({});
  land.layers[0].name = "trees, \"old\"";
  for (ecosystem::Species& species : land.layers[0].species) {
    species.name += ", L.";
    species.common_name = "two\nlines";
  }
  const auto rows = parsed(csv_of(land));
  for (const auto& row : rows) ASSERT_EQ(row.size(), 14u);
  EXPECT_EQ(rows[1][1], "trees, \"old\"");
  EXPECT_THAT(rows[1][2], ::testing::EndsWith(", L."));
  EXPECT_EQ(rows[1][3], "two\nlines");
}

TEST(Csv, has_the_same_bytes_with_any_number_of_threads) {
  MadeLand made;
  made.columns = 30;
  made.rows = 30;
  const ecosystem::Ecosystem land = make_land(made);
  std::string first;
  for (const int threads : {1, 2, 3, 8}) {
    const base::ThreadLimit limit(threads);
    const std::string text = csv_of(land);
    if (first.empty()) first = text;
    EXPECT_TRUE(text == first) << threads;
  }
}

}  // namespace
}  // namespace silvasim::exports
