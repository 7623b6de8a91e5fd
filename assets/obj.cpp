// Wavefront OBJ and MTL, by tinyobjloader.
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <map>
#include <sstream>
#include <unordered_map>

#include "assets/beneath.h"
#include "assets/draft.h"
#include "assets/obj_lines.h"
#include "assets/polygon.h"
#include "silvasim/base/error.h"
#include "silvasim/base/file.h"

namespace assets {

namespace {

constexpr std::size_t most_library_bytes = 64 << 20;
constexpr std::uint32_t unset = 0xFFFFFFFFu;
constexpr std::uint32_t flat_bit = 0x80000000u;  // in smooth_with: then the number of a face, not of a position

struct CornerKey {
  std::uint32_t position, uv, normal;
  friend bool operator==(const CornerKey&, const CornerKey&) = default;
};

struct CornerHash {
  std::size_t operator()(const CornerKey& k) const {
    std::uint64_t h = k.position * 0x9E3779B97F4A7C15ull;
    h = (h ^ (h >> 29) ^ k.uv) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 32) ^ k.normal) * 0x94D049BB133111EBull;
    return static_cast<std::size_t>(h ^ (h >> 29));
  }
};

struct Builder {
  Builder(Reading& r, ObjLines& l) : reading(r), lines(l) {}

  Reading& reading;
  ObjLines& lines;
  Draft draft;
  std::vector<V3> positions, normals;  // of the file, by its own numbers
  std::vector<V2> uvs;
  std::unordered_map<CornerKey, std::uint32_t, CornerHash> vertices;
  std::map<std::string, std::uint32_t> material_numbers;  // in the order of use
  std::vector<std::string> material_names;
  std::uint32_t material = unset;
  Triangulator triangulator;
  std::uint32_t flat_faces = 0;
  std::vector<V3> corners;
  std::vector<std::uint32_t> corner_vertices;
  std::vector<std::array<std::uint32_t, 3>> cut;

  void check(float a, float b, float c) const {
    if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(c)) {
      reading.fail_at(lines.line(), "a number is too large");
    }
  }

  std::uint32_t use(const std::string& name) {
    const auto [it, is_new] = material_numbers.try_emplace(name, static_cast<std::uint32_t>(material_names.size()));
    if (is_new) material_names.push_back(name);
    return it->second;
  }

  // OBJ counts from 1, and from the end with negative numbers.
  std::uint32_t index(int raw, std::size_t count, const char* what) const {
    const long long i = raw > 0 ? raw - 1ll : static_cast<long long>(count) + raw;
    if (i < 0 || i >= static_cast<long long>(count)) {
      reading.fail_at(lines.line(), std::string("a face uses ") + what + " " + std::to_string(raw) +
                                        ", and so far there are " + std::to_string(count));
    }
    return static_cast<std::uint32_t>(i);
  }

  std::uint32_t vertex(const tinyobj::index_t& corner) {
    CornerKey key{index(corner.vertex_index, positions.size(), "vertex"), unset, unset};
    if (corner.texcoord_index != 0) key.uv = index(corner.texcoord_index, uvs.size(), "texture coordinate");
    if (corner.normal_index != 0) key.normal = index(corner.normal_index, normals.size(), "normal");
    const bool flat = key.normal == unset && lines.flat();
    const auto next = static_cast<std::uint32_t>(draft.positions.size());
    if (!flat) {
      const auto [it, is_new] = vertices.try_emplace(key, next);
      if (!is_new) return it->second;
    }
    draft.positions.push_back(positions[key.position]);
    draft.uvs.push_back(key.uv == unset ? V2(0.0f, 0.0f) : uvs[key.uv]);
    draft.normals.push_back(key.normal == unset ? V3(0.0f, 0.0f, 0.0f) : normals[key.normal]);
    // Without normals of its own, a face is smooth over its neighbours also where the texture has a seam.
    draft.smooth_with.push_back(flat ? flat_bit | flat_faces : key.position);
    const std::vector<Rgb>& colours = lines.colours();
    if (!colours.empty()) {
      draft.colours.resize(next, Rgb(1.0f, 1.0f, 1.0f));
      draft.colours.push_back(key.position < colours.size() ? colours[key.position] : Rgb(1.0f, 1.0f, 1.0f));
    }
    return next;
  }

  void face(const tinyobj::index_t* indices, int count) {
    if (count < 3) return;
    corners.clear();
    corner_vertices.clear();
    for (int i = 0; i < count; ++i) {
      corner_vertices.push_back(vertex(indices[i]));
      corners.push_back(draft.positions[corner_vertices.back()]);
    }
    if (material == unset) material = use("");
    cut.clear();
    triangulator.cut(corners, cut);
    for (const auto& [a, b, c] : cut) {
      draft.triangles.push_back({corner_vertices[a], corner_vertices[b], corner_vertices[c]});
      draft.triangle_materials.push_back(material);
    }
    ++flat_faces;
    reading.check_triangles(draft.triangles.size());
  }
};

