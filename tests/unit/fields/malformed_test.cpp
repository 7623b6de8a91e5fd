// Every damaged, hostile or unusual file ends in one clear error or in finite values.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "support.h"

namespace silvasim::fields {
namespace {

// The files of a folder, deepest too, in the order of their names.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) result.push_back(entry.path());
  }
  std::sort(result.begin(), result.end());
  return result;
}

// What became of it: "error: ..." or "fine: ...".
std::string outcome(const config::SceneSettings& scene, const std::vector<config::FieldSettings>& fields) {
  try {
    const FieldSet set = load_fields(scene, fields);
    for (const Field& field : set.fields) {
      EXPECT_FALSE(field.raster.values.empty());
      EXPECT_GT(field.raster.cell_width, 0);
      EXPECT_GT(field.raster.cell_height, 0);
      bool any = false;
      for (const float value : field.raster.values) {
        EXPECT_FALSE(std::isinf(value)) << field.path;
        any = any || !std::isnan(value);
      }
      EXPECT_TRUE(any || field.path.empty()) << field.path;
    }
    return "fine: " + set.fields[0].source;
  } catch (const base::ConfigError& error) {
    EXPECT_FALSE(error.diagnostics().empty());
    for (const auto& diagnostic : error.diagnostics()) {
      EXPECT_NE(diagnostic.place.line, 0);
      EXPECT_EQ(diagnostic.message.find('\n'), std::string::npos);
      EXPECT_GT(diagnostic.message.size(), 20u) << diagnostic.message;
    }
    return std::string("error: ") + error.what();
  } catch (const base::Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return std::string("error: ") + error.what();
  }
}

bool is_sidecar(const std::filesystem::path& path) {
  const auto suffix = path.extension();
  return suffix == ".dbf" || suffix == ".shx" || suffix == ".PRJ" || suffix == ".raw";
}

TEST(Malformed, Rasters) {
  NEED_SHARED("malformed/raster");
  int count = 0;
  for (const auto& path : files_of(shared("malformed/raster"))) {
    if (is_sidecar(path)) continue;
    ++count;
    SCOPED_TRACE(path.filename());
    const auto start = std::chrono::steady_clock::now();
    // As the terrain that gives the frame, with what is derived from it; as an image of a local scene; as classes.
    std::vector<config::FieldSettings> terrain = {raster_field(path, true)};
    for (int measure = 0; measure <= static_cast<int>(config::TerrainMeasure::hillshade); ++measure) {
      terrain.push_back(derived_field(static_cast<config::TerrainMeasure>(measure)));
    }
    outcome(scene_of(""), terrain);
    auto image = raster_field(path);
    outcome(scene_of("local", base::Box{0, 0, 1000, 1000}), {image});
    outcome(scene_of("EPSG:32611", base::Box{711000, 5178000, 714000, 5180000}), {image});
    image.kind = config::FieldKind::class_code;
    image.crs = "local";
    outcome(scene_of("local", base::Box{0, 0, 1000, 1000}), {image});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60)) << "hangs";
  }
  EXPECT_GT(count, 50);
}

TEST(Malformed, RastersThatMustBeRefused) {
  NEED_SHARED("malformed/raster");
  for (const char* const name : {"cfloat64.tif",
                                 "idontexist.vrt",
                                 "nonsquare.vrt",
                                 "all-nodata.tif",
                                 "windninja_nodata.tif",
                                 "byte_buggy_packbits.tif",
                                 "derived/vrt_claims_2e9_pixels.vrt",
                                 "derived/vrt_self_reference.vrt",
                                 "derived/zero_bytes.tif",
                                 "derived/random_bytes.tif",
                                 "derived/text_named_tif.tif",
                                 "derived/dem_truncated_half.tif",
                                 "derived/dem_header_only_64_bytes.tif",
                                 "derived/dem_deflate_bit_flips.tif",
                                 "derived/dem_all_nodata.tif",
                                 "derived/dem_zero_pixel_size.tif",
                                 "derived/dem_float64_huge_values.tif",
                                 "derived/dem_wrong_crs_metres_tagged_4326.tif",
                                 "derived/asc_short_rows.asc",
                                 "derived/asc_bad_numbers.asc",
                                 "derived/asc_negative_size.asc",
                                 "derived/dem_no_geotransform.tif"}) {
    const std::string what =
        outcome(scene_of(""), {raster_field(shared(std::string("malformed/raster/") + name), true)});
    EXPECT_TRUE(what.starts_with("error: ")) << name << ": " << what;
  }
}

