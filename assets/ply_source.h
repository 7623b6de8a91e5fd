// A PLY file's header, and its numbers one after another, whichever way they are written.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "assets/draft.h"

namespace assets {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

// The greatest value of an unsigned integer, which stands for a full colour; 0 of all others.
double ply_greatest(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  bool is_list = false;
  PlyType count_type = PlyType::u8;  // of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

// Errors: base::Error with the line (in the header and in text files) or the byte.
class PlySource {
 public:
  PlySource(const Reading& reading, std::string bytes) : reading_(reading), bytes_(std::move(bytes)) {}

  // Refuses counts that the file is too short for, so that a reader may reserve room for them.
  std::vector<PlyElement> read_header();

  // Of "comment TextureFile name", as MeshLab writes it; empty: none.
  const std::string& texture_file() const { return texture_file_; }

  double number(PlyType type);

 private:
  enum class Format { text, little, big };

  [[noreturn]] void fail(const std::string& what) const;
  std::string header_line();
  double text_number(PlyType type);

  const Reading& reading_;
  std::string bytes_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  Format format_ = Format::text;
  bool in_header_ = true;
  std::string texture_file_;
};

}  // namespace assets
