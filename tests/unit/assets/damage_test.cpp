// Damaged and hostile files: a clear error or a sensible model, and nothing else.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <functional>

#include "assets/texture.h"
#include "files.h"
#include "made_glb.h"
#include "pictures.h"
#include "silvasim/base/random.h"

namespace assets {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr std::uint32_t flips = 2000;

// Every truncation of the file, then copies with one to four bytes changed.
void expect_to_survive_damage(const Folder& folder, const std::string& name, const std::string& bytes,
                              const std::function<void(const fs::path&, const std::string&)>& try_one = expect_survival,
                              std::uint32_t rounds = flips) {
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    try_one(folder.write(name, bytes.substr(0, length)), name + " cut at " + std::to_string(length));
    if (testing::Test::HasFatalFailure()) return;
  }
  for (std::uint32_t round = 0; round < rounds; ++round) {
    silvasim::base::Stream stream(20261122, silvasim::base::Purpose::selection, round);
    std::string damaged = bytes;
    const std::uint32_t count = 1 + stream.next_below(4);
    for (std::uint32_t i = 0; i < count; ++i) {
      damaged[stream.next_below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(stream.next_below(256));
    }
    try_one(folder.write(name, damaged), name + " with flips " + std::to_string(round));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Damage, Obj) {
  const Folder folder;
  folder.write("a.mtl", "newmtl leaf\nKd .1 .3 .1\nmap_Kd t.png\nmap_d t.png\nnewmtl bark\nKd .3 .2 .1\n");
  write_picture(folder.path() / "t.png", 4, 4, 4, [](int x, int) {
    return Pixel{9, 99, 9, static_cast<std::uint8_t>(x * 80)};
  });
  expect_to_survive_damage(
      folder, "a.obj",
      "mtllib a.mtl\ns 1\nv 0 0 0\nv 1 0 0.5\nv 1 1 0 1 0 0\nv 0 1.5e0 0\nvt 0 0\nvt 1 0\nvn 0 0 1\n"
      "usemtl leaf\nf 1/1/1 2/2/1 3/1/1 4//1\ns off\nusemtl bark\nf -4 -3 \\\n-2\nf 1 2 3 4 1 2\n");
}

TEST(Damage, Mtl) {
  const Folder folder;
  const fs::path model =
      folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl leaf\nf 1/1 2/1 3/1\n");
  write_picture(folder.path() / "t.png", 4, 4, 4, [](int x, int) {
    return Pixel{9, 99, 9, static_cast<std::uint8_t>(x * 80)};
  });
  expect_to_survive_damage(folder, "a.mtl",
                           "newmtl leaf\nKd .1 .3 .1\nTf 1 1 1\nd 0.5\nTr 0.5\nillum 4\nmap_Kd -s 1 1 1 -o 0 0 0 "
                           "t.png\nmap_d -clamp on t.png\n"
                           "newmtl bark\nKd .3 .2 .1\nPr 0.5\n",
                           [&](const fs::path&, const std::string& what) { expect_survival(model, what); });
}

// A GLB with all that the reader knows: nodes, strips, sparse columns, colours, a cut-out picture.
std::string rich_glb(const Folder& folder) {
  MadeGlb made;
  const int p = made.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f});
  const int which = made.view(std::vector<std::uint16_t>{3}), values = made.view(std::vector<float>{1, 1, 1});
  made.json["accessors"][static_cast<std::size_t>(p)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", which}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}}}};
  const int n = made.accessor(made.view(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
  const int t = made.accessor(made.view(std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}), 5126, "VEC2", 4);
  const int c = made.accessor(
      made.view(std::vector<std::uint8_t>{255, 0, 0, 9, 255, 0, 0, 9, 255, 0, 0, 9, 0, 0, 255, 9}), 5121, "VEC4", 4);
  made.json["accessors"][static_cast<std::size_t>(c)]["normalized"] = true;
  const int strip = made.accessor(made.view(std::vector<std::uint8_t>{0, 1, 2, 3}), 5121, "SCALAR", 4);
  const int mesh = made.mesh({{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}, {"COLOR_0", c}}},
                              {"indices", strip},
                              {"mode", 5},
                              {"material", 0}});
  write_picture(folder.path() / "embedded.png", 4, 4, 4, [](int x, int) {
    return Pixel{9, 99, 9, static_cast<std::uint8_t>(x * 80)};
  });
  const std::string png = read(folder.path() / "embedded.png");
  made.json["images"] = nlohmann::json::array(
      {{{"bufferView", made.view(std::vector<char>(png.begin(), png.end()))}, {"mimeType", "image/png"}}});
  made.json["textures"] = nlohmann::json::array({{{"source", 0}}});
  made.json["materials"] = nlohmann::json::array(
      {{{"name", "leaf"},
        {"alphaMode", "MASK"},
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"baseColorTexture",
           {{"index", 0},
            {"extensions",
             {{"KHR_texture_transform", {{"offset", {0.1, 0.2}}, {"scale", {2, 2}}, {"rotation", 1}}}}}}}}}}});
  const int child = made.node({{"mesh", mesh}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, -1, 1}}});
  made.scene({made.node({{"children", {child}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}})});
  return made.glb();
}

