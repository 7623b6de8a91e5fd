// Raster files on the scene's frame.
#include <gdal_priv.h>

#include <cmath>
#include <cstring>
#include <random>

#include "silvasim/base/parallel.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/feature_writer.h"
#include "silvasim/fields/frame.h"
#include "silvasim/fields/open.h"
#include "support.h"

namespace silvasim::fields {
namespace {

base::Point centre(const Raster& raster, int column, int row) {
  return {raster.west + (column + 0.5) * raster.cell_width, raster.north - (row + 0.5) * raster.cell_height};
}

TEST(Raster, SameCrsIsCutNotResampled) {
  NEED_SHARED("rainier/dem_ned_30m.tif");
  // Values by GDAL's own reading of columns and rows of the file.
  struct Case {
    int row, column;
    float value;
  };
  const Case cases[] = {{0, 0, 909.1144409179688f},
                        {400, 400, 3553.967041015625f},
                        {823, 883, 754.7029418945312f},
                        {123, 456, 1866.2900390625f}};
  const auto dem = raster_field(shared("rainier/dem_ned_30m.tif"), true);
  const base::Box part{138000.5, 5200001, 139877.7, 5201003};
  for (const auto& scene : {config::SceneSettings{}, scene_of("EPSG:26911"), scene_of("", part)}) {
    const FieldSet set = load_fields(scene, {dem});
    for (const Case& c : cases) {
      const double x = 125349.015334792668 + 30 * (c.column + 0.5), y = 5213641.545039580203593 - 30 * (c.row + 0.5);
      if (!set.frame.extent.contains({x, y})) continue;
      EXPECT_EQ(sample_at(set.fields[0], x, y).value, c.value);
    }
  }
  // A part of the scene holds the same cells as the whole.
  const Raster whole = load_fields({}, {dem}).fields[0].raster,
               cut = load_fields(scene_of("", part), {dem}).fields[0].raster;
  ASSERT_LT(cut.columns, 80);
  const int shift_x = static_cast<int>(std::lround((cut.west - whole.west) / 30)),
            shift_y = static_cast<int>(std::lround((whole.north - cut.north) / 30));
  for (int row = 0; row < cut.rows; ++row) {
    for (int column = 0; column < cut.columns; ++column)
      ASSERT_EQ(cut.at(column, row), whole.at(column + shift_x, row + shift_y));
  }
  EXPECT_LE(cut.west, part.west - 30);
  EXPECT_GE(cut.extent().east, part.east + 30);
}

TEST(Raster, NamesOfTheSameCrsDoNotMatter) {
  NEED_SHARED("nc_wake/landuse_r.tif");
  auto landuse = raster_field(shared("nc_wake/landuse_r.tif"));
  landuse.kind = config::FieldKind::class_code;
  const FieldSet set = load_fields({}, {raster_field(shared("nc_wake/elev_ned_30m.tif"), true), landuse});
  EXPECT_NE(set.fields[1].source.find("cut to 1500 x 1350"), std::string::npos) << set.fields[1].source;
  EXPECT_EQ(set.fields[1].sha256.size(), 64u);
}

// Against gdalwarp -t_srs EPSG:32610 -r bilinear -te 584910.15 5179903.55 605096.45 5200089.85 -tr 29.95 29.95 -et 0
// -wo XSCALE=1 -wo YSCALE=1 (GDAL 3.6.2),
// which is the grid that Silva makes of this scene.
TEST(Raster, WarpAgreesWithGdalwarp) {
  NEED_SHARED("rainier/dem_ned_30m.tif");
  const FieldSet set = load_fields(scene_of("EPSG:32610", base::Box{585000, 5180000, 605000, 5200000}),
                                   {raster_field(shared("rainier/dem_ned_30m.tif"), true)});
  const Raster& raster = set.fields[0].raster;
  EXPECT_NEAR(raster.west, 584910.15, 1e-6);
  EXPECT_NEAR(raster.north, 5200089.85, 1e-6);
  EXPECT_EQ(raster.columns, 674);
  struct Case {
    int row, column;
    double value;
  };
  for (const Case& c : {Case{10, 10, 1256.93505859375},
                        {300, 500, 2048.970458984375},
                        {337, 326, 4184.7802734375},
                        {500, 100, 1617.2264404296875},
                        {660, 660, 1017.0809326171875}}) {
    EXPECT_NEAR(raster.at(c.column, c.row), c.value, 0.05) << c.row << " " << c.column;
  }
}

// A second way: each cell of the result, brought back to the file and read there between its cells.
TEST(Raster, WarpIsBilinearInTheFile) {
  NEED_SHARED("luxembourg/elev.tif");
  for (const char* const name : {"luxembourg/elev.tif", "rainier/dem_ned_30m.tif", "srtm_hgt/N04E033.hgt"}) {
    const auto dem = raster_field(shared(name), true);
    const bool degrees = std::string(name) != "rainier/dem_ned_30m.tif";
    const FieldSet warped = load_fields(degrees ? config::SceneSettings{} : scene_of("EPSG:32610"), {dem});
    // The same file, cut in its own coordinates: degrees taken for local metres.
    auto raw = dem;
    raw.crs = "local";
    config::SceneSettings local = scene_of("local");
    const FieldSet own = load_fields(local, {raw});
    const Transformation to_file(crs_of(warped.frame), crs_from_text(degrees ? "EPSG:4326" : "EPSG:26911"));
    const Raster& raster = warped.fields[0].raster;
    std::mt19937 random(77);
    int compared = 0;
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
      const int column = static_cast<int>(random() % static_cast<unsigned>(raster.columns)),
                row = static_cast<int>(random() % static_cast<unsigned>(raster.rows));
      const auto p = to_file.apply(centre(raster, column, row));
      ASSERT_TRUE(p);
      const Sampled truth = sample_at(own.fields[0], p->x, p->y);
      const Raster& file = own.fields[0].raster;
      const double margin = 1.5 * file.cell_width;
      const base::Box inner{file.extent().west + margin, file.extent().south + margin, file.extent().east - margin,
                            file.extent().north - margin};
      if (truth.no_data || !inner.contains(*p) || std::isnan(raster.at(column, row))) continue;
      ++compared;
      worst = std::max(worst, std::abs(double(truth.value) - raster.at(column, row)));
    }
    EXPECT_GT(compared, 2000) << name;
    EXPECT_LT(worst, 1.0) << name;  // 0.005 cells of the position on slopes of up to 70 degrees
  }
}

TEST(Raster, ClassesComeByNearestAndOnlyTheFilesOwn) {
  NEED_SHARED("nc_wake/landuse_r.tif");
  auto landuse = raster_field(shared("nc_wake/landuse_r.tif"));
  landuse.kind = config::FieldKind::class_code;
  const FieldSet set = load_fields(scene_of("EPSG:32617"), {landuse});
  EXPECT_NE(set.fields[0].source.find("warped"), std::string::npos);
  std::vector<long> seen(8);
  for (const float value : set.fields[0].raster.values) {
    if (std::isnan(value)) continue;
    ASSERT_EQ(value, std::floor(value));
    ASSERT_GE(value, 1);
    ASSERT_LE(value, 7);
    ++seen[static_cast<std::size_t>(value)];
  }
  EXPECT_GT(seen[5], seen[7]);
}

TEST(Raster, BandsScaleAndNoData) {
  NEED_SHARED("lolo_montana/landfire_lcp_30m.tif");
  auto height = raster_field(shared("lolo_montana/landfire_lcp_30m.tif"));
  const double x = 708282.991846723947674 + 30 * 200.5, y = 5182553.117147243581712 - 30 * 100.5;
  EXPECT_EQ(sample_at(load_fields({}, {height}).fields[0], x, y).value, 1364);
  height.band = 6;
  EXPECT_EQ(sample_at(load_fields({}, {height}).fields[0], x, y).value, 150);
  height.scaled = true;
  height.scale = 0.1;
  height.offset = 2;
  EXPECT_FLOAT_EQ(sample_at(load_fields({}, {height}).fields[0], x, y).value, 17);
  height.no_data_value = 150;  // a raw value
  EXPECT_TRUE(sample_at(load_fields({}, {height}).fields[0], x, y).no_data);
  height.band = 9;
  EXPECT_NE(config_error({}, {height}).find("there is no band 9"), std::string::npos);
  height.band = 0;
  EXPECT_NE(config_error({}, {height}).find("it has bands 1 to 8"), std::string::npos);
}

TEST(Raster, FileScaleAndFeet) {
  NEED_SHARED("malformed/raster/derived/dem_int16_scale_offset_feet.tif");
  // value = raw * 0.5 + 1000, in feet. As plain numbers they stay feet; as terrain they become metres.
  const auto path = shared("malformed/raster/derived/dem_int16_scale_offset_feet.tif");
  auto plain = raster_field(path), terrain = raster_field(path, true), own = raster_field(path, true);
  own.scaled = true;
  own.scale = 2;
  const FieldSet a = load_fields({}, {plain}), b = load_fields({}, {terrain}), c = load_fields({}, {own});
  int compared = 0;
  for (std::size_t i = 0; i < a.fields[0].raster.values.size(); ++i) {
    const float feet = a.fields[0].raster.values[i];
    if (std::isnan(feet)) continue;
    ++compared;
    ASSERT_NEAR(b.fields[0].raster.values[i], feet * 0.3048, 1e-3);
    ASSERT_NEAR(c.fields[0].raster.values[i], feet * 2, 1e-3);  // the user's word holds
  }
  EXPECT_GT(compared, 1000);
  EXPECT_NE(b.fields[0].source.find("turned into metres"), std::string::npos);
}

TEST(Raster, ImagesAreStretchedAndReadAsShares) {
  NEED_SHARED("puget_sound/ps_height_1k.png");
  config::SceneSettings scene = scene_of("");
  scene.width_m = scene.height_m = 1025 * 10.0;
  const auto grey = raster_field(shared("puget_sound/ps_height_1k.png"));
  auto terrain = raster_field(shared("puget_sound/ps_height_1k.png"), true);
  terrain.scaled = true;
  terrain.scale = 0.1;
  auto raw = grey;
  raw.kind = config::FieldKind::class_code;
  const auto colour = raster_field(shared("puget_sound/ps_texture_1k.png"));
  const FieldSet set = load_fields(scene, {grey, terrain, raw, colour});
  // Cells by GDAL's own reading: (0, 0) = 6387, (512, 512) = 1969, row 1000 column 300 = 2715.
  EXPECT_FLOAT_EQ(sample_at(set.fields[0], 5, 10245).value, 6387 / 65535.0f);
  EXPECT_FLOAT_EQ(sample_at(set.fields[1], 5, 10245).value, 638.7f);
  EXPECT_FLOAT_EQ(sample_at(set.fields[1], 5125, 5125).value, 196.9f);
  EXPECT_EQ(sample_at(set.fields[2], 3005, 245).value, 2715);
  float least = 1, most = 0;
  for (const float value : set.fields[3].raster.values) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_EQ(least, 0);
  EXPECT_EQ(most, 1);
  EXPECT_NE(config_error({}, {terrain}).find("how large the scene is"), std::string::npos);
}

// Writes an image without georeference, as a drawing program would.
void make_png(const std::filesystem::path& path, GDALDataType type, std::vector<std::uint16_t> samples, int columns,
              int rows) {
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const Dataset memory(drivers.GetDriverByName("MEM")->Create("", columns, rows, 1, type, nullptr));
  ASSERT_EQ(memory->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, columns, rows, samples.data(), columns, rows, GDT_UInt16,
                                               0, 0, nullptr),
            CE_None);
  const Dataset file(
      drivers.GetDriverByName("PNG")->CreateCopy(path.c_str(), memory.get(), 0, nullptr, nullptr, nullptr));
  ASSERT_TRUE(file);
}

