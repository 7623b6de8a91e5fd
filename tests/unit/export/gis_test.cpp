#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <sqlite3.h>

#include <map>
#include <nlohmann/json.hpp>

#include "files.h"
#include "made_land.h"
#include "silvasim/base/parallel.h"
#include "silvasim/export/formats.h"
#include "silvasim/export/qgis_style.h"
#include "silvasim/fields/crs.h"

namespace silvasim::exports {
namespace {

using testing::content;
using testing::Folder;
using ::testing::HasSubstr;
using testing::MadeLand;
using testing::make_land;

// Rows of a query, as text, read by SQLite alone.
std::vector<std::vector<std::string>> query(const std::filesystem::path& path, const std::string& sql) {
  std::vector<std::vector<std::string>> rows;
  sqlite3* database = nullptr;
  sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr);
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  while (sqlite3_step(statement) == SQLITE_ROW) {
    std::vector<std::string> row;
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, i));
      row.emplace_back(text ? text : "NULL");
    }
    rows.push_back(row);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return rows;
}

struct Sums {
  std::uint64_t plants = 0;
  double height = 0;
};

std::map<std::string, Sums> sums_of(const ecosystem::Ecosystem& land) {
  std::map<std::string, Sums> sums;
  for (const ecosystem::Layer& layer : land.layers) {
    ecosystem::for_each_plant(layer, ecosystem::site_offsets(layer.tile_set, layer.tiling), 0, layer.tiling.rows,
                              [&](const ecosystem::Plant& plant) {
                                const ecosystem::Species& species = layer.species[plant.species];
                                Sums& sum = sums[species.name];
                                ++sum.plants;
                                sum.height += static_cast<double>(species.height_m) *
                                              static_cast<double>(plant.radius_m) /
                                              static_cast<double>(species.model_radius_m);
                              });
  }
  return sums;
}

MadeLand utm_land() {
  MadeLand made;
  made.crs_wkt = testing::utm_10_north();
  return made;
}

TEST(GeoPackage, holds_every_plant_in_the_scenes_crs) {
  const Folder folder;
  const MadeLand made = utm_land();
  ecosystem::Ecosystem land = make_land(made);
  add_shrubs(land, made);
  export_to(land, "", folder / "f.gpkg");
  std::uint64_t plants = 0;
  const auto rows = query(folder / "f.gpkg", "SELECT species, count(*), sum(height_m) FROM plants GROUP BY species");
  const auto wanted = sums_of(land);
  EXPECT_EQ(rows.size(), wanted.size());
  for (const auto& row : rows) {
    ASSERT_TRUE(wanted.contains(row[0])) << row[0];
    EXPECT_EQ(row[1], std::to_string(wanted.at(row[0]).plants));
    EXPECT_NEAR(std::stod(row[2]), wanted.at(row[0]).height, 1e-6 * wanted.at(row[0]).height);
    plants += wanted.at(row[0]).plants;
  }
  EXPECT_EQ(query(folder / "f.gpkg",
                  "SELECT organization_coordsys_id FROM gpkg_spatial_ref_sys JOIN gpkg_contents USING "
                  "(srs_id) WHERE table_name = 'plants'"),
            (std::vector<std::vector<std::string>>{{"32610"}}));
  EXPECT_EQ(query(folder / "f.gpkg", "SELECT count(DISTINCT id || layer) FROM plants"),
            (std::vector<std::vector<std::string>>{{std::to_string(plants)}}));
}

TEST(GeoPackage, brings_a_style_in_the_species_colours) {
  const Folder folder;
  const ecosystem::Ecosystem land = make_land(utm_land());
  export_to(land, "", folder / "f.gpkg");
  const auto rows = query(folder / "f.gpkg", "SELECT f_table_name, styleQML, useAsDefault FROM layer_styles");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0][0], "plants");
  EXPECT_EQ(rows[0][1], qgis_style(land));
  EXPECT_EQ(rows[0][2], "1");
}