TEST(Malformed, RastersThatMustBeRead) {
  NEED_SHARED("malformed/raster");
  for (const char* const name : {"uint16.tif",
                                 "int12.tif",
                                 "rotated.tif",
                                 "geomatrix.tif",
                                 "nodata_float.asc",
                                 "pixel_per_line.asc",
                                 "case_sensitive.ASC",
                                 "n43.dt0",
                                 "float_raster_with_nodata.tif",
                                 "windninja_tiny.tif",
                                 "windninja_no_srs.tif",
                                 "windninja_geog.tif",
                                 "derived/dem_1x1.tif",
                                 "derived/dem_1xN.tif",
                                 "derived/dem_nan_inf_no_nodata.tif",
                                 "derived/dem_nodata_nan.tif",
                                 "derived/dem_south_up.tif",
                                 "derived/dem_rotated_30deg.tif",
                                 "derived/dem_non_square_pixels.tif",
                                 "derived/dem_constant.tif",
                                 "derived/dem_no_crs.tif",
                                 "derived/classes_palette.tif",
                                 "derived/dem_int16_scale_offset_feet.tif",
                                 "derived/asc_comma_decimal.asc"}) {
    const std::string what =
        outcome(scene_of(""), {raster_field(shared(std::string("malformed/raster/") + name), true)});
    EXPECT_TRUE(what.starts_with("fine: ")) << name << ": " << what;
  }
}

TEST(Malformed, Vectors) {
  NEED_SHARED("malformed/vector");
  int count = 0;
  for (const auto& path : files_of(shared("malformed/vector"))) {
    if (is_sidecar(path)) continue;
    ++count;
    SCOPED_TRACE(path.filename());
    const auto start = std::chrono::steady_clock::now();
    for (const auto measure :
         {config::VectorMeasure::inside, config::VectorMeasure::distance, config::VectorMeasure::attribute}) {
      auto field = vector_field(path, measure);
      field.attribute = measure == config::VectorMeasure::attribute ? "id" : "";
      outcome(scene_of("EPSG:32631", base::Box{400000, 0, 410000, 10000}), {field});
      field.crs = "local";
      outcome(scene_of("local", base::Box{-50, -50, 150, 150}), {field});
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60)) << "hangs";
  }
  EXPECT_GT(count, 18);
}

TEST(Malformed, VectorsInASensibleWay) {
  NEED_SHARED("malformed/vector");
  const auto scene = scene_of("local", base::Box{0, 0, 100, 100});
  const auto load = [&](const char* name) {
    auto field = vector_field(shared(std::string("malformed/vector/derived/") + name), config::VectorMeasure::inside);
    field.crs = "local";
    return load_fields(scene, {field}).fields[0];
  };
  EXPECT_EQ(sample_at(load("bowtie_polygon.geojson"), 5, 50).value, 1);
  EXPECT_EQ(sample_at(load("unclosed_ring.geojson"), 50, 50).value, 1);
  EXPECT_EQ(sample_at(load("null_and_empty_geometries.geojson"), 10.5, 19.5).value, 1);
  EXPECT_EQ(sample_at(load("mixed_geometry_types.geojson"), 3.5, 3.5).value, 1);
  for (const char* const name : {"truncated.geojson", "truncated.gpkg", "nan_coordinates.geojson",
                                 "deep_nesting_20000.geojson", "shp_truncated.shp"}) {
    EXPECT_THROW(load(name), base::Error) << name;
  }
}

}  // namespace
}  // namespace silvasim::fields