// The same picture in 8 and in 16 bits (v * 257) gives the same field.
TEST(Raster, EightAndSixteenBitsAlike) {
  prepare_gdal();
  const TemporaryFolder folder;
  std::vector<std::uint16_t> shallow, deep;
  for (int i = 0; i < 256; ++i) {
    shallow.push_back(static_cast<std::uint16_t>(i));
    deep.push_back(static_cast<std::uint16_t>(i * 257));
  }
  make_png(folder / "shallow.png", GDT_Byte, shallow, 16, 16);
  make_png(folder / "deep.png", GDT_UInt16, deep, 16, 16);
  const FieldSet set = load_fields(scene_of("local", base::Box{0, 0, 160, 320}),
                                   {raster_field(folder / "shallow.png"), raster_field(folder / "deep.png")});
  EXPECT_EQ(set.fields[0].raster, set.fields[1].raster);
  EXPECT_EQ(set.fields[0].raster.at(0, 0), 0);
  EXPECT_EQ(set.fields[0].raster.at(15, 15), 1);
  EXPECT_EQ(set.fields[0].raster.extent(), (base::Box{0, 0, 160, 320}));
  EXPECT_NEAR(sample_at(set.fields[0], 5, 310).value, 0, 1e-7);
  EXPECT_NEAR(sample_at(set.fields[0], 15, 310).value, 1 / 255.0, 1e-7);
}

