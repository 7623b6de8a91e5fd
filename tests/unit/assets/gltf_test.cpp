#include <gmock/gmock.h>

#include <array>
#include <functional>
#include <numbers>

#include "assets/draft.h"
#include "files.h"
#include "made_glb.h"

namespace assets {
namespace {

using namespace test;
using testing::HasSubstr;

using Point = std::array<double, 3>;
using Triangle = std::array<Point, 3>;

double area_of(const Triangle& t) {
  const auto [a, b, c] = t;
  const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Point w{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  return 0.5 * std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
}

// Every triangle of `expected` (in the file's axes) must be in the model, turned to z up, each once.
void expect_triangles(const Model& model, std::vector<Triangle> expected) {
  ASSERT_EQ(broken_promise(model), "");
  ASSERT_EQ(model.triangles.size(), expected.size());
  const auto key = [](const Triangle& t) {
    std::vector<Point> corners(t.begin(), t.end());
    for (Point& p : corners) {
      for (double& x : p) x = std::round(x * 1e4) + 0.0;
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());  // keeps the sense
    return corners;
  };
  std::vector<std::vector<Point>> left, right;
  for (const Triangle& t : expected) {
    Triangle turned;
    for (std::size_t i = 0; i < 3; ++i) turned[i] = {t[i][0], -t[i][2], t[i][1]};
    left.push_back(key(turned));
  }
  for (const auto& t : model.triangles) {
    Triangle got;
    for (std::size_t i = 0; i < 3; ++i) {
      const V3& p = model.positions[t[i]];
      got[i] = {p.x, p.y, p.z};
    }
    right.push_back(key(got));
  }
  std::sort(left.begin(), left.end());
  std::sort(right.begin(), right.end());
  EXPECT_EQ(left, right);
}

Model made_model(const MadeGlb& made) {
  const Folder folder;
  return load(folder.write("made.glb", made.glb()));
}

TEST(Gltf, StripsFansAndAllIndexTypes) {
  const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};  // z order, as a strip
  const Triangle lower{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}},
      upper{Point{0, 1, 0}, Point{1, 0, 0}, Point{1, 1, 0}};
  struct Case {
    int mode;
    std::vector<std::uint32_t> indices;
  };
  for (const Case& c : {Case{5, {0, 1, 2, 3}}, Case{6, {1, 3, 2, 0}}, Case{4, {0, 1, 2, 2, 1, 3}}}) {
    for (const int type : {0, 5121, 5123, 5125}) {
      MadeGlb made;
      const int p = made.positions(square);
      int indices = -1;
      const std::vector<std::uint8_t> bytes(c.indices.begin(), c.indices.end());
      const std::vector<std::uint16_t> shorts(c.indices.begin(), c.indices.end());
      if (type == 5121) indices = made.view(bytes);
      if (type == 5123) indices = made.view(shorts);
      if (type == 5125) indices = made.view(c.indices);
      nlohmann::json primitive = {{"attributes", {{"POSITION", p}}}, {"mode", c.mode}};
      if (type != 0) primitive["indices"] = made.accessor(indices, type, "SCALAR", c.indices.size());
      if (type == 0 && c.mode != 5) continue;  // without indices only the strip's order is a square
      made.scene({made.node({{"mesh", made.mesh(primitive)}})});
      if (c.mode == 6) {
        expect_triangles(made_model(made), {Triangle{Point{1, 0, 0}, Point{1, 1, 0}, Point{0, 1, 0}},
                                            Triangle{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 0}}});
      } else {
        expect_triangles(made_model(made), {lower, upper});
      }
    }
  }
}

