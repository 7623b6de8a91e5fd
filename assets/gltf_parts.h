// The parts of a glTF file behind tinygltf, which checks its JSON but not how the numbers in it fit together.
// Only the sources of the glTF reader include this header: it brings tinygltf's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#ifndef TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#endif
#include <tiny_gltf.h>

#include "assets/draft.h"

namespace assets {

// Refuses JSON that is nested deeper than 64 or has more than 4 million values, before any parser sees it: parsers recurse,
// and spend 100 bytes and more on a value.
void check_json(const Reading& reading, const char* text, std::size_t size);

// The file, parsed, with its buffers; pictures are not read. Checks the extensions that it requires.
tinygltf::Model parse_gltf(Reading& reading);

// One accessor: a column of vectors or scalars, with its sparse replacements. All of it lies within its buffers.
class Column {
 public:
  // `what` names it in errors. `components` that are allowed, from least to most.
  Column(const Reading& reading, const tinygltf::Model& model, int accessor, const std::string& what,
         int least_components, int most_components);

  std::size_t size() const { return count_; }
  int components() const { return components_; }
  bool is_unsigned() const;  // u8, u16 or u32, and not normalised: fit for an index

  // Integers become [0,1] or [-1,1] where the accessor is normalised.
  float number(std::size_t i, int component) const;
  std::uint32_t index(std::size_t i) const;

 private:
  const unsigned char* element(std::size_t i) const;  // null: all zero

  std::size_t count_ = 0;
  int components_ = 0;
  int type_ = 0;
  std::size_t component_bytes_ = 0;
  bool normalised_ = false;
  const unsigned char* data_ = nullptr;
  std::size_t stride_ = 0;
  std::vector<std::uint32_t> sparse_;  // ascending
  const unsigned char* sparse_values_ = nullptr;
};

// What a material of the file becomes, and which texture coordinates it reads.
struct GltfMaterial {
  DraftMaterial draft;
  int uv_set = 0;
  double uv_offset[2] = {0, 0};  // KHR_texture_transform
  double uv_scale[2] = {1, 1};
  double uv_turn_rad = 0;
};

std::vector<GltfMaterial> gltf_materials(Reading& reading, const tinygltf::Model& model);

}  // namespace assets
