#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "files.h"
#include "made_land.h"
#include "silvasim/base/error.h"
#include "silvasim/export/formats.h"

namespace silvasim::exports {
namespace {

using testing::MadeLand;
using testing::make_land;

TEST(GeoTiff, holds_a_band_a_species_in_the_scenes_crs) {
  const testing::Folder folder;
  MadeLand made;
  made.crs_wkt = testing::utm_10_north();
  const ecosystem::Ecosystem land = make_land(made);
  const ecosystem::SuitabilityMap& map = land.layers[0].suitability;
  export_to(land, "", folder / "f.tiff");
  EXPECT_THAT(folder.names(), ::testing::ElementsAre("f.tiff"));
  const std::unique_ptr<GDALDataset> data(GDALDataset::Open((folder / "f.tiff").c_str(), GDAL_OF_RASTER));
  ASSERT_TRUE(data && data->GetSpatialRef());
  EXPECT_STREQ(data->GetSpatialRef()->GetAuthorityCode(nullptr), "32610");
  ASSERT_EQ(data->GetRasterCount(), 3);
  ASSERT_EQ(data->GetRasterXSize(), map.columns);
  ASSERT_EQ(data->GetRasterYSize(), map.rows);
  double transform[6];
  ASSERT_EQ(data->GetGeoTransform(transform), CE_None);
  EXPECT_THAT(transform, ::testing::ElementsAre(map.west, map.cell_m, 0, map.north, 0, -map.cell_m));
  std::vector<float> values(static_cast<std::size_t>(map.columns * map.rows));
  int holes = 0;
  for (int s = 0; s < 3; ++s) {
    GDALRasterBand& band = *data->GetRasterBand(s + 1);
    EXPECT_EQ(band.GetRasterDataType(), GDT_Float32);
    EXPECT_EQ(band.GetDescription(), land.layers[0].species[static_cast<std::size_t>(s)].name);
    EXPECT_TRUE(std::isnan(band.GetNoDataValue()));
    ASSERT_EQ(band.RasterIO(GF_Read, 0, 0, map.columns, map.rows, values.data(), map.columns, map.rows, GDT_Float32, 0,
                            0, nullptr),
              CE_None);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::uint8_t share = map.of(static_cast<std::size_t>(s))[i];
      if (share == ecosystem::SuitabilityMap::no_site) {
        ASSERT_TRUE(std::isnan(values[i]));
        ++holes;
      } else {
        ASSERT_FLOAT_EQ(values[i], static_cast<float>(share) / 254);
      }
    }
  }
  EXPECT_GT(holes, 10);
}

TEST(GeoTiff, layers_share_the_grid_of_the_smallest_cells) {
  const testing::Folder folder;
  ecosystem::Ecosystem land = make_land({});
  testing::add_shrubs(land, {});
  // Shrubs on half the grid: each of their cells covers 2 x 2 of the trees'.
  ecosystem::SuitabilityMap& coarse = land.layers[1].suitability;
  const ecosystem::SuitabilityMap& fine = land.layers[0].suitability;
  coarse.cell_m = 2 * fine.cell_m;
  coarse.columns = (fine.columns + 1) / 2;
  coarse.rows = (fine.rows + 1) / 2;
  coarse.shares.assign(static_cast<std::size_t>(2 * coarse.columns * coarse.rows), 0);
  for (std::size_t i = 0; i < coarse.shares.size(); ++i) coarse.shares[i] = static_cast<std::uint8_t>(i % 255);
  export_to(land, "tif", folder / "f.tif");
  const std::unique_ptr<GDALDataset> data(GDALDataset::Open((folder / "f.tif").c_str(), GDAL_OF_RASTER));
  ASSERT_TRUE(data);
  EXPECT_EQ(data->GetSpatialRef(), nullptr);
  ASSERT_EQ(data->GetRasterCount(), 5);
  ASSERT_EQ(data->GetRasterXSize(), fine.columns);
  EXPECT_STREQ(data->GetRasterBand(1)->GetDescription(), "trees: Picea abies");
  EXPECT_STREQ(data->GetRasterBand(5)->GetDescription(), "shrubs & herbs: Corylus avellana");
  std::vector<float> values(static_cast<std::size_t>(fine.columns * fine.rows));
  ASSERT_EQ(data->GetRasterBand(5)->RasterIO(GF_Read, 0, 0, fine.columns, fine.rows, values.data(), fine.columns,
                                             fine.rows, GDT_Float32, 0, 0, nullptr),
            CE_None);
  for (int row = 0; row < fine.rows; ++row) {
    for (int column = 0; column < fine.columns; ++column) {
      const std::uint8_t share = coarse.of(1)[row / 2 * coarse.columns + column / 2];
      ASSERT_FLOAT_EQ(values[static_cast<std::size_t>(row * fine.columns + column)], static_cast<float>(share) / 254);
    }
  }
}

TEST(GeoTiff, maps_that_are_not_there_tell_how_to_get_them) {
  const testing::Folder folder;
  MadeLand made;
  made.probabilities = false;
  try {
    export_to(make_land(made), "tif", folder / "f.tif");
    ADD_FAILURE() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("silvasim run ... --probabilities"));
  }
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace silvasim::exports