tinyobj::callback_t callbacks() {
  tinyobj::callback_t all;
  all.vertex_cb = [](void* user, float x, float y, float z, float) {
    Builder& b = *static_cast<Builder*>(user);
    b.check(x, y, z);
    if (b.positions.size() > 3 * b.reading.options.most_triangles + 1000) {
      b.reading.fail_at(b.lines.line(), "it has more vertices than " +
                                            std::to_string(b.reading.options.most_triangles) + " triangles can use");
    }
    b.positions.emplace_back(x, y, z);
  };
  all.normal_cb = [](void* user, float x, float y, float z) {
    Builder& b = *static_cast<Builder*>(user);
    b.check(x, y, z);
    b.normals.emplace_back(x, y, z);
  };
  all.texcoord_cb = [](void* user, float u, float v, float) {
    Builder& b = *static_cast<Builder*>(user);
    b.check(u, v, 0);
    b.uvs.emplace_back(u, 1.0f - v);
  };
  all.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
    static_cast<Builder*>(user)->face(indices, count);
  };
  all.usemtl_cb = [](void* user, const char* name, int) {
    Builder& b = *static_cast<Builder*>(user);
    b.material = b.use(name);
  };
  return all;
}

std::shared_ptr<const Picture> picture(Reading& reading, const std::string& name) {
  if (name.empty()) return nullptr;
  Beneath found = file_beneath(reading.file.parent_path(), name);
  if (found.file.empty()) {
    reading.warn("texture \"" + name + "\" " + found.refusal + "; the material gets a plain colour");
    return nullptr;
  }
  return std::make_shared<const Picture>(Picture{name, std::move(found.file), {}});
}

bool moved(const tinyobj::texture_option_t& o) {
  return o.scale[0] != 1 || o.scale[1] != 1 || o.origin_offset[0] != 0 || o.origin_offset[1] != 0;
}

DraftMaterial material_from(Reading& reading, const tinyobj::material_t& m) {
  DraftMaterial material;
  material.name = m.name;
  material.colour = Rgb(m.diffuse[0], m.diffuse[1], m.diffuse[2]);
  // Exporters leave Kd out, which tinyobjloader makes 0.6, or black, where there is a picture.
  const bool unset_colour = material.colour == Rgb(0.6f, 0.6f, 0.6f) || luminance(material.colour) <= 0;
  if (!m.diffuse_texname.empty() && unset_colour) material.colour = Rgb(1.0f, 1.0f, 1.0f);
  material.transmission = Rgb(0.0f, 0.0f, 0.0f);
  material.alpha = m.dissolve;
  material.alpha_mode = m.dissolve < 1 ? Alpha::blend : Alpha::opaque;
  // Tf is "no filter" (1 1 1) in most files, of opaque things too: only glass-like illumination models mean it.
  const bool passes = m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9;
  if (passes) material.transmission = Rgb(m.transmittance[0], m.transmittance[1], m.transmittance[2]);
  material.colour_picture = picture(reading, m.diffuse_texname);
  material.picture_lost = !m.diffuse_texname.empty() && material.colour_picture == nullptr;
  if (moved(m.diffuse_texopt)) {
    reading.warn("the options -s and -o of map_Kd in material \"" + m.name + "\" are not supported");
  }
  if (!m.alpha_texname.empty()) {
    if (m.alpha_texname != m.diffuse_texname) material.alpha_picture = picture(reading, m.alpha_texname);
    material.alpha_mode = Alpha::cut;
    material.alpha = 1;  // writers set d to 0 or 1 beside map_d
  } else if (material.colour_picture != nullptr) {
    material.alpha_mode = Alpha::by_texture;
  }
  return material;
}

