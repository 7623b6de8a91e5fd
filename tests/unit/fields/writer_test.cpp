// Points and bands out, read back by GDAL.
#include <gdal_priv.h>
#include <ogrsf_frmts.h>
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
  std::vector<std::int64_t> id, species;
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
  layer.columns = {{"plant", ColumnType::integer},
                   {"species", ColumnType::text, {"Picea abies", "Quercus, \"robur\"", "Érable"}},
                   {"height_m", ColumnType::number}};
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
    block.columns = {std::span<const std::int64_t>(p.id).subspan(from, n),
                     std::span<const std::int64_t>(p.species).subspan(from, n),
                     std::span<const double>(p.height).subspan(from, n)};
    return block;
  });
}

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

// A FlatGeobuf holds the same, in the order of its index.
TEST(Writer, FlatGeobufReadsBack) {
  const TemporaryFolder folder;
  const Points p = some_points(1234);
  const PointLayer layer = layer_in("EPSG:32610");
  write(folder / "trees.fgb", PointFormat::flatgeobuf, layer, p);
  const std::unique_ptr<GDALDataset> data(GDALDataset::Open((folder / "trees.fgb").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(data);
  OGRLayer* const trees = data->GetLayer(0);
  EXPECT_EQ(trees->GetFeatureCount(), 1234);
  EXPECT_STREQ(trees->GetSpatialRef()->GetAuthorityCode(nullptr), "32610");
  EXPECT_TRUE(trees->TestCapability(OLCFastSpatialFilter)) << "the spatial index";
  std::vector<bool> seen(p.id.size());
  while (const std::unique_ptr<OGRFeature> feature{trees->GetNextFeature()}) {
    const auto i = static_cast<std::size_t>(feature->GetFieldAsInteger64("plant") / 3);
    ASSERT_LT(i, seen.size());
    ASSERT_FALSE(seen[i]);
    seen[i] = true;
    ASSERT_EQ(feature->GetGeometryRef()->toPoint()->getX(), p.x[i]);
    ASSERT_EQ(feature->GetGeometryRef()->toPoint()->getY(), p.y[i]);
    ASSERT_EQ(feature->IsFieldSetAndNotNull(feature->GetFieldIndex("species")), p.species[i] >= 0);
    ASSERT_EQ(feature->IsFieldSetAndNotNull(feature->GetFieldIndex("height_m")), !std::isnan(p.height[i]));
  }
  EXPECT_THROW(write(folder / "trees.bin", PointFormat::flatgeobuf, layer, p), base::Error);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files, (void)entry;
  EXPECT_EQ(files, 1);
}

TEST(Writer, SameValuesSameBytes) {
  const TemporaryFolder folder;
  const Points p = some_points(500);
  PointLayer layer = layer_in("EPSG:32610");
  layer.style_qml = "<qgis/>";
  for (const auto& [format, suffix] :
       {std::pair<PointFormat, std::string>{PointFormat::geopackage, ".gpkg"}, {PointFormat::flatgeobuf, ".fgb"}}) {
    write(folder / ("a" + suffix), format, layer, p);
    write(folder / ("b" + suffix), format, layer, p);
    EXPECT_EQ(base::sha256_of_file(folder / ("a" + suffix)), base::sha256_of_file(folder / ("b" + suffix))) << suffix;
  }
}

TEST(Writer, GeoTiffReadsBack) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (int i = 0; i < 300 * 200; ++i)
    values.push_back(i % 17 == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(std::sqrt(i)));
  Grid grid;
  grid.columns = 300;
  grid.rows = 200;
  grid.west = 585000;
  grid.north = 5200000;
  grid.cell_width = 10;
  grid.cell_height = 20;
  grid.no_data = std::numeric_limits<double>::quiet_NaN();
  grid.crs_wkt = wkt_of(crs_from_text("EPSG:32610"));
  Band band{std::span<const float>(values), "probability"};
  write_geotiff(folder / "p.tif", grid, {&band, 1});
  const FieldSet set = load_fields({}, {raster_field(folder / "p.tif", true)});
  EXPECT_EQ(set.frame.extent, (base::Box{585000, 5196000, 588000, 5200000}));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float read = set.fields[0].raster.values[i];
    ASSERT_TRUE(read == values[i] || (std::isnan(read) && std::isnan(values[i])));
  }
  const std::vector<std::uint8_t> bytes(300 * 200, 7);
  band.values = std::span<const std::uint8_t>(bytes);
  grid.no_data = 255;
  write_geotiff(folder / "b.tif", grid, {&band, 1});
  EXPECT_EQ(load_fields({}, {raster_field(folder / "b.tif", true)}).fields[0].raster.at(5, 5), 7);
}

