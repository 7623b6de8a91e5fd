// A small stand of details far from the scene's origin, and where its triangles must be by a second way.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "ghosttile/export/formats.h"
#include "ghosttile/objects/made/made.h"
#include "ghosttile/tile/frames.h"
#include "silvasim/base/file.h"
#include "silvasim/base/random.h"

namespace ghosttile::exports {

using assets::V2;
using assets::V3;
using assets::V3d;

// A tent with two materials that take turns and share vertices.
inline assets::Model tent() {
  assets::Model model;
  model.name = "tent";
  model.positions = {{-0.1f, -0.2f, 0}, {0.1f, -0.2f, 0}, {0.1f, 0.2f, 0}, {-0.1f, 0.2f, 0}, {0, 0, 0.3f}};
  for (const V3& p : model.positions) model.normals.push_back((p + V3(0, 0, 0.05f)).normalized());
  model.uvs.assign(5, V2(0, 0));
  model.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  model.triangle_materials = {0, 1, 0, 1};
  model.materials = {{"canvas \"east\"", {0.8f, 0.2f, 0.1f}}, {"canvas", {0.1f, 0.3f, 0.7f}}};
  return model;
}

inline objects::Detail detail_named(const std::string& name, assets::Model model) {
  objects::Detail detail;
  detail.name = name;
  detail.model = std::move(model);
  detail.spheres = {{{0, 0, 0}, 0.05f}};
  detail.anchors = {{0, 0, 0}};
  return detail;
}

inline assets::Model made(const std::string& form) {
  objects::made::MadeOptions options;
  options.form = form;
  return objects::made::make(options);
}

// Objects 0 to 3 stand, 4 does not. The tile at (x, y, z) is in the middle.
inline fill::DetailsFile stand(std::uint64_t seed, int x = 636'000, int y = 7'543'210, int z = 1720) {
  auto tile = std::make_shared<tile::GhostTile>();
  tile->side_m = 0.7f;
  static const std::vector<objects::Detail> objects{
      detail_named("oak leaf", made("oak-leaf")), detail_named("tents, \"two\"", tent()),
      detail_named("toadstool", made("toadstool")), detail_named("toadstool", tent()),
      detail_named("straw", made("straw"))};
  tile->objects = objects;
  tile::Spread spread;
  spread.least_scale = 0.5f;
  spread.most_scale = 1.7f;
  for (std::uint32_t c = 0; c < 40; ++c)
    tile->candidates.push_back(
        tile::random_frame(seed, static_cast<std::uint16_t>(c % 5), c / 5, spread, tile->side_m));
  fill::DetailsFile file;
  file.tile = tile;
  file.scene = "a \"scene\".xml";
  file.filled = {x - 2, y - 2, z - 1, x + 3, y + 3, z + 2};
  silvasim::base::Stream stream(seed, silvasim::base::Purpose::picture);
  for (int row = -2; row <= 2; ++row) {
    for (int column = -2; column <= 2; column += 2) {
      fill::Details& d = file.details;
      d.tiles.push_back({x + column, y + row, z + (row + column) % 2});
      d.first.push_back(static_cast<std::uint32_t>(d.chosen.size()));
      std::uint16_t instances = 0;
      for (std::uint16_t c = 0; c < 40; ++c) {
        if (c % 5 == 4 || stream.next_float() > 0.2f) continue;
        d.chosen.push_back(c);
        ++instances;
      }
      d.instances.push_back(instances);
      d.chosen.push_back(39);  // refused
    }
  }
  file.details.first.push_back(static_cast<std::uint32_t>(file.details.chosen.size()));
  return file;
}

inline fill::DetailsFile empty_stand() {
  fill::DetailsFile file = stand(1);
  file.details = {{}, {0}, {}, {}};
  return file;
}

struct Place {
  fill::TilePlace tile;
  std::uint16_t candidate = 0;
  const tile::Candidate* frame = nullptr;
  const objects::Detail* object = nullptr;
  V3d at{0, 0, 0};
};

inline std::vector<Place> places_of(const fill::DetailsFile& file) {
  std::vector<Place> all;
  const fill::Details& d = file.details;
  const auto side = static_cast<double>(file.tile->side_m);
  for (std::size_t t = 0; t < d.tiles.size(); ++t) {
    for (std::size_t k = d.first[t]; k < d.first[t] + d.instances[t]; ++k) {
      const tile::Candidate& c = file.tile->candidates[d.chosen[k]];
      const V3d corner(d.tiles[t].x * side, d.tiles[t].y * side, d.tiles[t].z * side);
      all.push_back({d.tiles[t], d.chosen[k], &c, &file.tile->objects[c.object], corner + V3d(c.at)});
    }
  }
  return all;
}

// By the rotation's matrix, in doubles.
inline V3d turned(const tile::Rotation& r, const V3& v) {
  const double w = double{r.w}, x = double{r.x}, y = double{r.y}, z = double{r.z};
  const V3d u(v);
  return {(1 - 2 * (y * y + z * z)) * u.x + 2 * (x * y - w * z) * u.y + 2 * (x * z + w * y) * u.z,
          2 * (x * y + w * z) * u.x + (1 - 2 * (x * x + z * z)) * u.y + 2 * (y * z - w * x) * u.z,
          2 * (x * z - w * y) * u.x + 2 * (y * z + w * x) * u.y + (1 - 2 * (x * x + y * y)) * u.z};
}

struct Triangle {
  std::array<V3d, 3> corners;  // scene
  std::array<V3d, 3> normals;
  std::array<V2, 3> uvs;
  const assets::Model* model = nullptr;
  const assets::Material* material = nullptr;
};

// Instance by instance; within one in the model's order, or material by material.
inline std::vector<Triangle> triangles_of(const fill::DetailsFile& file, bool by_material) {
  std::vector<Triangle> all;
  for (const Place& place : places_of(file)) {
    const assets::Model& model = place.object->model;
    std::vector<std::size_t> order(model.triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    if (by_material) {
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return model.triangle_materials[a] < model.triangle_materials[b];
      });
    }
    for (const std::size_t t : order) {
      Triangle& triangle = all.emplace_back();
      triangle.model = &model;
      triangle.material = &model.materials[model.triangle_materials[t]];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = model.triangles[t][k];
        triangle.corners[k] =
            place.at + turned(place.frame->rotation, model.positions[v]) * static_cast<double>(place.frame->scale);
        triangle.normals[k] = turned(place.frame->rotation, model.normals[v]);
        triangle.uvs[k] = model.uvs[v];
      }
    }
  }
  return all;
}

