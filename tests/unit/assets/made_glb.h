// A glTF file put together in memory: bytes, views and accessors, one after another.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace assets::test {

struct MadeGlb {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                         {"bufferViews", nlohmann::json::array()},
                         {"accessors", nlohmann::json::array()},
                         {"meshes", nlohmann::json::array()},
                         {"nodes", nlohmann::json::array()}};
  std::string bytes;

  template <typename T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4 != 0) bytes += '\0';
    nlohmann::json v = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride > 0) v["byteStride"] = stride;
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json["bufferViews"].push_back(v);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  int accessor(int view, int component, const std::string& type, std::size_t count, std::size_t offset = 0) {
    nlohmann::json a = {{"componentType", component}, {"type", type}, {"count", count}};
    if (view >= 0) {
      a["bufferView"] = view;
      a["byteOffset"] = offset;
    }
    json["accessors"].push_back(a);
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int positions(const std::vector<float>& xyz) { return accessor(view(xyz), 5126, "VEC3", xyz.size() / 3); }

  int mesh(const nlohmann::json& primitive) {
    json["meshes"].push_back({{"primitives", nlohmann::json::array({primitive})}});
    return static_cast<int>(json["meshes"].size()) - 1;
  }

  int node(const nlohmann::json& node) {
    json["nodes"].push_back(node);
    return static_cast<int>(json["nodes"].size()) - 1;
  }

  void scene(const std::vector<int>& roots) {
    json["scenes"] = nlohmann::json::array({{{"nodes", roots}}});
    json["scene"] = 0;
  }

  std::string glb() const {
    nlohmann::json all = json;
    std::string bin = bytes;
    while (bin.size() % 4 != 0) bin += '\0';
    if (!bin.empty()) all["buffers"] = nlohmann::json::array({{{"byteLength", bin.size()}}});
    std::string text = all.dump();
    while (text.size() % 4 != 0) text += ' ';
    const auto u32 = [](std::size_t n) {
      const auto value = static_cast<std::uint32_t>(n);
      return std::string(reinterpret_cast<const char*>(&value), 4);
    };
    std::string chunks = u32(text.size()) + "JSON" + text;
    if (!bin.empty()) chunks += u32(bin.size()) + std::string("BIN\0", 4) + bin;
    return "glTF" + u32(2) + u32(12 + chunks.size()) + chunks;
  }
};

// One triangle of area 1/2 in a node, the least that is a model.
inline MadeGlb one_triangle() {
  MadeGlb made;
  const int p = made.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  made.scene({made.node({{"mesh", made.mesh({{"attributes", {{"POSITION", p}}}})}})});
  return made;
}

}  // namespace assets::test