TEST(Writer, GeoTiffBandsReadBack) {
  const TemporaryFolder folder;
  constexpr int count = 5;
  std::vector<std::vector<float>> values(count, std::vector<float>(70 * 30));
  std::vector<Band> bands;
  for (int b = 0; b < count; ++b) {
    for (int i = 0; i < 70 * 30; ++i) values[std::size_t(b)][std::size_t(i)] = static_cast<float>(i % 97 + b) / 101.0f;
    bands.push_back({std::span<const float>(values[std::size_t(b)]), "Érable <" + std::to_string(b) + ">"});
  }
  Grid grid;
  grid.columns = 70;
  grid.rows = 30;
  grid.no_data = -1;
  write_geotiff(folder / "p.tif", grid, bands);
  const std::unique_ptr<GDALDataset> data(GDALDataset::Open((folder / "p.tif").c_str(), GDAL_OF_RASTER));
  ASSERT_TRUE(data);
  ASSERT_EQ(data->GetRasterCount(), count);
  std::vector<float> read(70 * 30);
  for (int b = 0; b < count; ++b) {
    GDALRasterBand& band = *data->GetRasterBand(b + 1);
    EXPECT_EQ(band.GetDescription(), bands[std::size_t(b)].description);
    EXPECT_EQ(band.GetNoDataValue(), -1);
    EXPECT_NE(band.GetColorInterpretation(), GCI_AlphaBand);
    ASSERT_EQ(band.RasterIO(GF_Read, 0, 0, 70, 30, read.data(), 70, 30, GDT_Float32, 0, 0, nullptr), CE_None);
    EXPECT_EQ(read, values[std::size_t(b)]);
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files, (void)entry;
  EXPECT_EQ(files, 1) << "the descriptions stand in the file itself";

  const std::vector<std::uint8_t> bytes(70 * 30);
  bands.push_back({std::span<const std::uint8_t>(bytes), ""});
  EXPECT_THROW(write_geotiff(folder / "q.tif", grid, bands), std::logic_error);
  EXPECT_THROW(write_geotiff(folder / "q.tif", grid, {}), std::logic_error);
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
  Grid grid;
  grid.columns = grid.rows = 400;
  const Band band{std::span<const float>(noise), ""};
  for (const rlim_t limit : {rlim_t{0}, rlim_t{1000}, rlim_t{100000}, rlim_t{300000}}) {
    const SmallFiles small(limit);
    EXPECT_THROW(write(folder / "a.gpkg", PointFormat::geopackage, layer_in("EPSG:32610"), p), base::Error) << limit;
    EXPECT_THROW(write(folder / "a.fgb", PointFormat::flatgeobuf, layer_in(""), p), base::Error) << limit;
    EXPECT_THROW(write_geotiff(folder / "a.tif", grid, {&band, 1}), base::Error) << limit;
  }
}

TEST(Writer, UnwritablePlacesAreErrors) {
  for (const char* const path : {"/nowhere/a.gpkg", "/nowhere/a.fgb"}) {
    const std::string name = path;
    const auto format = name.ends_with("gpkg") ? PointFormat::geopackage : PointFormat::flatgeobuf;
    EXPECT_THROW(write(path, format, layer_in(""), some_points(3)), base::Error);
  }
  const TemporaryFolder folder;
  EXPECT_THROW(write_points(
                   folder / "a.fgb", PointFormat::flatgeobuf, layer_in(""), [] { return std::optional<PointBlock>(); },
                   0, [](std::string_view, double) { return false; }),
               base::Cancelled);
}

}  // namespace
}  // namespace silvasim::fields
