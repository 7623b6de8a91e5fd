// obj, ply and glTF as the project's own readers see them: triangle by triangle where the frames put them.
#include <cmath>
#include <cstring>
#include <set>

#include "assets/load.h"
#include "tests/unit/ghosttile/export/stand.h"

namespace ghosttile::exports {
namespace {

// What floats within a hundred metres of the origin can hold, and some roundings on the way.
constexpr double tolerance_m = 3e-5;

// "origin_m 1 2 3" or "origin_m":[1.0,2.0,3.0]
V3d origin_of(const std::filesystem::path& path) {
  const std::string text = text_of(path);
  return numbers_after(text, text.find("origin_m\":") == std::string::npos ? "origin_m " : "origin_m\":");
}

void expect_at(const assets::Model& model, const std::vector<Triangle>& due, const V3d& origin) {
  ASSERT_EQ(model.triangles.size(), due.size());
  double worst_m = 0, worst_normal = 0;
  for (std::size_t t = 0; t < due.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = model.triangles[t][k];
      worst_m = std::max(worst_m, (V3d(model.positions[v]) + origin - due[t].corners[k]).length());
      worst_normal = std::max(worst_normal, (V3d(model.normals[v]) - due[t].normals[k]).length());
    }
  }
  EXPECT_LT(worst_m, tolerance_m);
  EXPECT_LT(worst_normal, 1e-5);
}

void expect_looks(const assets::Model& model, const std::vector<Triangle>& due) {
  std::set<std::pair<const assets::Texture*, const assets::Texture*>> compared;
  for (std::size_t t = 0; t < due.size(); ++t) {
    const assets::Material& material = model.materials[model.triangle_materials[t]];
    const assets::Material& wanted = *due[t].material;
    ASSERT_EQ(material.texture == assets::no_texture, wanted.texture == assets::no_texture) << wanted.name;
    // Leaves get their transmittance by the reader's guess; what is seen from the front stays.
    const assets::Rgb off = material.reflectance - wanted.reflectance;
    ASSERT_LT(std::abs(off.x) + std::abs(off.y) + std::abs(off.z), 1e-5f) << wanted.name;
    if (wanted.texture == assets::no_texture) continue;
    ASSERT_EQ(material.alpha_cutoff > 0, wanted.alpha_cutoff > 0);
    const assets::Texture& a = model.textures[static_cast<std::size_t>(material.texture)];
    const assets::Texture& b = due[t].model->textures[static_cast<std::size_t>(wanted.texture)];
    if (compared.insert({&a, &b}).second) {
      ASSERT_TRUE(same_picture(a, b)) << wanted.name;
    }
    for (std::size_t k = 0; k < 3; ++k) ASSERT_LT((model.uvs[model.triangles[t][k]] - due[t].uvs[k]).length(), 1e-6f);
  }
}

assets::Model loaded(const std::filesystem::path& path) {
  assets::LoadReport report;
  assets::Model model = assets::load(path, {}, &report);
  for (const std::string& warning : report.warnings) ADD_FAILURE() << warning;
  return model;
}

class Expanded : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Expanded, testing::Values("obj", "glb", "gltf", "ply"));

