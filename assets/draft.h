// What the readers of the formats hand to finish.h: a model as its file has it, in the axes of model.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "assets/load.h"
#include "assets/model.h"
#include "assets/texture.h"

namespace assets {

// The file that is being read, and where its errors and warnings go.
struct Reading {
  std::filesystem::path file;
  LoadOptions options;
  LoadReport* report = nullptr;
  std::size_t warnings = 0;

  [[noreturn]] void fail(const std::string& what) const;                       // "file: what"
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;  // "file:line: what"
  void warn(const std::string& what);
  void check_triangles(std::size_t count) const;  // against the limit
};

enum class Alpha {
  opaque,      // a texture's alpha means nothing
  cut,         // below the cutoff there is nothing
  blend,       // taken as cut at 0.5
  by_texture,  // the file does not say (OBJ without map_d): cut at 0.5 where the picture has both
};

struct DraftMaterial {
  std::string name;
  Rgb colour{0.5f, 0.5f, 0.5f};
  float alpha = 1;  // factor to the texture's
  Alpha alpha_mode = Alpha::opaque;
  float cutoff = 0.5f;
  bool two_sided = true;
  Rgb transmission{0.0f, 0.0f, 0.0f};             // share of the light that passes, as the file says
  std::shared_ptr<const Picture> colour_picture;  // null: none, or none that may be read
  std::shared_ptr<const Picture> alpha_picture;   // OBJ's map_d; null: the colour picture's alpha
  bool picture_lost = false;                      // the file names a colour picture that could not be found
};

struct Draft {
  std::vector<V3> positions;
  std::vector<V3> normals;                 // as many; zero: none in the file
  std::vector<V2> uvs;                     // as many
  std::vector<std::uint32_t> smooth_with;  // as many: vertices of one number share a made normal
  std::vector<Rgb> colours;                // as many, linear; or empty
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_materials;
  std::vector<DraftMaterial> materials;  // may be empty: then a grey one is made
};

Draft read_obj(Reading& reading);
Draft read_gltf(Reading& reading);
Draft read_ply(Reading& reading);

// Turns y up into z up: a quarter turn about x, which keeps left and right.
inline V3 z_up_from_y_up(const V3& v) { return {v.x, -v.z, v.y}; }

}  // namespace assets