TEST(QgisStyle, is_xml_with_a_category_and_a_symbol_a_species) {
  MadeLand made = utm_land();
  ecosystem::Ecosystem land = make_land(made);
  land.layers[0].species[1].name = "a \"b\" <c> & 'd'";
  land.layers.push_back(land.layers[0]);  // the same species again
  const std::string style = qgis_style(land);
  xmlDoc* document = xmlReadMemory(style.data(), static_cast<int>(style.size()), "f.qml", nullptr, XML_PARSE_NONET);
  ASSERT_NE(document, nullptr);
  xmlFreeDoc(document);
  const auto count = [&](const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = style.find(word); at != std::string::npos; at = style.find(word, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("<category "), 3u);
  EXPECT_EQ(count("<symbol "), 3u);
  EXPECT_THAT(style, HasSubstr("value=\"31,95,58,255\""));  // 0x1F5F3A
  EXPECT_THAT(style, HasSubstr("attr=\"species\""));
}

TEST(GeoJson, holds_every_plant_in_longitude_and_latitude) {
  const Folder folder;
  const ecosystem::Ecosystem land = make_land(utm_land());
  export_to(land, "geojson", folder / "f.json");
  const auto json = nlohmann::json::parse(content(folder / "f.json"));
  std::map<std::string, Sums> sums;
  const fields::Transformation way(fields::crs_from_text(land.crs_wkt), fields::wgs84());
  std::vector<base::Point> places;
  ecosystem::for_each_plant(land.layers[0], ecosystem::site_offsets(land.layers[0].tile_set, land.layers[0].tiling), 0,
                            land.layers[0].tiling.rows,
                            [&](const ecosystem::Plant& plant) { places.push_back(*way.apply(plant.at)); });
  ASSERT_EQ(json["features"].size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& feature = json["features"][i];
    EXPECT_NEAR(feature["geometry"]["coordinates"][0].get<double>(), places[i].x, 2e-8);
    EXPECT_NEAR(feature["geometry"]["coordinates"][1].get<double>(), places[i].y, 2e-8);
    Sums& sum = sums[feature["properties"]["species"].get<std::string>()];
    ++sum.plants;
    sum.height += feature["properties"]["height_m"].get<double>();
  }
  const auto wanted = sums_of(land);
  EXPECT_EQ(sums.size(), wanted.size());
  for (const auto& [name, sum] : sums) {
    EXPECT_EQ(sum.plants, wanted.at(name).plants);
    EXPECT_NEAR(sum.height, wanted.at(name).height, 6e-4 * static_cast<double>(sum.plants));
  }
}

// Commas stand between plants, wherever the first one is.
TEST(GeoJson, is_whole_with_plants_in_a_late_portion_only_and_with_none) {
  const Folder folder;
  MadeLand made = utm_land();
  made.columns = 40;
  made.rows = 40;
  ecosystem::Ecosystem land = make_land(made);
  std::vector<ecosystem::PlantId>& plants = land.layers[0].plants;
  ASSERT_GT(plants.size(), 100'000u) << "several portions are wanted";
  std::fill(plants.begin(), plants.end() - 3, ecosystem::no_plant);
  std::fill(plants.end() - 3, plants.end(), ecosystem::PlantId{0});
  export_to(land, "", folder / "late.geojson");
  EXPECT_EQ(nlohmann::json::parse(content(folder / "late.geojson"))["features"].size(), 3u);
  std::fill(plants.begin(), plants.end(), ecosystem::no_plant);
  export_to(land, "", folder / "none.geojson");
  EXPECT_EQ(nlohmann::json::parse(content(folder / "none.geojson"))["features"].size(), 0u);
}

TEST(Gis, files_have_the_same_bytes_with_any_number_of_threads) {
  const Folder folder;
  MadeLand made = utm_land();
  made.columns = 30;
  made.rows = 30;
  const ecosystem::Ecosystem land = make_land(made);
  for (const char* const name : {"f.gpkg", "f.fgb", "f.geojson"}) {
    std::string first;
    for (const int threads : {1, 3}) {
      const base::ThreadLimit limit(threads);
      export_to(land, "", folder / name);
      if (first.empty()) first = content(folder / name);
      EXPECT_TRUE(content(folder / name) == first) << name << " " << threads;
    }
  }
}

TEST(Gis, land_without_a_place_is_exported_in_metres) {
  const Folder folder;
  const ecosystem::Ecosystem land = make_land({});
  for (const char* const name : {"f.gpkg", "f.fgb", "f.geojson"})
    EXPECT_NO_THROW(export_to(land, "", folder / name)) << name;
  const auto json = nlohmann::json::parse(content(folder / "f.geojson"));
  EXPECT_GT(json["features"][0]["geometry"]["coordinates"][0].get<double>(), 500000);
}

}  // namespace
}  // namespace silvasim::exports