TEST_P(Expanded, StandsWhereTheFramesPutIt) {
  const std::string extension = GetParam();
  for (const std::uint64_t seed : {11u, 12u}) {
    SCOPED_TRACE(seed);
    const fill::DetailsFile file = stand(seed);
    const Folder folder;
    const auto path = folder / ("my stand." + extension);
    format_for("", path).write(file, path, {});
    const assets::Model model = loaded(path);
    const std::vector<Triangle> due = triangles_of(file, extension != "ply");
    const V3d origin = origin_of(path);
    EXPECT_EQ(origin, V3d(445'200, 5'280'200, 1200));
    expect_at(model, due, origin);
    if (extension != "ply") expect_looks(model, due);
  }
}

TEST_P(Expanded, GivesTheSameBytesAgain) {
  const std::string extension = GetParam();
  const Folder folder;
  for (const char* name : {"a", "b"}) {
    const auto path = folder / (name + ("." + extension));
    format_for("", path).write(stand(5), path, {});
  }
  std::string a = text_of(folder / ("a." + extension)), b = text_of(folder / ("b." + extension));
  if (extension == "obj") a.replace(a.find("mtllib a"), 8, "mtllib b");
  EXPECT_TRUE(a == b);
}

// Coordinates near 0 are left as they are.
TEST(Obj, NamesItsMaterialsAndKeepsNearCoordinates) {
  const Folder folder;
  write_obj(stand(3, 1, 2, 0), folder / "near.obj", with_crs("LOCAL_CS[\"here\"]"));
  const std::string text = text_of(folder / "near.obj");
  EXPECT_EQ(numbers_after(text, "origin_m "), V3d(0, 0, 0));
  EXPECT_NE(text.find("# crs LOCAL_CS[\"here\"]\n"), std::string::npos);
  const std::vector<std::string> names = folder.names();
  EXPECT_EQ(names.size(), 4u) << testing::PrintToString(names);  // leaf and toadstool have a texture each
  const std::string library = text_of(folder / "near.mtl");
  for (std::size_t at = text.find("usemtl "); at != std::string::npos; at = text.find("usemtl ", at + 1)) {
    const std::string name = text.substr(at + 7, text.find('\n', at) - at - 7);
    ASSERT_NE(library.find("newmtl " + name + "\n"), std::string::npos) << name;
  }
  for (const char* name : {"canvas__east_", "canvas", "canvas__east__2", "canvas_2"})
    EXPECT_NE(library.find(std::string("newmtl ") + name + "\n"), std::string::npos) << name;
  // The leaf alone is cut out.
  const std::size_t cut = library.find("map_d near-leaf.png\n");
  ASSERT_NE(cut, std::string::npos) << library;
  EXPECT_EQ(cut, library.find("map_d ")) << library;
  EXPECT_EQ(library.find("map_d ", cut + 1), std::string::npos) << library;
  // An object an instance, each with a name of its own.
  std::set<std::string> objects;
  for (std::size_t at = text.find("\no "); at != std::string::npos; at = text.find("\no ", at + 1))
    EXPECT_TRUE(objects.insert(text.substr(at + 3, text.find('\n', at + 1) - at - 3)).second);
  EXPECT_EQ(objects.size(), stand(3).details.count());
}

// sRGB (IEC 61966-2-1), by the C library.
double encoded(double light) { return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055; }

using Bytes = std::array<int, 3>;

// Colours of all corners, triangle by triangle.
std::vector<Bytes> colours_of(const fill::DetailsFile& file) {
  const Folder folder;
  write_ply(file, folder / "a.ply", {});
  const std::string text = text_of(folder / "a.ply");
  const std::size_t begin = text.find("end_header\n") + 11;
  const std::size_t vertices = std::strtoul(text.c_str() + text.find("element vertex ") + 15, nullptr, 10);
  const std::size_t faces = std::strtoul(text.c_str() + text.find("element face ") + 13, nullptr, 10);
  EXPECT_EQ(text.size(), begin + 27 * vertices + 13 * faces);
  std::vector<Bytes> colours;
  for (std::size_t corner = 0; corner < 3 * faces; ++corner) {
    std::uint32_t v = 0;
    std::memcpy(&v, text.data() + begin + 27 * vertices + 13 * (corner / 3) + 1 + 4 * (corner % 3), 4);
    if (v >= vertices) throw std::runtime_error("a corner without a vertex");
    const auto byte = [&](std::size_t c) { return int{static_cast<unsigned char>(text[begin + 27 * v + 24 + c])}; };
    colours.push_back({byte(0), byte(1), byte(2)});
  }
  return colours;
}

TEST(Ply, PaintsPlainMaterialsInTheirReflectance) {
  const fill::DetailsFile file = stand(21);
  const std::vector<Bytes> colours = colours_of(file);
  const std::vector<Triangle> due = triangles_of(file, false);
  ASSERT_EQ(colours.size(), 3 * due.size());
  std::size_t plain = 0;
  for (std::size_t corner = 0; corner < colours.size(); ++corner) {
    const assets::Material& material = *due[corner / 3].material;
    if (material.texture != assets::no_texture) continue;
    ++plain;
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(colours[corner][c], 255 * encoded(double{material.reflectance[static_cast<int>(c)]}), 0.51);
  }
  EXPECT_GT(plain, 20u);
}

// A strip over a picture that is red in the west and blue in the east, with a hole of green between: the hole lends nothing.
TEST(Ply, PaintsVerticesByTheTextureAroundThem) {
  assets::Texture texture;
  texture.width = 60;
  texture.height = 2;
  texture.has_alpha = true;
  for (int i = 0; i < 120; ++i) {
    const int x = i % 60;
    const std::array<std::uint8_t, 4> red{200, 0, 0, 255}, green{0, 250, 0, 127}, blue{0, 0, 100, 128};
    const auto& rgba = x < 18 ? red : x < 42 ? green : blue;
    texture.rgba.insert(texture.rgba.end(), rgba.begin(), rgba.end());
  }
  assets::Model strip;
  for (const float x : {0.0f, 0.5f, 1.0f})
    for (const float y : {0.0f, 1.0f}) {
      strip.positions.emplace_back(x, y, 0.0f);
      strip.normals.emplace_back(0.0f, 0.0f, 1.0f);
      strip.uvs.emplace_back(x + 3 - x * 1e-4f, y - 2);  // pictures repeat
    }
  strip.triangles = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}};
  strip.triangle_materials = {0, 0, 0, 0};
  strip.textures = {texture};
  strip.materials = {{"picture", {1, 1, 0.5f}, {0, 0, 0}, 0, 0.5f}};
  fill::DetailsFile file = stand(1, 0, 0, 0);
  auto tile = std::make_shared<tile::GhostTile>();
  tile->objects = {detail_named("strip", strip)};
  tile->candidates.resize(1);
  file.tile = tile;
  file.details = {{{0, 0, 0}}, {0, 1}, {0}, {1}};

  const std::vector<Bytes> colours = colours_of(file);
  const int half_blue =
      static_cast<int>(std::lround(255 * encoded(0.5 * std::pow((100 / 255.0 + 0.055) / 1.055, 2.4))));
  for (std::size_t corner = 0; corner < colours.size(); ++corner) {
    const float x = strip.positions[strip.triangles[corner / 3][corner % 3]].x;
    if (x == 0) {
      EXPECT_EQ(colours[corner], (Bytes{200, 0, 0}));
    } else if (x == 1) {
      EXPECT_EQ(colours[corner], (Bytes{0, 0, half_blue}));
    }
    EXPECT_EQ(colours[corner][1], 0);
  }
  // Nothing seen at all around a vertex: the mean of what is seen elsewhere.
  for (V2& uv : strip.uvs) uv = V2(0.5f, 0.5f);
  tile->objects = {detail_named("strip", strip)};
  for (const Bytes& colour : colours_of(file)) {
    EXPECT_NEAR(colour[0], 255 * encoded(0.5 * std::pow((200 / 255.0 + 0.055) / 1.055, 2.4)), 0.51);
    EXPECT_EQ(colour[1], 0);
  }
}

}  // namespace
}  // namespace ghosttile::exports
