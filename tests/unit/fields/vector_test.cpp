// Vector files on the scene's frame.
#include <cmath>
#include <random>

#include "support.h"

namespace silvasim::fields {
namespace {

using config::VectorMeasure;

std::string feature(const std::string& geometry, const std::string& properties = "") {
  return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":)" + geometry + "}";
}

std::string collection(const std::vector<std::string>& features) {
  std::string text = R"({"type":"FeatureCollection","features":[)";
  for (std::size_t i = 0; i < features.size(); ++i) text += (i ? "," : "") + features[i];
  return text + "]}";
}

std::string square(double west, double south, double east, double north) {
  const auto p = [](double x, double y) { return "[" + std::to_string(x) + "," + std::to_string(y) + "]"; };
  return R"({"type":"Polygon","coordinates":[[)" + p(west, south) + "," + p(east, south) + "," + p(east, north) + "," +
         p(west, north) + "," + p(west, south) + "]]}";
}

// A GeoJSON whose coordinates are the scene's metres.
config::FieldSettings local_field(const TemporaryFolder& folder, const std::vector<std::string>& features,
                                  VectorMeasure measure, double resolution = 1) {
  write_text(folder / "layer.geojson", collection(features));
  auto field = vector_field(folder / "layer.geojson", measure);
  field.crs = "local";
  field.resolution_m = resolution;
  return field;
}

const config::SceneSettings hundred = scene_of("local", base::Box{0, 0, 100, 100});

float at(const Field& field, double x, double y) {
  const Sampled s = sample_at(field, x, y);
  EXPECT_FALSE(s.no_data) << x << " " << y;
  return s.value;
}

TEST(Vector, InsideAndAttribute) {
  const TemporaryFolder folder;
  const std::vector<std::string> two = {feature(square(10, 10, 30, 30), R"("code":3,"name":"a","share":0.25)"),
                                        feature(square(20, 20, 60, 60), R"("code":7,"name":"b","share":0.5)")};
  const FieldSet inside = load_fields(hundred, {local_field(folder, two, VectorMeasure::inside)});
  EXPECT_EQ(at(inside.fields[0], 15.5, 15.5), 1);
  EXPECT_EQ(at(inside.fields[0], 5.5, 15.5), 0);
  EXPECT_EQ(at(inside.fields[0], 0, 0), 0) << "the rim is read whole";
  double area = 0;
  for (const float value : inside.fields[0].raster.values) area += value;
  EXPECT_EQ(area, 400 + 1600 - 100);

  auto code = local_field(folder, two, VectorMeasure::attribute);
  code.attribute = "code";
  code.kind = config::FieldKind::class_code;
  const FieldSet attribute = load_fields(hundred, {code});
  EXPECT_EQ(at(attribute.fields[0], 15.5, 15.5), 3);
  EXPECT_EQ(at(attribute.fields[0], 25.5, 25.5), 7) << "later features lie on top";
  EXPECT_TRUE(sample_at(attribute.fields[0], 80, 80).no_data);

  code.where = "code < 5";
  EXPECT_EQ(at(load_fields(hundred, {code}).fields[0], 25.5, 25.5), 3);
}

// A stroke of 10 m with round ends: its area is known. Polygons stay as they are.
TEST(Vector, LinesMayBeWide) {
  const TemporaryFolder folder;
  const std::string line = R"({"type":"LineString","coordinates":[[20,50],[80,50]]})";
  auto field = local_field(folder, {feature(line), feature(square(10, 10, 30, 30))}, VectorMeasure::inside, 0.25);
  field.line_width_m = 10;
  const FieldSet set = load_fields(hundred, {field});
  double area = 0;
  for (const float value : set.fields[0].raster.values) area += static_cast<double>(value) * 0.25 * 0.25;
  EXPECT_NEAR(area, 600 + 3.14159 * 25 + 400, 5);
  EXPECT_EQ(at(set.fields[0], 50, 54.5), 1);
  EXPECT_EQ(at(set.fields[0], 50, 55.5), 0);
}

TEST(Vector, Mistakes) {
  const TemporaryFolder folder;
  const std::vector<std::string> one = {feature(square(10, 10, 30, 30), R"("code":3,"name":"a")")};
  auto field = local_field(folder, one, VectorMeasure::attribute);
  field.attribute = "cod";
  EXPECT_NE(config_error(hundred, {field}).find("there is no attribute \"cod\""), std::string::npos);
  EXPECT_NE(config_error(hundred, {field}).find("did you mean \"code\"?"), std::string::npos);
  field.attribute = "name";
  EXPECT_NE(config_error(hundred, {field}).find("attribute \"name\" is no number"), std::string::npos);
  field.attribute = "code";
  field.where = "nonsense >";
  EXPECT_NE(config_error(hundred, {field}).find("where=\"nonsense >\" cannot be understood"), std::string::npos);
  field.where = "code = 4";
  EXPECT_NE(config_error(hundred, {field}).find("that fulfils where=\"code = 4\""), std::string::npos);
  field.where = "";
  field.layer = "other";
  EXPECT_NE(config_error(hundred, {field}).find("there is no layer \"other\""), std::string::npos);
  field.layer = "";
  field.crs = "";
  EXPECT_NE(config_error(hundred, {field}).find("but the scene is in local metres"), std::string::npos);
  field.crs = "local";
  field.resolution_m = 0.001;
  EXPECT_NE(config_error(hundred, {field}).find("are possible"), std::string::npos);
  field.resolution_m = 0;
  const std::string apart = config_error(scene_of("local", base::Box{500, 500, 600, 600}), {field});
  EXPECT_NE(
      apart.find(
          "does not overlap the scene: it reaches from west 10, south 10, east 30, north 30; the scene from west 500"),
      std::string::npos)
      << apart;
}

// What docs/fields.md promises: about a cell, or about 1 % where that is more.
double allowed_error(double distance_m, double cell) { return std::max(1.5 * cell, 0.015 * distance_m); }

// A wrong filter is the user's mistake, whichever format finds it and whenever it does.
TEST(Vector, AWrongFilterIsAnErrorAtItsPlaceInEveryFormat) {
  const std::filesystem::path data = std::string(SILVA_SOURCE_DIR) + "/data";
  auto package = vector_field(data / "landuse.gpkg", VectorMeasure::inside);
  package.layer = "roads";
  auto json = vector_field(data / "waters.geojson", VectorMeasure::inside);
  const config::SceneSettings scene = scene_of("EPSG:25832", base::Box{570000, 5725200, 572000, 5726700});
  const auto message = [&](config::FieldSettings& field, const std::string& where) {
    field.where = where;
    return config_error(scene, {field});
  };
  EXPECT_EQ(message(package, "clas = 'road'"),
            "scene.xml:7:3: error: data field \"landuse\": where=\"clas = 'road'\" cannot be understood: there is no "
            "column \"clas\"; columns are fid, class; did you mean \"class\"?");
  EXPECT_EQ(message(json, "knd = 'river'"),
            "scene.xml:7:3: error: data field \"waters\": where=\"knd = 'river'\" cannot be understood: there is no "
            "column \"knd\"; columns are kind; did you mean \"kind\"?");
  EXPECT_NE(message(package, "class =").find("cannot be understood: incomplete input; columns are"), std::string::npos);
  EXPECT_NE(message(package, "shout(class)").find("no such function: shout"), std::string::npos);
  EXPECT_EQ(message(package, "class = 'road'"), "");
}

// Distance against plain geometry, inside the scene and to features outside it.
TEST(Vector, DistanceIsRightToAboutACell) {
  std::mt19937 random(2024);
  std::uniform_real_distribution<double> anywhere(-150, 250), within(0, 100);
  for (int round = 0; round < 12; ++round) {
    const TemporaryFolder folder;
    std::vector<base::Point> points;
    std::vector<std::string> features;
    const int count = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < count; ++i) {
      points.push_back({anywhere(random), anywhere(random)});
      features.push_back(feature(R"({"type":"Point","coordinates":[)" + std::to_string(points.back().x) + "," +
                                 std::to_string(points.back().y) + "]}"));
    }
    const double cell = 1;
    const FieldSet set = load_fields(hundred, {local_field(folder, features, VectorMeasure::distance, cell)});
    for (int i = 0; i < 200; ++i) {
      const base::Point p{within(random), within(random)};
      double truth = 1e300;
      for (const base::Point& q : points) truth = std::min(truth, std::hypot(p.x - q.x, p.y - q.y));
      ASSERT_NEAR(at(set.fields[0], p.x, p.y), truth, allowed_error(truth, cell)) << "seed 2024, round " << round;
    }
  }
}

TEST(Vector, DistanceToALineAndFromInsideAPolygon) {
  const TemporaryFolder folder;
  const FieldSet line =
      load_fields(hundred, {local_field(folder, {feature(R"({"type":"LineString","coordinates":[[-50,20],[150,70]]})")},
                                        VectorMeasure::distance)});
  for (double x = 0; x <= 100; x += 7) {
    for (double y = 0; y <= 100; y += 7) {
      const double truth = std::abs((y - 20) * 200 - (x + 50) * 50) / std::hypot(200, 50);
      EXPECT_NEAR(at(line.fields[0], x, y), truth, 1.5);
    }
  }
  const FieldSet area = load_fields(
      hundred, {local_field(folder, {feature(square(20.2, 20.2, 20.4, 20.4)), feature(square(60, 60, 90, 90))},
                            VectorMeasure::distance)});
  EXPECT_EQ(at(area.fields[0], 75, 75), 0);
  EXPECT_LT(at(area.fields[0], 20.3, 20.3), 1.5) << "a polygon smaller than a cell is not lost";
}

// The nearest feature may lie far outside, or at the other end of the scene, with nothing in between.
TEST(Vector, DistanceToFarFeatures) {
  const TemporaryFolder folder;
  const auto point = [](double x, double y) {
    return feature(R"({"type":"Point","coordinates":[)" + std::to_string(x) + "," + std::to_string(y) + "]}",
                   R"("kind":1)");
  };
  for (const double far : {600.0, 950.0, 3000.0, 9000.0}) {
    const FieldSet set = load_fields(hundred, {local_field(folder, {point(-far, 50)}, VectorMeasure::distance)});
    for (const double x : {1.0, 50.0, 99.0}) EXPECT_NEAR(at(set.fields[0], x, 50), far + x, allowed_error(far + x, 1));
  }
  EXPECT_NE(config_error(hundred, {local_field(folder, {point(-30000, 50)}, VectorMeasure::distance)})
                .find("does not overlap"),
            std::string::npos);

  config::SceneSettings wide;
  wide.extent = base::Box{0, 0, 10000, 10000};
  wide.crs = "local";
  const FieldSet across = load_fields(wide, {local_field(folder, {point(10, 5000)}, VectorMeasure::distance, 5)});
  for (const double x : {100.0, 3000.0, 6000.0, 9900.0}) {
    EXPECT_NEAR(at(across.fields[0], x, 5000), x - 10, allowed_error(x, 5));
  }
}

// Glaciers in degrees on a frame in metres: area and distances against ogr2ogr -t_srs EPSG:26911, gdal_rasterize -tr 30 30 (103036 cells)
// and gdal_proximity (corner cells 9792.002, 9443.093, 8804.731, 8880.405 m), GDAL 3.6.2.
TEST(Vector, GlaciersOfRainier) {
  NEED_SHARED("rainier/glaciers_rgi60.shp");
  auto inside = vector_field(shared("rainier/glaciers_rgi60.shp"), VectorMeasure::inside), far = inside;
  far.measure = VectorMeasure::distance;
  inside.resolution_m = far.resolution_m = 30;
  const FieldSet set = load_fields({}, {raster_field(shared("rainier/dem_ned_30m.tif"), true), inside, far});
  double cells = 0;
  for (const float value : set.fields[1].raster.values) cells += value;
  EXPECT_NEAR(cells, 103036, 30);
  const base::Box& box = set.frame.extent;
  EXPECT_NEAR(at(set.fields[2], box.west + 15, box.north - 15), 9792.002, allowed_error(9792.002, 30));
  EXPECT_NEAR(at(set.fields[2], box.east - 15, box.north - 15), 9443.093, allowed_error(9443.093, 30));
  EXPECT_NEAR(at(set.fields[2], box.west + 15, box.south + 15), 8804.731, allowed_error(8804.731, 30));
  EXPECT_NEAR(at(set.fields[2], box.east - 15, box.south + 15), 8880.405, allowed_error(8880.405, 30));
}

TEST(Vector, WaterOfWakeLiesWhereTheLandUseSaysWater) {
  NEED_SHARED("nc_wake/water_polygons_from_landuse.gpkg");
  auto landuse = raster_field(shared("nc_wake/landuse_r.tif"));
  landuse.kind = config::FieldKind::class_code;
  auto water = vector_field(shared("nc_wake/water_polygons_from_landuse.gpkg"), VectorMeasure::inside);
  water.resolution_m = 10;
  const FieldSet set = load_fields({}, {raster_field(shared("nc_wake/elev_ned_30m.tif"), true), landuse, water});
  long both = 0, polygons = 0;
  for (double x = set.frame.extent.west + 5; x < set.frame.extent.east; x += 10) {
    for (double y = set.frame.extent.south + 5; y < set.frame.extent.north; y += 10) {
      if (sample_at(set.fields[2], x, y).value < 0.5) continue;
      ++polygons;
      both += sample_at(set.fields[1], x, y).value == 6;
    }
  }
  EXPECT_GT(polygons, 5000);
  EXPECT_GT(double(both) / double(polygons), 0.99);
}

// A feature as large as the world, in degrees, must still cover a scene in metres.
TEST(Vector, TheWorldCoversTheScene) {
  const TemporaryFolder folder;
  write_text(folder / "world.geojson",
             collection({feature(
                 R"({"type":"Polygon","coordinates":[[[-180,-90],[180,-90],[180,90],[-180,90],[-180,-90]]]})")}));
  auto field = vector_field(folder / "world.geojson", VectorMeasure::inside);
  const FieldSet set = load_fields(scene_of("EPSG:32610", base::Box{590000, 5180000, 591000, 5181000}), {field});
  for (const float value : set.fields[0].raster.values) ASSERT_EQ(value, 1);
}

// A parallel is straight in degrees, bent in metres: a square of two corners only must follow it.
TEST(Vector, LongEdgesFollowTheirOwnCrs) {
  const TemporaryFolder folder;
  write_text(folder / "north.geojson", collection({feature(square(0, 60, 30, 70))}));
  const FieldSet set = load_fields(scene_of("EPSG:32633", base::Box{300000, 6640000, 700000, 6680000}),
                                   {vector_field(folder / "north.geojson", VectorMeasure::inside)});
  int wrong = 0;
  for (double x = 300500; x < 700000; x += 5000) {
    for (double y = 6640500; y < 6680000; y += 500) {
      const double latitude = geographic_from_scene(set.frame, {x, y})->latitude_deg;
      if (std::abs(latitude - 60) < 0.003) continue;  // a cell and a half
      wrong += (sample_at(set.fields[0], x, y).value > 0.5) != (latitude > 60);
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Vector, CurvesBowtiesAndHoles) {
  const TemporaryFolder folder;
  // Even-odd: both wings of a bow-tie, and a hole outside its shell counts as land.
  const FieldSet tie = load_fields(
      hundred,
      {local_field(folder, {feature(R"({"type":"Polygon","coordinates":[[[0,0],[100,100],[100,0],[0,100],[0,0]]]})")},
                   VectorMeasure::inside)});
  EXPECT_EQ(at(tie.fields[0], 5, 50), 1);
  EXPECT_EQ(at(tie.fields[0], 95, 50), 1);
  EXPECT_EQ(at(tie.fields[0], 50, 95), 0);
  const FieldSet holed = load_fields(
      hundred,
      {local_field(
          folder,
          {feature(
              R"({"type":"Polygon","coordinates":[[[10,10],[90,10],[90,90],[10,90],[10,10]],[[40,40],[60,40],[60,60],[40,60],[40,40]]]})")},
          VectorMeasure::inside)});
  EXPECT_EQ(at(holed.fields[0], 50, 50), 0);
  EXPECT_EQ(at(holed.fields[0], 20, 50), 1);
}

TEST(Vector, HugeCoordinatesAreCutOff) {
  const TemporaryFolder folder;
  for (
      const char* const geometry :
      {R"({"type":"Polygon","coordinates":[[[-1e300,-1e300],[1e300,-1e300],[1e300,1e300],[-1e300,1e300],[-1e300,-1e300]]]})",
       R"({"type":"LineString","coordinates":[[-1e12,50],[1e12,50]]})",
       R"({"type":"LineString","coordinates":[[-1e300,50],[1e300,50]]})"}) {
    try {
      const FieldSet set = load_fields(hundred, {local_field(folder, {feature(geometry)}, VectorMeasure::inside)});
      for (const float value : set.fields[0].raster.values) ASSERT_TRUE(value == 0 || value == 1);
    } catch (const base::Error& error) {
      EXPECT_NE(std::string(error.what()).find("layer"), std::string::npos) << error.what();
    }
  }
}

TEST(Vector, PointsOfACsv) {
  const TemporaryFolder folder;
  write_text(folder / "stems.csv", "tree_id,species,x,y,dbh\n1,oak,10.5,10.5,30\n2,\"beech, red\",80.5,80.5,50\n");
  auto field = vector_field(folder / "stems.csv", VectorMeasure::attribute);
  field.crs = "local";
  field.attribute = "dbh";
  field.resolution_m = 1;
  field.kind = config::FieldKind::class_code;
  const FieldSet set = load_fields(hundred, {field});
  EXPECT_EQ(at(set.fields[0], 10.5, 10.5), 30);
  EXPECT_EQ(at(set.fields[0], 80.5, 80.5), 50);
  field.where = "dbh > 40";
  EXPECT_TRUE(sample_at(load_fields(hundred, {field}).fields[0], 10.5, 10.5).no_data);
}

TEST(Vector, ALoneShapeGetsItsIndexInMemory) {
  NEED_SHARED("malformed/vector/derived/shp_without_shx_dbf_prj.shp");
  const TemporaryFolder folder;
  std::filesystem::copy_file(shared("malformed/vector/derived/shp_without_shx_dbf_prj.shp"), folder / "lakes.shp");
  auto lone = vector_field(folder / "lakes.shp", VectorMeasure::inside),
       whole = vector_field(shared("nc_wake/lakes.shp"), VectorMeasure::inside);
  lone.crs = "EPSG:4326";
  const auto dem = raster_field(shared("nc_wake/elev_ned_30m.tif"), true);
  const FieldSet set = load_fields({}, {dem, lone, whole});
  EXPECT_EQ(set.fields[1].raster.values, set.fields[2].raster.values);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files, (void)entry;
  EXPECT_EQ(files, 1) << "nothing may be written beside the user's file";
}

}  // namespace
}  // namespace silvasim::fields