TEST(Gltf, NestedTransformsPlaceEachCornerAndMirrorsKeepTheOuterSide) {
  MadeGlb made;
  const std::vector<float> corner{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
  const int p = made.positions(corner);
  const int indices = made.accessor(made.view(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}), 5121, "SCALAR", 6);
  const int mesh = made.mesh({{"attributes", {{"POSITION", p}}}, {"indices", indices}});
  // Child: a quarter turn about z, scaled by (2, -1, 1), moved. Parent: a matrix of columns, shear and move.
  const double half = std::numbers::sqrt2 / 2;
  const int child = made.node(
      {{"mesh", mesh}, {"translation", {10, 20, 30}}, {"rotation", {0, 0, half, half}}, {"scale", {2, -1, 1}}});
  const int parent =
      made.node({{"children", {child}}, {"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 2, 0, -1, -2, -3, 1}}});
  made.scene({parent});

  const auto place = [](Point x) {
    x = {2 * x[0], -x[1], x[2]};                                  // scale
    x = {-x[1], x[0], x[2]};                                      // quarter turn about z
    x = {x[0] + 10, x[1] + 20, x[2] + 30};                        // move
    return Point{x[0] + 0.5 * x[1] - 1, x[1] - 2, 2 * x[2] - 3};  // the matrix, column by column
  };
  const Point a = place({0, 0, 0}), b = place({1, 0, 0}), c = place({0, 2, 0}), d = place({0, 0, 3});
  // The mirror (scale -1) turns the order around.
  const std::vector<Triangle> expected{Triangle{a, c, b}, Triangle{a, d, c}};
  const Model model = made_model(made);
  expect_triangles(model, expected);
  EXPECT_NEAR(surface(model), area_of(expected[0]) + area_of(expected[1]), 1e-4);
}

TEST(Gltf, InterleavedColumnsKeepNormalsAndTextureCoordinates) {
  MadeGlb made;
  // position, normal (tilted, not of unit length), uv: 32 bytes an element
  const int v = made.view(std::vector<float>{0, 0, 0, 0, 3, 4, 0.25f, 0.75f,  //
                                             1, 0, 0, 0, 3, 4, 0.5f,  0.75f,  //
                                             0, 1, 0, 0, 3, 4, 0.25f, 0.5f},
                          32);
  const int p = made.accessor(v, 5126, "VEC3", 3, 0), n = made.accessor(v, 5126, "VEC3", 3, 12),
            t = made.accessor(v, 5126, "VEC2", 3, 24);
  const std::string pixel("\x89PNG\r\n\x1A\n", 8);
  made.json["materials"] =
      nlohmann::json::array({{{"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}}}}});
  made.scene({made.node(
      {{"mesh", made.mesh({{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}}, {"material", 0}})},
       {"scale", {1, 1, 2}}})});
  const Model model = made_model(made);
  ASSERT_EQ(broken_promise(model), "");
  // The plane's normal under scale (1,1,2) goes by the inverse: (0, 3, 4/2); then y up becomes z up.
  const double length = std::sqrt(9.0 + 4.0);
  for (const V3& normal : model.normals) {
    EXPECT_NEAR(normal.x, 0, 1e-6);
    EXPECT_NEAR(normal.y, -2 / length, 1e-6);
    EXPECT_NEAR(normal.z, 3 / length, 1e-6);
  }
  EXPECT_EQ(model.materials[0].reflectance, Rgb(0.1f, 0.2f, 0.3f));
  for (const V2& uv : model.uvs) EXPECT_EQ(uv, V2(0.0f, 0.0f));  // no texture reads them
}

TEST(Gltf, SparseColumnsReplaceWhatTheySay) {
  for (const bool with_base : {false, true}) {
    MadeGlb made;
    const int base = with_base ? made.view(std::vector<float>{7, 7, 7, 1, 0, 0, 0, 1, 0}) : -1;
    const int p = made.accessor(base, 5126, "VEC3", 3);
    const std::vector<std::uint16_t> which =
        with_base ? std::vector<std::uint16_t>{0} : std::vector<std::uint16_t>{1, 2};
    const std::vector<float> values = with_base ? std::vector<float>{0, 0, 5} : std::vector<float>{1, 0, 0, 0, 1, 0};
    const int wv = made.view(which), vv = made.view(values);
    made.json["accessors"][static_cast<std::size_t>(p)]["sparse"] = {
        {"count", which.size()},
        {"indices", {{"bufferView", wv}, {"componentType", 5123}}},
        {"values", {{"bufferView", vv}}}};
    made.scene({made.node({{"mesh", made.mesh({{"attributes", {{"POSITION", p}}}})}})});
    expect_triangles(made_model(made), {Triangle{Point{0, 0, with_base ? 5.0 : 0.0}, Point{1, 0, 0}, Point{0, 1, 0}}});
  }
}

TEST(Gltf, QuantisedPositionsAreReadAsTheirNumbers) {
  MadeGlb made;
  const int v = made.view(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0}, 8);
  const int p = made.accessor(v, 5122, "VEC3", 3);
  made.json["accessors"][static_cast<std::size_t>(p)]["normalized"] = true;
  made.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  made.scene({made.node({{"mesh", made.mesh({{"attributes", {{"POSITION", p}}}})}})});
  expect_triangles(made_model(made), {Triangle{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, -1, 0}}});
}

TEST(Gltf, VertexColoursBecomeMaterials) {
  MadeGlb made;
  const int p = made.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0});
  const int c =
      made.accessor(made.view(std::vector<std::uint8_t>{255, 0,   0, 255, 255, 0,   0, 255, 255, 0,   0, 255,  //
                                                        0,   255, 0, 255, 0,   255, 0, 255, 0,   255, 0, 255}),
                    5121, "VEC4", 6);
  made.json["accessors"][static_cast<std::size_t>(c)]["normalized"] = true;
  made.scene({made.node({{"mesh", made.mesh({{"attributes", {{"POSITION", p}, {"COLOR_0", c}}}})}})});
  const Model model = made_model(made);
  ASSERT_EQ(model.triangles.size(), 2u);
  const Rgb red = model.materials[model.triangle_materials[0]].reflectance;
  const Rgb green = model.materials[model.triangle_materials[1]].reflectance;
  EXPECT_EQ(red, Rgb(0.5f, 0.0f, 0.0f));  // times the grey of a model without materials
  EXPECT_EQ(green, Rgb(0.0f, 0.5f, 0.0f));
}

TEST(Gltf, WhatABufferDoesNotHoldIsAnError) {
  const Folder folder;
  const auto error_with = [&](const std::function<void(nlohmann::json&)>& change) {
    MadeGlb made = one_triangle();
    change(made.json);
    return error_of(folder.write("bad.glb", made.glb()));
  };
  ASSERT_EQ(error_with([](nlohmann::json&) {}), "");
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["accessors"][0]["count"] = 4; }), HasSubstr("do not fit"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["accessors"][0]["count"] = 4000000000; }), HasSubstr("too many"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["accessors"][0]["byteOffset"] = 4; }), HasSubstr("do not fit"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["accessors"][0]["byteOffset"] = 18446744073709551612u; }),
              HasSubstr("do not fit"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["bufferViews"][0]["byteLength"] = 40; }),
              HasSubstr("beyond its buffer"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["bufferViews"][0]["byteOffset"] = 18446744073709551600u; }),
              HasSubstr("beyond its buffer"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["bufferViews"][0]["buffer"] = 1; }), HasSubstr("buffer 1 of 1"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["accessors"][0]["bufferView"] = 7; }), HasSubstr("view 7 of 1"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["accessors"][0]["type"] = "VEC2"; }), HasSubstr("components"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["nodes"][0]["mesh"] = 3; }), HasSubstr("no mesh 3"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["meshes"][0]["primitives"][0]["material"] = 3; }),
              HasSubstr("no material 3"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["nodes"][0]["children"] = {0}; }), HasSubstr("own ancestor"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["scenes"][0]["nodes"] = {0, 0}; }), HasSubstr("two parents"));
  EXPECT_THAT(error_with([](nlohmann::json& j) {
                j["nodes"][0]["rotation"] = {0, 0, 0, 0};
              }),
              HasSubstr("zero length"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["asset"]["version"] = "1.0"; }), HasSubstr("version"));
  EXPECT_THAT(error_with([](nlohmann::json& j) { j["extensionsRequired"] = {"EXT_meshopt_compression"}; }),
              HasSubstr("EXT_meshopt_compression"));
  const auto sparse = [](int count, std::uint64_t offset) {
    return nlohmann::json{{"count", count},
                          {"indices", {{"bufferView", 0}, {"componentType", 5125}, {"byteOffset", offset}}},
                          {"values", {{"bufferView", 0}}}};
  };
  EXPECT_THAT(error_with([&](nlohmann::json& j) { j["accessors"][0]["sparse"] = sparse(400, 0); }),
              HasSubstr("do not fit"));
  EXPECT_THAT(error_with([&](nlohmann::json& j) { j["accessors"][0]["sparse"] = sparse(1, 36); }),
              HasSubstr("do not fit"));
  EXPECT_THAT(error_with([&](nlohmann::json& j) { j["accessors"][0]["sparse"] = sparse(2, 0); }), HasSubstr("ascend"));
  EXPECT_THAT(error_with([&](nlohmann::json& j) { j["accessors"][0]["sparse"] = sparse(-1, 0); }),
              HasSubstr("negative"));
}

