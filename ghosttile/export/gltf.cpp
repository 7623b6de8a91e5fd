// glTF 2.0 (Khronos), y up. A node an instance rather than EXT_mesh_gpu_instancing, which Blender 3.4 refuses.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "ghosttile/export/formats.h"
#include "ghosttile/export/gltf_models.h"
#include "ghosttile/export/survey.h"
#include "ghosttile/export/writer.h"
#include "silvasim/base/error.h"

namespace ghosttile::exports {

namespace {

void append(std::string& text, float number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

// The first node holds all others. As text at once: a tree of so many nodes would take ten times the memory.
std::string nodes_of(const fill::DetailsFile& file, const Survey& all, const WriteOptions& options) {
  std::string text = "[{\"name\":\"details\"";
  for (std::uint64_t i = 1; i <= all.instances; ++i) text += (i == 1 ? ",\"children\":[" : ",") + std::to_string(i);
  text += all.instances > 0 ? "]}" : "}";

  std::vector<std::string> heads(file.tile->objects.size());
  for (std::size_t k = 0; k < all.used.size(); ++k) {
    const std::string name = json_string(file.tile->objects[all.used[k]].name);
    heads[all.used[k]] = fmt::format(",{{\"mesh\":{},\"name\":{}", k, name.substr(0, name.size() - 1));
  }
  std::vector<std::uint64_t> count(heads.size(), 0);
  Passes(file, all, options.progress, 1).run([&](const fill::Instance& i) {
    const V3 at(i.at - all.origin);
    text += heads[i.object] + " " + std::to_string(++count[i.object]) + "\",\"translation\":[";
    const auto list = [&](std::initializer_list<float> numbers) {
      for (const float number : numbers) {
        append(text, number);
        text += ',';
      }
      text.back() = ']';
    };
    list({at.x, at.z, -at.y});
    text += ",\"rotation\":[";
    list({i.rotation.x, i.rotation.z, -i.rotation.y, i.rotation.w});
    text += ",\"scale\":[";
    list({i.scale, i.scale, i.scale});
    text += '}';
  });
  return text + "]";
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : letters[three >> (18 - 6 * k) & 63];
  }
  return text;
}

void write_binary(Writer& out, std::string json, const std::string& bytes) {
  json.append((4 - json.size() % 4) % 4, ' ');
  const std::uint64_t size = 20 + json.size() + (bytes.empty() ? 0 : 8 + bytes.size());
  if (size > 0xFFFFFFFFu) {
    throw silvasim::base::Error(
        fmt::format("the models and textures are {} bytes, and glTF holds at most 4294967295; usda holds more", size));
  }
  out << "glTF";
  out.put(std::uint32_t{2});
  out.put(static_cast<std::uint32_t>(size));
  out.put(static_cast<std::uint32_t>(json.size()));
  out << "JSON" << json;
  if (bytes.empty()) return;
  out.put(static_cast<std::uint32_t>(bytes.size()));
  out << std::string_view("BIN\0", 4) << bytes;
}

}  // namespace

void write_gltf(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options) {
  const Survey all = survey(file);
  if (all.instances > most_gltf_instances) {
    throw silvasim::base::Error(
        fmt::format("{} instances are too many for gltf (at most {}); usda and csv hold any number of instances",
                    all.instances, most_gltf_instances));
  }
  Writer out(path, options.inputs);
  GltfModels models;
  for (const std::size_t o : all.used) models.add(file.tile->objects[o]);

  nlohmann::ordered_json document = models.document();
  auto& extras = document["asset"]["extras"];
  extras["origin_m"] = {all.origin.x, all.origin.y, all.origin.z};
  extras["axes"] = "a point (x, y, z) is at origin_m + (x, -z, y) of the scene, whose axes are east, north, up";
  if (!options.crs_wkt.empty()) extras["crs"] = options.crs_wkt;

  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool as_text = extension == ".gltf";
  const std::string& bytes = models.bytes();
  if (!bytes.empty()) {
    document["buffers"][0]["byteLength"] = bytes.size();
    if (as_text) document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
  }
  std::string json = document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  json.back() = ',';  // the last brace comes after the nodes
  json += "\"nodes\":" + nodes_of(file, all, options) + "}";
  if (as_text) {
    out << json << '\n';
  } else {
    write_binary(out, std::move(json), bytes);
  }
  out.commit();
}

}  // namespace ghosttile::exports