// More cells than a field may have: neighbours are merged, values by their mean, classes by the commonest.
TEST(Raster, HugeRastersAreMerged) {
  prepare_gdal();
  const TemporaryFolder folder;
  const int side = 11000;
  {
    const char* const options[] = {"COMPRESS=DEFLATE", "TILED=YES", nullptr};
    const Dataset dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        (folder / "huge.tif").c_str(), side, side, 1, GDT_Byte, const_cast<char**>(options)));
    double transform[6] = {0, 1, 0, side, 0, -1};
    dataset->SetGeoTransform(transform);
    dataset->GetRasterBand(1)->SetNoDataValue(255);
    dataset->GetRasterBand(1)->Fill(7);
    std::uint8_t patch[] = {0, 10, 20, 30, 255, 255, 255, 10, 3, 3, 9, 9, 9, 5, 5, 9};  // four rows of four
    ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 100, 200, 4, 4, patch, 4, 4, GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
  auto value = raster_field(folder / "huge.tif"), code = value;
  code.kind = config::FieldKind::class_code;
  const FieldSet set = load_fields(scene_of("local", base::Box{0, 0, double(side), double(side)}), {value, code});
  for (const Field& field : set.fields) {
    EXPECT_EQ(field.raster.columns, side / 2);
    EXPECT_EQ(field.raster.cell_width, 2);
    EXPECT_EQ(field.raster.extent(), (base::Box{0, 0, double(side), double(side)}));
    EXPECT_EQ(field.raster.at(5, 5), 7);
    EXPECT_NE(field.source.find("merged 2 x 2"), std::string::npos) << field.source;
  }
  EXPECT_EQ(set.fields[0].raster.at(50, 100), 5);   // 0, 10 and two without data
  EXPECT_EQ(set.fields[0].raster.at(51, 100), 20);  // 20, 30, 10 and one without
  EXPECT_EQ(set.fields[0].raster.at(50, 101), 5);   // 3, 3, 9, 5
  EXPECT_EQ(set.fields[1].raster.at(50, 101), 3);   // the commonest
  EXPECT_EQ(set.fields[1].raster.at(51, 101), 9);
}