TEST(Damage, Glb) {
  const Folder folder;
  const std::string bytes = rich_glb(folder);
  const Model whole = load(folder.write("a.glb", bytes));
  ASSERT_EQ(broken_promise(whole), "");
  ASSERT_EQ(whole.triangles.size(), 2u);
  ASSERT_EQ(whole.textures.size(), 1u);
  ASSERT_EQ(whole.materials.size(), 2u);  // of two colours of vertices
  expect_to_survive_damage(folder, "a.glb", bytes);
}

TEST(Damage, Ply) {
  const Folder folder;
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment TextureFile t.png\nelement vertex 4\nproperty float x\nproperty "
      "float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n";
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (int i = 0; i < 4; ++i) {
    put(static_cast<float>(i % 2)), put(static_cast<float>(i / 2)), put(0.5f * static_cast<float>(i));
    put(std::uint8_t{90}), put(std::uint8_t{99}), put(static_cast<std::uint8_t>(40 * i));
  }
  put(std::uint8_t{3}), put(0), put(1), put(2);
  put(std::uint8_t{4}), put(0), put(1), put(3), put(2);
  ASSERT_EQ(broken_promise(load(folder.write("a.ply", bytes))), "");
  expect_to_survive_damage(folder, "a.ply", bytes);
}

TEST(Damage, PlyText) {
  const Folder folder;
  expect_to_survive_damage(folder, "a.ply",
                           "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
                           "float z\nproperty float s\n"
                           "property float t\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
                           "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0.25 0 1\n3 0 1 2\n4 0 1 2 3\n");
}

TEST(Damage, Pictures) {
  const Folder folder;
  for (const char* name : {"a.png", "a.jpg", "a.tga", "a.bmp", "a.tif"}) {
    const int channels = std::string(name) == "a.jpg" || std::string(name) == "a.bmp" ? 3 : 4;
    write_picture(folder.path() / name, 12, 7, channels, [](int x, int y) {
      return Pixel{static_cast<std::uint8_t>(20 * x), static_cast<std::uint8_t>(30 * y), 9,
                   static_cast<std::uint8_t>(x * 20)};
    });
    const std::string bytes = read(folder.path() / name);
    expect_to_survive_damage(
        folder, name, bytes,
        [](const fs::path& file, const std::string& what) {
          std::vector<std::byte> memory;
          for (const char c : read(file)) memory.push_back(static_cast<std::byte>(c));
          for (const Picture& picture :
               {Picture{file.filename().string(), file, {}}, Picture{file.filename().string(), {}, memory}}) {
            try {
              const Texture t = load_texture(picture, nullptr, {.most_px = 8, .alpha_cutoff = 0.5f});
              ASSERT_LE(t.width, 8) << what;
              ASSERT_EQ(t.rgba.size(), 4 * static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height))
                  << what;
            } catch (const silvasim::base::Error& error) {
              ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << what;
            }
          }
        },
        400);
  }
}

