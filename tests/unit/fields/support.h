// What the tests of the fields room share: settings in a line, files made for the occasion, and the shared data.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/fields/field_set.h"

namespace silvasim::fields {

inline std::filesystem::path shared(const std::string& name) {
  return std::filesystem::path(SILVA_SHARED_DIR) / "data" / name;
}

// Skips the test, loudly, where the folder of shared data is missing.
#define NEED_SHARED(name)                                       \
  if (!std::filesystem::exists(silvasim::fields::shared(name))) \
  GTEST_SKIP() << "SKIPPED: the shared data " << silvasim::fields::shared(name) << " is missing; this test needs it"

inline config::FieldSettings raster_field(const std::filesystem::path& path, bool terrain = false) {
  config::FieldSettings field;
  field.name = path.stem().string();
  field.place = {"scene.xml", 7, 3};
  field.source = config::Source::raster;
  field.path = path;
  field.terrain = terrain;
  return field;
}

inline config::FieldSettings vector_field(const std::filesystem::path& path, config::VectorMeasure measure) {
  config::FieldSettings field = raster_field(path);
  field.source = config::Source::vector;
  field.measure = measure;
  return field;
}

inline config::FieldSettings derived_field(config::TerrainMeasure measure, const std::string& of = "") {
  config::FieldSettings field;
  field.name = "derived" + std::to_string(static_cast<int>(measure));
  field.place = {"scene.xml", 9, 3};
  field.source = config::Source::derived;
  field.derivation = measure;
  field.of = of;
  return field;
}

inline config::SceneSettings scene_of(const std::string& crs, std::optional<base::Box> extent = std::nullopt) {
  config::SceneSettings scene;
  scene.place = {"scene.xml", 2, 3};
  scene.crs = crs;
  scene.extent = extent;
  return scene;
}

struct Sampled {
  float value = 0;
  bool no_data = true;
};

inline Sampled sample_at(const Field& field, double x, double y) {
  Sampled result;
  std::uint8_t missing = 0;
  sample(field.raster, field.kind, {&x, 1}, {&y, 1}, {&result.value, 1}, {&missing, 1});
  result.no_data = missing != 0;
  return result;
}

// The message of the ConfigError that loading throws; empty if it throws none.
inline std::string config_error(const config::SceneSettings& scene, const std::vector<config::FieldSettings>& fields) {
  try {
    load_fields(scene, fields);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return {};
}

// A folder that is gone with the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void write_text(const std::filesystem::path& path, const std::string& text);

// An ASCII grid of square cells; NaN is written as -9999, the declared nodata.
void write_grid(const std::filesystem::path& path, int columns, int rows, double west, double south, double cell,
                const std::vector<double>& values);

}  // namespace silvasim::fields