void read_library(Reading& reading, const std::string& name, std::map<std::string, DraftMaterial>& materials) {
  const auto read_one = [&](const std::filesystem::path& file) {
    std::istringstream text(silvasim::base::read_file(file, most_library_bytes));
    std::map<std::string, int> numbers;
    std::vector<tinyobj::material_t> found;
    std::string warning, error;
    tinyobj::LoadMtl(&numbers, &found, &text, &warning, &error);
    for (const tinyobj::material_t& m : found) {
      if (m.name.empty() || materials.contains(m.name)) continue;
      materials.emplace(m.name, material_from(reading, m));
    }
  };
  // The rest of the line is one name, or several without spaces.
  const std::filesystem::path folder = reading.file.parent_path();
  if (const Beneath whole = file_beneath(folder, name); !whole.file.empty()) return read_one(whole.file);
  std::istringstream words(name);
  for (std::string word; words >> word;) {
    const Beneath part = file_beneath(folder, word);
    if (part.file.empty()) {
      reading.warn("material library \"" + word + "\" " + part.refusal + "; its materials become grey");
    } else {
      read_one(part.file);
    }
  }
}

}  // namespace

Draft read_obj(Reading& reading) {
  ObjLines lines(silvasim::base::read_file(reading.file, reading.options.most_file_bytes));
  std::istream stream(&lines);
  Builder builder(reading, lines);
  std::string warning, error;
  tinyobj::LoadObjWithCallback(stream, callbacks(), &builder, nullptr, &warning, &error);
  if (!lines.error().empty()) reading.fail_at(lines.line(), lines.error());
  if (builder.draft.triangles.empty()) reading.fail("it has no faces");

  if (!lines.odd_number().empty()) {
    reading.warn("line " + std::to_string(lines.odd_number_line()) + ": of \"" + lines.odd_number() +
                 "\" only the beginning is a number");
  }
  if (lines.other_surfaces()) reading.warn("curves and free-form surfaces are left out");
  if (builder.triangulator.gave_up()) reading.warn("its polygons are too intricate; some were cut as fans");

  Draft draft = std::move(builder.draft);
  if (!draft.colours.empty()) draft.colours.resize(draft.positions.size(), Rgb(1.0f, 1.0f, 1.0f));

  const auto positions = static_cast<std::uint32_t>(builder.positions.size());
  for (std::uint32_t& group : draft.smooth_with) {
    if ((group & flat_bit) != 0) group = positions + (group & ~flat_bit);
  }

  // Name the materials in the order of their use; what no library describes is grey.
  std::map<std::string, DraftMaterial> materials;
  for (const std::string& name : lines.libraries()) read_library(reading, name, materials);
  for (const std::string& name : builder.material_names) {
    const auto it = materials.find(name);
    if (it != materials.end()) {
      draft.materials.push_back(it->second);
    } else {
      if (!name.empty() && !materials.empty()) reading.warn("there is no material \"" + name + "\"; it becomes grey");
      draft.materials.emplace_back().name = name;
    }
  }

  if (reading.options.up != Up::z) {
    for (V3& p : draft.positions) p = z_up_from_y_up(p);
    for (V3& n : draft.normals) n = z_up_from_y_up(n);
  }
  return draft;
}

}  // namespace assets
