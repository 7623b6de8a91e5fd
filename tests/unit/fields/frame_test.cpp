// Which frame a scene gets, and how true it is.
#include "silvasim/fields/frame.h"

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>

#include "silvasim/fields/feature_writer.h"
#include "support.h"

namespace silvasim::fields {
namespace {

using testing::Test;

std::vector<float> numbers(int count) {
  std::vector<float> result;
  for (int i = 0; i < count; ++i) result.push_back(static_cast<float>(i));
  return result;
}

// A raster of 10 x 10 cells in any CRS.
std::filesystem::path tile(const TemporaryFolder& folder, const std::string& name, const std::string& crs, double west,
                           double north, double cell) {
  const std::vector<float> values = numbers(100);
  Grid grid;
  grid.columns = grid.rows = 10;
  grid.west = west;
  grid.north = north;
  grid.cell_width = grid.cell_height = cell;
  if (!crs.empty()) grid.crs_wkt = wkt_of(crs_from_text(crs));
  const Band band{std::span<const float>(values), ""};
  const auto path = folder / name;
  write_geotiff(path, grid, {&band, 1});
  return path;
}

TEST(Frame, TerrainInMetresKeepsItsCrsAndBox) {
  const TemporaryFolder folder;
  const FieldSet set =
      load_fields({}, {raster_field(tile(folder, "dem.tif", "EPSG:32633", 500000, 5200000, 25), true)});
  EXPECT_EQ(set.frame.crs_name, "WGS 84 / UTM zone 33N (EPSG:32633)");
  EXPECT_EQ(set.frame.extent, (base::Box{500000, 5199750, 500250, 5200000}));
  EXPECT_EQ(set.terrain, 0);
}

TEST(Frame, DegreesFeetAndPolesGetMetres) {
  const TemporaryFolder folder;
  struct Case {
    const char* crs;
    double west, north, cell;
    const char* expected;
  };
  const Case cases[] = {
      {"EPSG:4326", 11.4, 47.3, 0.001, "EPSG:32632"},     // Innsbruck
      {"EPSG:4326", 5.3, 60.4, 0.001, "EPSG:32632"},      // Bergen: zone 31V is narrower
      {"EPSG:4326", 15.6, 78.2, 0.001, "EPSG:32633"},     // Svalbard: zones 32, 34, 36 are missing
      {"EPSG:4326", -78.3, -9.6, 0.001, "EPSG:32717"},    // Peru: south
      {"EPSG:4326", 10.0, 88.0, 0.001, "EPSG:32661"},     // beyond 84 N: UPS
      {"EPSG:4326", 179.995, 10.0, 0.001, "EPSG:32601"},  // its middle is the date line's western neighbour
      {"EPSG:2264", 2000000, 700000, 100, "EPSG:32617"},  // North Carolina in feet
      {"EPSG:4269", -121.7, 46.8, 0.001, "EPSG:32610"},   // NAD83
  };
  for (const Case& c : cases) {
    const auto path = tile(folder, "dem.tif", c.crs, c.west, c.north, c.cell);
    const FieldSet set = load_fields({}, {raster_field(path, true)});
    EXPECT_NE(set.frame.crs_name.find(c.expected), std::string::npos) << c.crs << ": " << set.frame.crs_name;
    // Every cell of the file must be found again where geodesy says it lies.
    const Transformation to_scene(crs_from_text(c.crs), crs_of(set.frame));
    const auto centre = to_scene.apply(base::Point{c.west + 4.5 * c.cell, c.north - 4.5 * c.cell});
    ASSERT_TRUE(centre);
    EXPECT_NEAR(sample_at(set.fields[0], centre->x, centre->y).value, 44, 0.3) << c.crs;
    EXPECT_TRUE(set.frame.extent.contains(*centre));
  }
}

TEST(Frame, ExtentInDegrees) {
  config::SceneSettings scene = scene_of("");
  scene.extent_geographic = base::Box{-121.9, 46.7, -121.6, 46.9};
  const FieldSet set = load_fields(scene, {});
  EXPECT_NE(set.frame.crs_name.find("EPSG:32610"), std::string::npos);
  // Each corner and each edge's middle must lie in the box, and the box must not be larger than them.
  double west = 1e300, east = -1e300;
  for (const double lon : {-121.9, -121.75, -121.6}) {
    for (const double lat : {46.7, 46.8, 46.9}) {
      int zone = 0;
      bool north = false;
      double x = 0, y = 0;
      GeographicLib::UTMUPS::Forward(lat, lon, zone, north, x, y);
      west = std::min(west, x);
      east = std::max(east, x);
      EXPECT_TRUE(grown(set.frame.extent, 1e-3).contains({x, y}));
    }
  }
  EXPECT_NEAR(set.frame.extent.west, west, 1);
  EXPECT_NEAR(set.frame.extent.east, east, 1);
}

TEST(Frame, SizeAboutTheTerrainOrFromZero) {
  const TemporaryFolder folder;
  config::SceneSettings scene = scene_of("");
  scene.width_m = 100;
  scene.height_m = 50;
  const auto dem = raster_field(tile(folder, "dem.tif", "EPSG:32633", 500000, 5200000, 25), true);
  EXPECT_EQ(load_fields(scene, {dem}).frame.extent, (base::Box{500075, 5199850, 500175, 5199900}));
  EXPECT_EQ(load_fields(scene, {}).frame.extent, (base::Box{0, 0, 100, 50}));
  EXPECT_EQ(load_fields(scene, {}).frame.crs_wkt, "");
  EXPECT_EQ(load_fields(scene, {}).frame.crs_name, "local metres");
}

TEST(Frame, LocalScenes) {
  const TemporaryFolder folder;
  const auto plain = raster_field(tile(folder, "plain.tif", "", 100, 600, 50), true);
  EXPECT_EQ(load_fields({}, {plain}).frame.extent, (base::Box{100, 100, 600, 600}));

  auto placed = raster_field(tile(folder, "placed.tif", "EPSG:32633", 100, 600, 50));
  EXPECT_NE(config_error(scene_of("local", base::Box{100, 100, 600, 600}), {placed})
                .find("scene.xml:7:3: error: data field \"placed\""),
            std::string::npos);
  placed.crs = "local";
  const FieldSet set = load_fields(scene_of("local", base::Box{100, 100, 600, 600}), {placed});
  EXPECT_EQ(sample_at(set.fields[0], 125, 575).value, 0);
  EXPECT_FALSE(report_frame(set.frame).centre);
  EXPECT_FALSE(geographic_from_scene(set.frame, {1, 2}));
}

TEST(Frame, Mistakes) {
  const TemporaryFolder folder;
  const auto plain = raster_field(tile(folder, "plain.tif", "", 100, 600, 50));
  const base::Box box{0, 0, 1000, 1000};
  EXPECT_NE(config_error(scene_of("EPSG:4326", box), {}).find("not in metres"), std::string::npos);
  EXPECT_NE(config_error(scene_of("EPSG:2264", box), {}).find("not in metres"), std::string::npos);
  EXPECT_NE(
      config_error(scene_of("nonsense", box), {}).find("scene.xml:2:3: error: scene: \"nonsense\" is no known CRS"),
      std::string::npos);
  EXPECT_NE(config_error(scene_of("EPSG:32633", box), {plain}).find("does not say its CRS"), std::string::npos);
  EXPECT_NE(config_error(scene_of(""), {}).find("how large the scene is"), std::string::npos);
  EXPECT_NE(config_error(scene_of("EPSG:32633"), {}).find("where the scene lies"), std::string::npos);
  EXPECT_NE(config_error(scene_of("local", base::Box{5, 5, 1, 1}), {}).find("empty or reversed"), std::string::npos);
  EXPECT_NE(config_error(scene_of("local", base::Box{0, 0, 1e8, 1}), {}).find("larger than"), std::string::npos);
  EXPECT_NE(config_error(scene_of("local", base::Box{0, 0, NAN, 1}), {}).find("scene.xml:2:3"), std::string::npos);
  config::SceneSettings half = scene_of("local");
  half.width_m = 100;
  EXPECT_NE(config_error(half, {}).find("both a width and a height"), std::string::npos);
}

TEST(Frame, NoOverlapNamesBothExtents) {
  NEED_SHARED("rainier/dem_ned_30m.tif");
  const std::string message = config_error({}, {raster_field(shared("lolo_montana/landfire_lcp_30m.tif"), true),
                                                raster_field(shared("rainier/dem_ned_30m.tif"))});
  EXPECT_NE(message.find("does not overlap the scene"), std::string::npos) << message;
  EXPECT_NE(message.find("longitude -121.92564 to"), std::string::npos) << message;
  EXPECT_NE(message.find("west 708282.99"), std::string::npos) << message;
}

// Convergence and scale a second way: GeographicLib's own transverse Mercator, where the report goes through PROJ and geodesics.
TEST(Frame, ReportAgreesWithTransverseMercator) {
  Frame frame = frame_of(crs_from_text("EPSG:32611"), {125349, 5188921, 151869, 5213641});
  const FrameReport report = report_frame(frame);
  ASSERT_TRUE(report.centre);
  double lat = 0, lon = 0, gamma = 0, k = 0;
  GeographicLib::UTMUPS::Reverse(11, true, 138609, 5201281, lat, lon, gamma, k);
  EXPECT_NEAR(report.centre->latitude_deg, lat, 1e-8);
  EXPECT_NEAR(report.centre->longitude_deg, lon, 1e-8);
  EXPECT_NEAR(report.convergence_deg, gamma, 1e-3);
  EXPECT_NEAR(report.convergence_deg, -3.46, 0.01);  // the README's "about 3.5 degrees"
  EXPECT_LT(report.least_scale, k);
  EXPECT_GT(report.most_scale, k);
  double corner_k = 0;
  GeographicLib::UTMUPS::Reverse(11, true, 125349, 5188921, lat, lon, gamma, corner_k);
  EXPECT_NEAR(report.most_scale, corner_k, 2e-6);
  EXPECT_EQ(report.mgrs, "10TES9591");
  // Half the diagonal is 18.1 km; the drop of a sphere is d^2 / 2R.
  EXPECT_NEAR(report.curvature_drop_m, 18127.0 * 18127 / 2 / 6.378e6, 0.3);
}

TEST(Frame, PointsThereAndBack) {
  const Frame frame = frame_of(crs_from_text("EPSG:32717"), {794000, 8931000, 798000, 8935000});
  for (const base::Point p : {base::Point{794000, 8931000}, {796123.4, 8933210.9}, {798000, 8935000}}) {
    const auto degrees = geographic_from_scene(frame, p);
    ASSERT_TRUE(degrees);
    const auto back = scene_from_geographic(frame, *degrees);
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->x, p.x, 1e-6);
    EXPECT_NEAR(back->y, p.y, 1e-6);
  }
}

}  // namespace
}  // namespace silvasim::fields
