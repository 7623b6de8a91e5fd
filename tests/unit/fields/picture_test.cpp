// Colours of rasters on the scene's frame.
#include "silvasim/fields/picture.h"

#include <gdal_priv.h>

#include "silvasim/fields/crs.h"
#include "silvasim/fields/feature_writer.h"
#include "silvasim/fields/raster_field.h"
#include "support.h"

namespace silvasim::fields {
namespace {

std::filesystem::path in_data(const std::string& name) {
  return std::filesystem::path(SILVA_SOURCE_DIR) / "data" / name;
}

TEST(Picture, BandsAreRedGreenAndBlue) {
  const TemporaryFolder folder;
  constexpr int columns = 7, rows = 5;
  std::array<std::vector<std::uint8_t>, 3> bands;
  for (std::size_t k = 0; k < 3; ++k) {
    for (int i = 0; i < columns * rows; ++i)
      bands[k].push_back(static_cast<std::uint8_t>(1 + 5 * i + static_cast<int>(k) * 20));
  }
  bands[1][9] = 0;
  Grid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.west = 100;
  grid.north = 250;
  grid.cell_width = grid.cell_height = 10;
  grid.no_data = 0;
  const std::vector<Band> written{{bands[0], "r"}, {bands[1], "g"}, {bands[2], "b"}};
  write_geotiff(folder / "a.tif", grid, written);
  config::FieldSettings field = raster_field(folder / "a.tif");
  field.crs = "local";
  const Picture picture = load_picture(field, {"", "", {100, 200, 170, 250}}, 0);
  ASSERT_EQ(picture.columns, columns);
  ASSERT_EQ(picture.rows, rows);
  EXPECT_EQ(picture.north, 250);
  for (std::size_t i = 0; i < columns * rows; ++i) {
    EXPECT_EQ(picture.rgba[4 * i + 3], i == 9 ? 0 : 255) << i;
    if (i == 9) continue;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(picture.rgba[4 * i + k], bands[k][i]) << i;
  }
}

// The palette, read by GDAL itself.
TEST(Picture, APaletteGivesItsColours) {
  const config::FieldSettings field = raster_field(in_data("soil.tif"));
  const std::vector<PaletteEntry> palette = load_palette(field);
  ASSERT_GE(palette.size(), 7u);
  const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(in_data("soil.tif").c_str()));
  ASSERT_TRUE(dataset);
  const GDALColorTable& table = *dataset->GetRasterBand(1)->GetColorTable();
  for (const PaletteEntry& entry : palette) {
    EXPECT_EQ(entry.rgb[0], table.GetColorEntry(entry.code)->c1);
    EXPECT_EQ(entry.rgb[2], table.GetColorEntry(entry.code)->c3);
  }
  const Frame frame{wkt_of(crs_from_text("EPSG:25832")), "", {570000, 5725200, 572000, 5726700}};
  const Picture picture = load_picture(field, frame, 0);
  config::FieldSettings codes = field;
  codes.kind = config::FieldKind::class_code;
  const Raster raster = load_raster_field(codes, frame, 0).raster;
  ASSERT_EQ(raster.values.size() * 4, picture.rgba.size());
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    if (picture.rgba[4 * i + 3] == 0) continue;
    const GDALColorEntry& c = *table.GetColorEntry(static_cast<int>(raster.values[i]));
    ASSERT_EQ(picture.rgba[4 * i], c.c1);
    ASSERT_EQ(picture.rgba[4 * i + 1], c.c2);
    ASSERT_EQ(picture.rgba[4 * i + 2], c.c3);
  }
}

TEST(Picture, GreyIsStretchedOverTheScene) {
  const Picture picture = load_picture(raster_field(in_data("water.png")), {"", "", {0, 0, 400, 300}}, 50);
  EXPECT_EQ(picture.west, 0);
  EXPECT_EQ(picture.north, 300);
  EXPECT_DOUBLE_EQ(picture.columns * picture.cell_width, 400);
  bool varies = false;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    ASSERT_EQ(picture.rgba[i], picture.rgba[i + 2]);
    varies = varies || picture.rgba[i] != picture.rgba[0];
  }
  EXPECT_TRUE(varies);
}

TEST(Picture, HeightsAreNoPicture) {
  const Frame frame{wkt_of(crs_from_text("EPSG:25832")), "", {570000, 5725200, 572000, 5726700}};
  EXPECT_THROW(load_picture(raster_field(in_data("elevation.tif")), frame, 0), base::ConfigError);
  EXPECT_TRUE(load_palette(raster_field(in_data("elevation.tif"))).empty());
}

}  // namespace
}  // namespace silvasim::fields
