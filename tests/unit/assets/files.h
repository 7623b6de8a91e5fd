// What the tests of this folder share: folders that vanish, the shared data, and the promises of model.h.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "assets/load.h"
#include "assets/model.h"
#include "silvasim/base/error.h"

namespace assets::test {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "silva-assets-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  const fs::path& path() const { return path_; }

  fs::path write(const std::string& name, const std::string& bytes) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  fs::path path_;
};

inline std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline fs::path shared() { return fs::path(SILVA_SHARED_DIR) / "data"; }

#define SILVA_NEEDS_SHARED()                                       \
  if (!std::filesystem::exists(assets::test::shared() / "models")) \
  GTEST_SKIP() << "the shared data are not here: " << assets::test::shared()

inline double area(const Model& model, std::size_t triangle) {
  const auto& [i, j, k] = model.triangles[triangle];
  const V3d a(model.positions[i]), b(model.positions[j]), c(model.positions[k]);
  return 0.5 * (b - a).cross(c - a).length();
}

inline double surface(const Model& model) {
  double sum = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) sum += area(model, t);
  return sum;
}

// The first promise of model.h that is broken; empty: all are kept.
inline std::string broken_promise(const Model& m) {
  if (m.triangles.empty()) return "no triangle";
  if (m.materials.empty()) return "no material";
  if (m.triangle_materials.size() != m.triangles.size()) return "materials of triangles";
  if (m.normals.size() != m.positions.size() || m.uvs.size() != m.positions.size()) return "columns differ in length";
  for (const V3& p : m.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "position is not finite";
  }
  for (const V2& uv : m.uvs) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return "uv is not finite";
  }
  for (const V3& n : m.normals) {
    if (!(std::abs(n.length() - 1) < 1e-4)) return "normal is not of unit length";
  }
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    for (const std::uint32_t corner : m.triangles[t]) {
      if (corner >= m.positions.size()) return "index of a vertex";
    }
    if (m.triangle_materials[t] >= m.materials.size()) return "index of a material";
    if (!(area(m, t) > 0)) return "triangle without an area";
    const auto& [i, j, k] = m.triangles[t];
    const V3d a(m.positions[i]), b(m.positions[j]), c(m.positions[k]);
    const V3d sum = V3d(m.normals[i]) + V3d(m.normals[j]) + V3d(m.normals[k]);
    if ((b - a).cross(c - a).normalized().dot(sum) < -1e-4) return "normals point to the back of their triangle";
  }
  for (const Material& material : m.materials) {
    for (int c = 0; c < 3; ++c) {
      if (!(material.reflectance[c] >= 0 && material.reflectance[c] <= 1)) return "reflectance";
      if (!(material.transmittance[c] >= 0 && material.transmittance[c] <= 1)) return "transmittance";
    }
    if (material.texture < no_texture || material.texture >= static_cast<int>(m.textures.size()))
      return "index of a texture";
    if (!(material.alpha_cutoff >= 0 && material.alpha_cutoff <= 1)) return "cutoff";
  }
  for (const Texture& t : m.textures) {
    if (t.width < 1 || t.height < 1) return "empty texture";
    if (t.rgba.size() != 4 * static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height))
      return "texture's size";
  }
  return "";
}

// The error that loading ends with; empty if it does not.
inline std::string error_of(const fs::path& file, const LoadOptions& options = {}) {
  try {
    load(file, options);
    return "";
  } catch (const silvasim::base::Error& error) {
    return error.what();
  }
}

// Damaged input must give a clear error, or a model that keeps its promises.
inline void expect_survival(const fs::path& file, const std::string& what) {
  try {
    const Model model = load(file);
    ASSERT_EQ(broken_promise(model), "") << what;
  } catch (const silvasim::base::Error& error) {
    const std::string text = error.what();
    ASSERT_NE(text.find(file.filename().string()), std::string::npos) << what << ": " << text;
    ASSERT_EQ(text.find('\n'), std::string::npos) << what << ": " << text;
  }
}

}  // namespace assets::test