TEST(Damage, CollectedFiles) {
  const fs::path folder = shared() / "malformed/models";
  if (!fs::exists(folder)) GTEST_SKIP() << "the shared data are not here: " << folder;
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".bin" || extension == ".mtl") continue;
    expect_survival(entry.path(), entry.path().string());
    ++count;
  }
  EXPECT_GE(count, 14);
  const auto error = [&](const char* name) { return error_of(folder / name); };
  EXPECT_THAT(error("malformed.obj"), HasSubstr("malformed.obj:23: a face uses vertex 12"));
  EXPECT_THAT(error("empty.obj"), HasSubstr("no faces"));
  EXPECT_THAT(error("IndexOutOfRange.gltf"), HasSubstr("uses vertex"));
  EXPECT_THAT(error("RecursiveNodes.gltf"), HasSubstr("ancestor"));
  EXPECT_THAT(error("requires_draco_and_webp.glb"), HasSubstr("KHR_draco_mesh_compression"));
  EXPECT_THAT(error("crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply"), HasSubstr(":7: "));
  EXPECT_NE(error("badArray.gltf"), "");
  EXPECT_NE(error("badNumber.gltf"), "");
  // A box with normals of zero length, a concave polygon (by the trapezium rule its area is known), cubes.
  EXPECT_EQ(load(folder / "BoxBadNormals.glb").triangles.size(), 12u);
  EXPECT_NEAR(surface(load(folder / "BoxBadNormals.glb")), 6, 1e-5);
  EXPECT_NEAR(surface(load(folder / "cube_binary.ply")), 6, 1e-5);
  EXPECT_NEAR(surface(load(folder / "cube_uv.ply")), 24, 1e-5);
  EXPECT_THAT(error("number_formats.obj"), HasSubstr("area"));  // its one face has three corners on a line
}

TEST(Damage, TheConcavePolygonCoversWhatItsOutlineDoes) {
  const fs::path file = shared() / "malformed/models/concave_polygon.obj";
  if (!fs::exists(file)) GTEST_SKIP() << "the shared data are not here: " << file;
  std::istringstream text(read(file));
  std::vector<std::array<double, 3>> points;
  double shoelace = 0;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      points.emplace_back();
      words >> points.back()[0] >> points.back()[1] >> points.back()[2];
    } else if (kind == "f") {
      std::vector<std::size_t> face;
      for (std::string corner; words >> corner;) face.push_back(std::stoul(corner) - 1);
      for (std::size_t i = 0; i < face.size(); ++i) {
        const auto &a = points[face[i]], &b = points[face[(i + 1) % face.size()]];
        shoelace += 0.5 * (a[1] * b[2] - b[1] * a[2]);  // it lies in a plane of constant x
      }
    }
  }
  EXPECT_NEAR(surface(load(file)), std::abs(shoelace), 1e-4);
}

TEST(Damage, WhatIsNoFileIsAnError) {
  const Folder folder;
  EXPECT_NE(error_of(folder.path() / "none.obj"), "");
  fs::create_directory(folder.path() / "folder.obj");
  EXPECT_NE(error_of(folder.path() / "folder.obj"), "");
  EXPECT_THAT(error_of(folder.write("a.fbx", "x")), HasSubstr(".glb"));
  ASSERT_EQ(mkfifo((folder.path() / "pipe.obj").c_str(), 0600), 0);
  EXPECT_THAT(error_of(folder.path() / "pipe.obj"), HasSubstr("regular file"));
}

}  // namespace
}  // namespace assets
