#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/unit/ghosttile/export/stand.h"

namespace ghosttile::exports {
namespace {

using nlohmann::json;

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

TEST(Gltf, SharesMeshesAmongNodes) {
  const fill::DetailsFile file = stand(31);
  const Folder folder;
  write_gltf(file, folder / "a.glb", with_crs("LOCAL_CS[\"here\"]"));
  const std::string bytes = text_of(folder / "a.glb");
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(u32(bytes, 4), 2u);
  EXPECT_EQ(u32(bytes, 8), bytes.size());
  const std::uint32_t json_size = u32(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_EQ(20 + json_size + 8 + u32(bytes, 20 + json_size), bytes.size());
  EXPECT_EQ(bytes.substr(24 + json_size, 4), std::string("BIN\0", 4));

  const json document = json::parse(bytes.substr(20, json_size));
  EXPECT_FALSE(document.contains("extensionsRequired"));
  EXPECT_EQ(document["asset"]["extras"]["crs"], "LOCAL_CS[\"here\"]");
  EXPECT_EQ(document["meshes"].size(), 4u);  // the straw stands nowhere
  EXPECT_EQ(document["images"].size(), 2u);
  const std::vector<Place> places = places_of(file);
  ASSERT_EQ(document["nodes"].size(), places.size() + 1);
  ASSERT_EQ(document["nodes"][0]["children"].size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(document["nodes"][0]["children"][i], i + 1);
    const json& node = document["nodes"][i + 1];
    const json& mesh = document["meshes"][node["mesh"].get<std::size_t>()];
    EXPECT_EQ(mesh["name"], places[i].object->name);
    double length = 0;
    for (const json& q : node["rotation"]) length += q.get<double>() * q.get<double>();
    EXPECT_NEAR(length, 1, 1e-6);
  }
  // What viewers allocate by.
  std::size_t end = 0;
  for (const json& view : document["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    EXPECT_GE(view["byteOffset"].get<std::size_t>(), end);
    end = view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>();
  }
  EXPECT_LE(end, document["buffers"][0]["byteLength"].get<std::size_t>());
  for (const json& accessor : document["accessors"]) {
    if (!accessor.contains("min")) continue;
    const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t start = 28 + json_size + view["byteOffset"].get<std::size_t>();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float least = INFINITY, most = -INFINITY;
      for (std::size_t i = 0; i < accessor["count"].get<std::size_t>(); ++i) {
        float value = 0;
        std::memcpy(&value, bytes.data() + start + 12 * i + 4 * axis, 4);
        least = std::min(least, value);
        most = std::max(most, value);
      }
      EXPECT_EQ(accessor["min"][axis].get<float>(), least);
      EXPECT_EQ(accessor["max"][axis].get<float>(), most);
    }
  }
  bool cut_out = false;
  for (const json& material : document["materials"]) cut_out = cut_out || material.value("alphaMode", "") == "MASK";
  EXPECT_TRUE(cut_out);  // the leaf
}

}  // namespace
}  // namespace ghosttile::exports