TEST(Gltf, NumbersThatAreNoneAreAnError) {
  const Folder folder;
  for (const float bad : {NAN, INFINITY, 1e30f}) {
    MadeGlb made;
    const int p = made.positions({0, 0, bad, 1, 0, 0, 0, 1, 0});
    made.scene({made.node({{"mesh", made.mesh({{"attributes", {{"POSITION", p}}}})}})});
    EXPECT_THAT(error_of(folder.write("bad.glb", made.glb())), HasSubstr("no number"));
  }
}

TEST(Gltf, DeepAndWideJsonIsRefusedBeforeItIsParsed) {
  const Folder folder;
  std::string deep =
      R"({"asset":{"version":"2.0"},"extras":)" + std::string(1 << 20, '[') + std::string(1 << 20, ']') + "}";
  EXPECT_THAT(error_of(folder.write("deep.gltf", deep)), HasSubstr("nested"));
  std::string wide = R"({"asset":{"version":"2.0"},"extras":[)";
  for (int i = 0; i < 5'000'000; ++i) wide += "0,";
  EXPECT_THAT(error_of(folder.write("wide.gltf", wide + "0]}")), HasSubstr("values"));
  // Nodes below each other are told from nested JSON.
  MadeGlb made = one_triangle();
  for (int i = 1; i <= 300; ++i) made.node({{"children", {i - 1}}});
  made.scene({300});
  EXPECT_THAT(error_of(folder.write("nodes.glb", made.glb())), HasSubstr("nested deeper than 256"));
}