TEST(Raster, SouthUpAndRotatedAndNonSquare) {
  NEED_SHARED("malformed/raster/derived/dem_south_up.tif");
  const auto base_file = raster_field(shared("lolo_montana/landfire_lcp_30m.tif"), true);
  const FieldSet truth = load_fields({}, {base_file});
  // Both are cuts of the same band; read at the same ground points they must agree.
  const auto south_up = raster_field(shared("malformed/raster/derived/dem_south_up.tif"));
  const FieldSet set = load_fields(scene_of("EPSG:32611"), {south_up});
  EXPECT_NE(set.fields[0].source.find("cut to"), std::string::npos);
  const Raster& raster = set.fields[0].raster;
  int equal = 0, count = 0;
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const base::Point p = centre(raster, column, row);
      ++count;
      equal += sample_at(truth.fields[0], p.x, p.y).value == raster.at(column, row);
    }
  }
  EXPECT_EQ(equal, count);

  const FieldSet rotated =
      load_fields({}, {raster_field(shared("malformed/raster/derived/dem_rotated_30deg.tif"), true)});
  EXPECT_NEAR(rotated.fields[0].raster.cell_width, 30, 0.1);
  long known = 0;
  for (const float value : rotated.fields[0].raster.values) known += !std::isnan(value);
  EXPECT_NEAR(double(known), 90 * 60, 100);  // a rotation keeps the area
}

TEST(Raster, TerrainKnowsTheUndeclaredVoid) {
  NEED_SHARED("malformed/raster/derived/dem_undeclared_minus9999.tif");
  const auto path = shared("malformed/raster/derived/dem_undeclared_minus9999.tif");
  const FieldSet terrain = load_fields({}, {raster_field(path, true)});
  const FieldSet plain = load_fields({}, {raster_field(path)});
  float least = 1e9f, least_plain = 1e9f;
  for (const float value : terrain.fields[0].raster.values) least = std::isnan(value) ? least : std::min(least, value);
  for (const float value : plain.fields[0].raster.values) least_plain = std::min(least_plain, value);
  EXPECT_GT(least, 0);
  EXPECT_EQ(least_plain, -9999);
}

