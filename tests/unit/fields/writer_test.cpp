// Points and bands out, read back by GDAL.
#include <gdal_priv.h>
#include <ogrsf_frmts.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <memory>
#include <random>

#include "silvasim/base/file.h"
#include "silvasim/base/hash.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/feature_writer.h"
#include "silvasim/fields/frame.h"
#include "support.h"

namespace silvasim::fields {
namespace {

struct Points {
  std::vector<double> x, y, height;
  std::vector<std::int32_t> id, species;
};

Points some_points(int count) {
  Points p;
  for (int i = 0; i < count; ++i) {
    p.x.push_back(590000 + 7.25 * i);
    p.y.push_back(5185000 + 3.5 * i);
    p.id.push_back(i * 3);
    p.species.push_back(i % 4 == 3 ? -1 : i % 4);
    p.height.push_back(i % 5 == 4 ? std::numeric_limits<double>::quiet_NaN() : i * 0.1);
  }
  return p;
}

PointLayer layer_in(const std::string& crs) {
  PointLayer layer;
  layer.name = "trees";
  if (!crs.empty()) layer.crs_wkt = wkt_of(crs_from_text(crs));
  layer.columns = {{"plant", ColumnType::integer, {}, -1},
                   {"species", ColumnType::text, {"Picea abies", "Quercus, \"robur\"", "Érable"}, -1},
                   {"height_m", ColumnType::number, {}, 2}};
  return layer;
}

// In blocks of 100.
void write(const std::filesystem::path& path, PointFormat format, const PointLayer& layer, const Points& p) {
  std::size_t next = 0;
  write_points(path, format, layer, [&]() -> std::optional<PointBlock> {
    if (next >= p.x.size()) return std::nullopt;
    const std::size_t n = std::min<std::size_t>(100, p.x.size() - next), from = next;
    next += n;
    PointBlock block{std::span(p.x).subspan(from, n), std::span(p.y).subspan(from, n), {}};
    block.columns = {std::span<const std::int32_t>(p.id).subspan(from, n),
                     std::span<const std::int32_t>(p.species).subspan(from, n),
                     std::span<const double>(p.height).subspan(from, n)};
    return block;
  });
}

std::string text_of(const std::filesystem::path& path) { return base::read_file(path, 1 << 28); }

TEST(Writer, GeoPackageReadsBack) {
  const TemporaryFolder folder;
  const Points p = some_points(1234);
  PointLayer layer = layer_in("EPSG:32610");
  layer.style_qml = "<qgis><renderer-v2 type=\"categorizedSymbol\"/></qgis>";
  base::NewFile file(folder / "trees.gpkg");
  write(file.path(), PointFormat::geopackage, layer, p);
  file.commit();

  const std::unique_ptr<GDALDataset> data(GDALDataset::Open((folder / "trees.gpkg").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(data);
  OGRLayer* const trees = data->GetLayerByName("trees");
  ASSERT_TRUE(trees);
  EXPECT_EQ(trees->GetFeatureCount(), 1234);
  EXPECT_STREQ(trees->GetSpatialRef()->GetAuthorityCode(nullptr), "32610");
  EXPECT_TRUE(trees->TestCapability(OLCFastSpatialFilter)) << "the spatial index";
  std::size_t i = 0;
  while (const std::unique_ptr<OGRFeature> feature{trees->GetNextFeature()}) {
    const OGRPoint* const point = feature->GetGeometryRef()->toPoint();
    ASSERT_EQ(point->getX(), p.x[i]);
    ASSERT_EQ(point->getY(), p.y[i]);
    ASSERT_EQ(feature->GetFieldAsInteger("plant"), p.id[i]);
    if (p.species[i] < 0)
      ASSERT_TRUE(feature->IsFieldNull(feature->GetFieldIndex("species")));
    else
      ASSERT_EQ(feature->GetFieldAsString("species"), layer.columns[1].words[static_cast<std::size_t>(p.species[i])]);
    if (std::isnan(p.height[i]))
      ASSERT_TRUE(feature->IsFieldNull(feature->GetFieldIndex("height_m")));
    else
      ASSERT_EQ(feature->GetFieldAsDouble("height_m"), p.height[i]);
    ++i;
  }
  OGRLayer* const styles = data->GetLayerByName("layer_styles");
  ASSERT_TRUE(styles);
  const std::unique_ptr<OGRFeature> style(styles->GetNextFeature());
  EXPECT_EQ(style->GetFieldAsString("styleQML"), layer.style_qml);
  EXPECT_STREQ(style->GetFieldAsString("f_table_name"), "trees");
  EXPECT_EQ(style->GetFieldAsInteger("useAsDefault"), 1);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files, (void)entry;
  EXPECT_EQ(files, 1);
}

// The spatial index: SQLite's own check of its nodes, and windows against looking at every point.
TEST(Writer, TheSpatialIndexIsWhole) {
  std::mt19937 random(606);
  for (const int count : {0, 1, 51, 52, 2000, 51 * 51 + 1, 30000}) {
    const TemporaryFolder folder;
    Points p = some_points(count);
    std::uniform_real_distribution<double> x(585000, 605000), y(5180000, 5200000);
    for (std::size_t i = 0; i < p.x.size(); ++i) {
      p.x[i] = random() % 100 == 0 ? NAN : random() % 50 == 0 ? 590000 : x(random);
      p.y[i] = y(random);
    }
    write(folder / "trees.gpkg", PointFormat::geopackage, layer_in("EPSG:32610"), p);

    sqlite3* connection = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "trees.gpkg").c_str(), &connection), SQLITE_OK);
    for (const auto& [question, answer] :
         {std::pair<const char*, const char*>{"SELECT rtreecheck('rtree_trees_geom')", "ok"},
          {"PRAGMA integrity_check", "ok"}}) {
      sqlite3_stmt* statement = nullptr;
      ASSERT_EQ(sqlite3_prepare_v2(connection, question, -1, &statement, nullptr), SQLITE_OK);
      ASSERT_EQ(sqlite3_step(statement), SQLITE_ROW);
      EXPECT_STREQ(reinterpret_cast<const char*>(sqlite3_column_text(statement, 0)), answer) << count << " points";
      sqlite3_finalize(statement);
    }
    sqlite3_close(connection);

    // Also after somebody adds a point, which goes through SQLite's own insertion into our nodes.
    {
      const std::unique_ptr<GDALDataset> data(
          GDALDataset::Open((folder / "trees.gpkg").c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
      OGRLayer* const trees = data->GetLayer(0);
      OGRFeature feature(trees->GetLayerDefn());
      OGRPoint point(600001, 5190001);
      feature.SetGeometry(&point);
      ASSERT_EQ(trees->CreateFeature(&feature), OGRERR_NONE);
      p.x.push_back(600001);
      p.y.push_back(5190001);
    }
    const std::unique_ptr<GDALDataset> data(GDALDataset::Open((folder / "trees.gpkg").c_str(), GDAL_OF_VECTOR));
    OGRLayer* const trees = data->GetLayer(0);
    EXPECT_EQ(trees->GetFeatureCount(), static_cast<GIntBig>(p.x.size()));
    for (int i = 0; i < 20; ++i) {
      const double west = x(random), south = y(random), side = i % 4 == 0 ? 20 : 3000;
      trees->SetSpatialFilterRect(west, south, west + side, south + side);
      // The index holds floats, so a point within a metre of the window's rim may count.
      GIntBig inside = 0, about = 0;
      for (std::size_t k = 0; k < p.x.size(); ++k) {
        const base::Box window{west, south, west + side, south + side};
        inside += window.contains({p.x[k], p.y[k]});
        about += grown(window, 1).contains({p.x[k], p.y[k]});
      }
      ASSERT_GE(trees->GetFeatureCount(), inside) << "seed 606, " << count << " points";
      ASSERT_LE(trees->GetFeatureCount(), about) << "seed 606, " << count << " points";
    }
  }
}

TEST(Writer, SameValuesSameBytes) {
  const TemporaryFolder folder;
  const Points p = some_points(500);
  PointLayer layer = layer_in("EPSG:32610");
  layer.style_qml = "<qgis/>";
  for (const auto format : {PointFormat::geopackage, PointFormat::geojson, PointFormat::csv}) {
    const std::string suffix = format == PointFormat::geopackage ? ".gpkg"
                               : format == PointFormat::geojson  ? ".geojson"
                                                                 : ".csv";
    write(folder / ("a" + suffix), format, layer, p);
    write(folder / ("b" + suffix), format, layer, p);
    EXPECT_EQ(base::sha256_of_file(folder / ("a" + suffix)), base::sha256_of_file(folder / ("b" + suffix))) << suffix;
  }
}

TEST(Writer, GeoJsonIsInDegrees) {
  const TemporaryFolder folder;
  const Points p = some_points(250);
  write(folder / "trees.geojson", PointFormat::geojson, layer_in("EPSG:32610"), p);
  const std::unique_ptr<GDALDataset> data(GDALDataset::Open((folder / "trees.geojson").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(data);
  OGRLayer* const trees = data->GetLayer(0);
  EXPECT_EQ(trees->GetFeatureCount(), 250);
  const Frame frame = frame_of(crs_from_text("EPSG:32610"), {0, 0, 1, 1});
  for (std::size_t i = 0; i < 250; ++i) {
    const std::unique_ptr<OGRFeature> feature(trees->GetNextFeature());
    const auto back = scene_from_geographic(
        frame, {feature->GetGeometryRef()->toPoint()->getY(), feature->GetGeometryRef()->toPoint()->getX()});
    ASSERT_NEAR(back->x, p.x[i], 0.002);
    ASSERT_NEAR(back->y, p.y[i], 0.002);
    if (p.species[i] == 1) {
      ASSERT_STREQ(feature->GetFieldAsString("species"), "Quercus, \"robur\"");
    }
  }
  write(folder / "local.geojson", PointFormat::geojson, layer_in(""), p);
  EXPECT_NE(text_of(folder / "local.geojson").find("\"coordinates\":[590007.250,5185003.500]"), std::string::npos);
}

TEST(Writer, CsvAsPromised) {
  const TemporaryFolder folder;
  write(folder / "trees.csv", PointFormat::csv, layer_in("EPSG:32610"), some_points(5));
  EXPECT_EQ(text_of(folder / "trees.csv"),
            "x,y,plant,species,height_m\n"
            "590000.000,5185000.000,0,Picea abies,0.00\n"
            "590007.250,5185003.500,3,\"Quercus, \"\"robur\"\"\",0.10\n"
            "590014.500,5185007.000,6,Érable,0.20\n"
            "590021.750,5185010.500,9,,0.30\n"
            "590029.000,5185014.000,12,Picea abies,\n");
  write(folder / "none.csv", PointFormat::csv, layer_in(""), {});
  EXPECT_EQ(text_of(folder / "none.csv"), "x,y,plant,species,height_m\n");
}

TEST(Writer, GeoTiffReadsBack) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (int i = 0; i < 300 * 200; ++i)
    values.push_back(i % 17 == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(std::sqrt(i)));
  Band band;
  band.columns = 300;
  band.rows = 200;
  band.west = 585000;
  band.north = 5200000;
  band.cell_width = 10;
  band.cell_height = 20;
  band.values = std::span<const float>(values);
  band.no_data = std::numeric_limits<double>::quiet_NaN();
  band.crs_wkt = wkt_of(crs_from_text("EPSG:32610"));
  band.description = "probability";
  write_geotiff(folder / "p.tif", band);
  const FieldSet set = load_fields({}, {raster_field(folder / "p.tif", true)});
  EXPECT_EQ(set.frame.extent, (base::Box{585000, 5196000, 588000, 5200000}));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float read = set.fields[0].raster.values[i];
    ASSERT_TRUE(read == values[i] || (std::isnan(read) && std::isnan(values[i])));
  }
  const std::vector<std::uint8_t> bytes(300 * 200, 7);
  band.values = std::span<const std::uint8_t>(bytes);
  band.no_data = 255;
  write_geotiff(folder / "b.tif", band);
  EXPECT_EQ(load_fields({}, {raster_field(folder / "b.tif", true)}).fields[0].raster.at(5, 5), 7);
}

// A full disk, played by a limit on the size of files.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before_;
    small.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(Writer, AFullDiskIsAnError) {
  const TemporaryFolder folder;
  const Points p = some_points(20000);
  std::vector<float> noise;
  for (unsigned i = 0, state = 1; i < 400 * 400; ++i)
    noise.push_back(static_cast<float>(state = state * 1664525u + 1013904223u));
  Band band;
  band.columns = band.rows = 400;
  band.values = std::span<const float>(noise);
  for (const rlim_t limit : {rlim_t{0}, rlim_t{1000}, rlim_t{100000}, rlim_t{300000}}) {
    const SmallFiles small(limit);
    EXPECT_THROW(write(folder / "a.gpkg", PointFormat::geopackage, layer_in("EPSG:32610"), p), base::Error) << limit;
    EXPECT_THROW(write(folder / "a.csv", PointFormat::csv, layer_in(""), p), base::Error) << limit;
    EXPECT_THROW(write(folder / "a.geojson", PointFormat::geojson, layer_in(""), p), base::Error) << limit;
    EXPECT_THROW(write_geotiff(folder / "a.tif", band), base::Error) << limit;
  }
}

TEST(Writer, UnwritablePlacesAreErrors) {
  for (const char* const path : {"/nowhere/a.gpkg", "/nowhere/a.csv", "/nowhere/a.geojson"}) {
    const std::string name = path;
    const auto format = name.ends_with("gpkg")  ? PointFormat::geopackage
                        : name.ends_with("csv") ? PointFormat::csv
                                                : PointFormat::geojson;
    EXPECT_THROW(write(path, format, layer_in(""), some_points(3)), base::Error);
  }
  const TemporaryFolder folder;
  EXPECT_THROW(write_points(
                   folder / "a.csv", PointFormat::csv, layer_in(""), [] { return std::optional<PointBlock>(); }, 0,
                   [](std::string_view, double) { return false; }),
               base::Cancelled);
}

}  // namespace
}  // namespace silvasim::fields
