// The real models of the shared data, against their README and against each other.
#include <gmock/gmock.h>

#include <map>
#include <regex>
#include <set>

#include "assets/fit.h"
#include "assets/texture.h"
#include "files.h"

namespace assets {
namespace {

using namespace test;

struct Row {
  std::string file;
  std::size_t triangles = 0, materials = 0;
  bool masked = false;
};

// "| `models/x.gltf` (2 kB) | ... | 900 triangles, 1 materials, 1 images, alpha MASK |"
std::vector<Row> table() {
  std::istringstream text(read(shared() / "README.md"));
  const std::regex pattern(R"(^\| `(models/[^`]*)` .*\| (\d+) triangles, (\d+) materials, \d+ images, alpha (\w+))");
  std::vector<Row> rows;
  std::smatch match;
  for (std::string line; std::getline(text, line);) {
    if (std::regex_search(line, match, pattern)) {
      rows.push_back({match[1], std::stoul(match[2]), std::stoul(match[3]), match[4] == "MASK"});
    }
  }
  return rows;
}

TEST(Models, TriangleCountsAndMaterialsAreThoseOfTheTable) {
  SILVA_NEEDS_SHARED();
  const std::vector<Row> rows = table();
  ASSERT_GE(rows.size(), 32u);
  // Two triangles of this one have three corners on a line (x and y are alike).
  const std::map<std::string, std::size_t> without_area{{"models/kenney_nature/tree_oak_fall.glb", 2}};
  // This one's alpha was lost when its picture became a JPEG.
  const std::set<std::string> lost_alpha{"models/polyhaven/fern_02.glb"};
  for (const Row& row : rows) {
    LoadReport report;
    const Model m = load(shared() / row.file, {}, &report);
    EXPECT_EQ(broken_promise(m), "") << row.file;
    const auto it = without_area.find(row.file);
    EXPECT_EQ(m.triangles.size(), row.triangles - (it == without_area.end() ? 0 : it->second)) << row.file;
    EXPECT_EQ(m.materials.size(), row.materials) << row.file;
    bool cut = false;
    for (const Material& material : m.materials) {
      if (material.alpha_cutoff <= 0) continue;
      cut = true;
      const Texture& t = m.textures[static_cast<std::size_t>(material.texture)];
      EXPECT_TRUE(t.has_alpha) << row.file;
      EXPECT_GT(coverage(t, material.alpha_cutoff), 0.1) << row.file;
      EXPECT_LT(coverage(t, material.alpha_cutoff), 0.9) << row.file;
      EXPECT_GT(material.transmittance.y, 0) << row.file << ": leaves shine through";
    }
    EXPECT_EQ(cut, row.masked && !lost_alpha.contains(row.file)) << row.file;
    EXPECT_EQ(report.warnings.size(), lost_alpha.contains(row.file) ? 1u : 0u) << row.file;
    for (const Texture& t : m.textures) {
      std::uint8_t least = 255, greatest = 0;
      for (std::size_t i = 0; i < t.rgba.size(); i += 4) {
        least = std::min(least, t.rgba[i + 1]);
        greatest = std::max(greatest, t.rgba[i + 1]);
      }
      EXPECT_GT(greatest - least, 20) << row.file << ": " << t.name << " is of one colour";
    }
    // They are things of 20 cm to 10 m that stand on the ground near their origin.
    const Measures measures = measure(m);
    EXPECT_GT(measures.height_m, 0.19) << row.file;
    EXPECT_LT(measures.height_m, 10) << row.file;
    EXPECT_GE(measures.least.z, -0.4f) << row.file;
    EXPECT_LT(measures.reach_m, 3) << row.file;
    EXPECT_GT(measures.crown_radius_m, 0.5 * measures.reach_m) << row.file;
    EXPECT_LE(measures.crown_radius_m, measures.reach_m) << row.file;
  }
}

// The number of triangles of an OBJ by its text alone.
std::size_t faces_in(const fs::path& file) {
  std::istringstream text(read(file));
  std::size_t count = 0;
  for (std::string line; std::getline(text, line);) {
    if (line.compare(0, 2, "f ") != 0) continue;
    std::istringstream words(line.substr(2));
    std::size_t corners = 0;
    for (std::string word; words >> word;) ++corners;
    count += corners - 2;
  }
  return count;
}

TEST(Models, ObjAndGltfOfOneModelAgree) {
  SILVA_NEEDS_SHARED();
  const fs::path models = shared() / "models";
  int pairs = 0;
  for (const char* folder : {"kaykit_forest", "quaternius_megakit_obj"}) {
    for (const auto& entry : fs::directory_iterator(models / folder)) {
      if (entry.path().extension() != ".obj") continue;
      const std::string name = entry.path().stem().string();
      const fs::path other =
          models / (std::string(folder) == "kaykit_forest" ? folder : "quaternius_megakit") / (name + ".gltf");
      const Model obj = load(entry.path()), gltf = load(other);
      EXPECT_EQ(broken_promise(obj), "") << name;
      EXPECT_EQ(obj.triangles.size(), faces_in(entry.path())) << name;
      EXPECT_EQ(obj.triangles.size(), gltf.triangles.size()) << name;
      EXPECT_NEAR(surface(obj), surface(gltf), 2e-3 * surface(gltf)) << name;
      const Measures a = measure(obj), b = measure(gltf);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a.least[axis], b.least[axis], 1e-3) << name;
        EXPECT_NEAR(a.greatest[axis], b.greatest[axis], 1e-3) << name;
      }
      ASSERT_EQ(obj.materials.size(), gltf.materials.size());
      for (std::size_t i = 0; i < obj.materials.size(); ++i) {
        EXPECT_EQ(obj.materials[i].name, gltf.materials[i].name);
        EXPECT_EQ(obj.materials[i].reflectance, gltf.materials[i].reflectance) << name;
        EXPECT_EQ(obj.materials[i].alpha_cutoff > 0, gltf.materials[i].alpha_cutoff > 0) << name;
        EXPECT_EQ(obj.textures[static_cast<std::size_t>(obj.materials[i].texture)].width,
                  gltf.textures[static_cast<std::size_t>(gltf.materials[i].texture)].width);
      }
      // Texture coordinates: the mean over the surface is the same point of the picture.
      const auto mean_uv = [](const Model& m) {
        V3d sum(0.0, 0.0, 0.0);
        for (std::size_t t = 0; t < m.triangles.size(); ++t) {
          for (const std::uint32_t corner : m.triangles[t])
            sum += V3d(m.uvs[corner].x, m.uvs[corner].y, 1) * area(m, t);
        }
        return sum / sum.z;
      };
      EXPECT_NEAR(mean_uv(obj).x, mean_uv(gltf).x, 2e-3) << name;
      EXPECT_NEAR(mean_uv(obj).y, mean_uv(gltf).y, 2e-3) << name;
      ++pairs;
    }
  }
  EXPECT_EQ(pairs, 8);
}

TEST(Models, AllFitTheirSpecies) {
  SILVA_NEEDS_SHARED();
  for (const Row& row : table()) {
    const Model m = fitted(load(shared() / row.file), {.height_m = 12, .radius_m = 2.5});
    EXPECT_EQ(broken_promise(m), "") << row.file;
    const Measures measures = measure(m);
    EXPECT_NEAR(measures.height_m, 12, 1e-3) << row.file;
    EXPECT_NEAR(measures.crown_radius_m, 2.5, 0.05) << row.file;
    EXPECT_LT(measures.least.z, 0.3) << row.file;
    EXPECT_NEAR(measures.foot_x_m, 0, 1e-4) << row.file;
  }
}

TEST(Models, LoadingTwiceGivesTheSame) {
  SILVA_NEEDS_SHARED();
  const fs::path file = shared() / "models/quaternius_megakit/CommonTree_1.gltf";
  const Model a = load(file, {.most_texture_px = 200}), b = load(file, {.most_texture_px = 200});
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.textures, b.textures);
  EXPECT_EQ(a.textures[0].width, 200);
}

}  // namespace
}  // namespace assets