class Folder {
 public:
  Folder() {
    static int serial = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("ghosttile-export-" + std::to_string(getpid()) + "-" + std::to_string(serial++));
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& path) { return silvasim::base::read_file(path, 1u << 30); }

// Alike but for the colours of texels that cannot be seen, into which readers let the others bleed.
inline bool same_picture(const assets::Texture& a, const assets::Texture& b) {
  if (a.width != b.width || a.height != b.height) return false;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    if (a.rgba[i + 3] != b.rgba[i + 3]) return false;
    if (a.rgba[i + 3] > 0 && !std::equal(&a.rgba[i], &a.rgba[i] + 3, &b.rgba[i])) return false;
  }
  return true;
}

inline WriteOptions with_crs(const std::string& wkt) {
  WriteOptions options;
  options.crs_wkt = wkt;
  return options;
}

// The three numbers after a word.
inline V3d numbers_after(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  if (at == std::string::npos) throw std::runtime_error("no " + word);
  const char* next = text.c_str() + at + word.size();
  V3d result;
  for (int axis = 0; axis < 3; ++axis) {
    while (*next != '\0' && (*next == ' ' || *next == ',' || *next == '(' || *next == '=' || *next == '[')) ++next;
    char* end = nullptr;
    result[axis] = std::strtod(next, &end);
    next = end;
  }
  return result;
}

}  // namespace ghosttile::exports