TEST(Gltf, ManyPartsOfOneColumnCostOnlyWhatTheyUse) {
  MadeGlb made;
  std::vector<float> many(300'000, 0.0f);
  many[3 * 50'001] = 1;
  many[3 * 99'998 + 1] = 1;
  const int p = made.positions(many);
  const int indices = made.accessor(made.view(std::vector<std::uint32_t>{1, 50'001, 99'998}), 5125, "SCALAR", 3);
  nlohmann::json primitives = nlohmann::json::array();
  for (int i = 0; i < 20'000; ++i) primitives.push_back({{"attributes", {{"POSITION", p}}}, {"indices", indices}});
  made.json["meshes"].push_back({{"primitives", primitives}});
  made.scene({made.node({{"mesh", 0}})});
  EXPECT_EQ(made_model(made).positions.size(), 60'000u);
}

TEST(Gltf, BuffersMayOnlyLieInTheModelsFolder) {
  const Folder folder;
  const MadeGlb made = one_triangle();
  nlohmann::json json = made.json;
  folder.write("secret.bin", made.bytes);
  folder.write("model/own.bin", made.bytes);
  fs::create_symlink("../secret.bin", folder.path() / "model" / "link.bin");
  const auto error_with = [&](const std::string& uri) {
    json["buffers"] = nlohmann::json::array({{{"uri", uri}, {"byteLength", made.bytes.size()}}});
    return error_of(folder.write("model/m.gltf", json.dump()));
  };
  EXPECT_EQ(error_with("own.bin"), "");
  EXPECT_EQ(error_with("%6Fwn.bin"), "");
  for (const char* uri :
       {"../secret.bin", "%2E%2E/secret.bin", "..\\secret.bin", "link.bin", "file:///etc/passwd", "http://a/b"}) {
    EXPECT_NE(error_with(uri), "") << uri;
  }
  EXPECT_NE(error_with((folder.path() / "secret.bin").string()), "");
}

TEST(Gltf, PartsWithoutSceneAreReadAsTheyStand) {
  MadeGlb made = one_triangle();
  made.json.erase("scenes");
  made.json.erase("scene");
  EXPECT_EQ(made_model(made).triangles.size(), 1u);
  made.json.erase("nodes");
  EXPECT_EQ(made_model(made).triangles.size(), 1u);
}

}  // namespace
}  // namespace assets