TEST(Raster, AllMistakesAreShownTogether) {
  auto a = raster_field("/nowhere/a.tif"), b = raster_field("/nowhere/b.tif");
  b.place.line = 8;
  try {
    load_fields(scene_of("local", base::Box{0, 0, 10, 10}), {a, b});
    FAIL();
  } catch (const base::ConfigError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2u);
    EXPECT_EQ(error.diagnostics()[0].place.line, 7);
    EXPECT_EQ(error.diagnostics()[1].place.line, 8);
    EXPECT_EQ(error.diagnostics()[0].message, "data field \"a\": there is no file \"/nowhere/a.tif\"");
  }
}

TEST(Raster, CancelAndProgress) {
  const TemporaryFolder folder;
  write_grid(folder / "a.asc", 3, 3, 0, 0, 10, std::vector<double>(9, 1.0));
  double last = 0;
  load_fields({}, {raster_field(folder / "a.asc"), raster_field(folder / "a.asc")},
              [&](std::string_view stage, double done) {
                EXPECT_EQ(stage, "fields");
                EXPECT_GT(done, last);
                last = done;
                return true;
              });
  EXPECT_EQ(last, 1);
  EXPECT_THROW(load_fields({}, {raster_field(folder / "a.asc")}, [](std::string_view, double) { return false; }),
               base::Cancelled);
}

// Heights at cell centres of real places, by GDAL's own reading of row and column. Exact where the file is in metres; where it is
// in degrees, two interpolations lie between (cells of 900 m in Luxembourg, 90 m in the others).
TEST(Raster, RealPlaces) {
  struct Case {
    const char* file;
    double x, y, value, tolerance;
  };
  const Case cases[] = {{"volcano/volcano.asc", 305, 465, 161, 0},
                        {"volcano/volcano.asc", 5, 865, 94, 0},
                        {"mongon/dem.tif", 796157.03261463, 8933826.39960253, 647, 0},
                        {"kagwene/elevation.tif", 583219.59930685, 676567.21112171, 1962, 0},
                        {"vinschgau/elev_vinschgau.tif", 623375, 5167875, 1628, 0},
                        {"luquillo/elevation_5m.asc", 50, 450, 346.8f, 0},
                        {"dogrib/elevation.asc", 459950, 5737050, 2230, 0},
                        {"luxembourg/elev.tif", 6.1375, 49.8125, 290, 40},
                        {"luxembourg/elev.tif", 5.9125, 49.9375, 414, 40},
                        {"srtm_hgt/N04E033.hgt", 33.5, 4.5, 947, 10},
                        {"srtm_hgt/N04E033.hgt", 33.0833333333, 4.0833333333, 831, 10},
                        {"srtm_hgt/N04E033.hgt", 33.8333333333, 4.9583333333, 583, 10},
                        {"malformed/raster/n43.dt0", -79.5, 43.5, 75, 5}};
  for (const Case& c : cases) {
    NEED_SHARED(c.file);
    const FieldSet set = load_fields({}, {raster_field(shared(c.file), true)});
    base::Point p{c.x, c.y};
    if (c.tolerance > 0) p = scene_from_geographic(set.frame, {c.y, c.x}).value();
    const Sampled s = sample_at(set.fields[0], p.x, p.y);
    EXPECT_FALSE(s.no_data) << c.file;
    EXPECT_NEAR(s.value, c.value, c.tolerance) << c.file;
  }
}

bool same_bytes(const Raster& a, const Raster& b) {
  return a.values.size() == b.values.size() &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

TEST(Raster, SameBytesForAnyThreads) {
  NEED_SHARED("luxembourg/elev.tif");
  std::vector<config::FieldSettings> fields = {
      raster_field(shared("luxembourg/elev.tif"), true),
      vector_field(shared("luxembourg/lux.shp"), config::VectorMeasure::inside),
      vector_field(shared("luxembourg/lux.shp"), config::VectorMeasure::distance)};
  for (int measure = 0; measure <= static_cast<int>(config::TerrainMeasure::hillshade); ++measure) {
    fields.push_back(derived_field(static_cast<config::TerrainMeasure>(measure)));
  }
  fields.push_back(derived_field(config::TerrainMeasure::tpi));
  fields.back().radius_m = 3000;
  std::vector<FieldSet> sets;
  for (const int threads : {1, 2, 3, 8}) {
    const base::ThreadLimit limit(threads);
    sets.push_back(load_fields({}, fields));
  }
  for (const FieldSet& set : sets) {
    for (std::size_t k = 0; k < fields.size(); ++k)
      EXPECT_TRUE(same_bytes(set.fields[k].raster, sets[0].fields[k].raster)) << fields[k].name;
  }
}

}  // namespace
}  // namespace silvasim::fields
