// Models as meshes, materials and textures of a glTF document, and the bytes that they refer to.
// Only the sources of the glTF writer include this header: it brings the JSON library's.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ghosttile/objects/detail.h"

namespace ghosttile::exports {

class GltfModels {
 public:
  GltfModels();

  // The next mesh.
  void add(const objects::Detail& object);

  // All but nodes and the buffer's size. The scene shows node 0.
  const nlohmann::ordered_json& document() const { return document_; }
  const std::string& bytes() const { return bytes_; }

 private:
  // Appends bytes as a new buffer view, and returns its number. `target`: 0: none.
  std::size_t view(const void* data, std::size_t size, int target);
  std::size_t accessor(const void* data, std::size_t size, int target, const nlohmann::ordered_json& what);
  std::size_t add_material(const assets::Material& material, std::size_t first_texture);

  nlohmann::ordered_json document_;
  std::string bytes_;
};

// Quoted and escaped; what is no UTF-8 is replaced.
std::string json_string(const std::string& text);

}  // namespace ghosttile::exports
