// PLY (Turk 1994), text and binary of both byte orders, as scanners and MeshLab write it.
//
// Own code: assimp's importer, the only kept one for C++ in Debian 12, crashes or hangs on damaged files of 500 bytes.
#include <array>

#include "assets/beneath.h"
#include "assets/draft.h"
#include "assets/ply_source.h"
#include "assets/polygon.h"
#include "assets/srgb.h"
#include "silvasim/base/file.h"

namespace assets {

namespace {

constexpr std::size_t most_corners = 65536;

// What a property of an element means here.
enum class Use { none, x, y, z, nx, ny, nz, u, v, red, green, blue, corners, corner_uvs };

Use use_of_vertex_property(const std::string& name) {
  struct Name {
    const char* name;
    Use use;
  };
  constexpr std::array names{Name{"x", Use::x},
                             Name{"y", Use::y},
                             Name{"z", Use::z},
                             Name{"nx", Use::nx},
                             Name{"ny", Use::ny},
                             Name{"nz", Use::nz},
                             Name{"s", Use::u},
                             Name{"t", Use::v},
                             Name{"u", Use::u},
                             Name{"v", Use::v},
                             Name{"texture_u", Use::u},
                             Name{"texture_v", Use::v},
                             Name{"red", Use::red},
                             Name{"green", Use::green},
                             Name{"blue", Use::blue},
                             Name{"r", Use::red},
                             Name{"g", Use::green},
                             Name{"b", Use::blue},
                             Name{"diffuse_red", Use::red},
                             Name{"diffuse_green", Use::green},
                             Name{"diffuse_blue", Use::blue}};
  for (const Name& n : names) {
    if (name == n.name) return n.use;
  }
  return Use::none;
}

class PlyReader {
 public:
  PlyReader(Reading& reading, PlySource& source) : reading_(reading), source_(source) {}

  Draft read();

 private:
  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  void read_strips(const PlyElement& element);
  void skip(const PlyElement& element);
  void read_list(const PlyProperty& property, std::vector<double>& values);
  std::uint32_t vertex(double number) const;
  void add_face(const std::vector<double>& corners, const std::vector<double>& uvs);

  Reading& reading_;
  PlySource& source_;
  Draft draft_;
  std::size_t vertices_ = 0;  // of the file; more may follow for textures of faces
  Triangulator triangulator_;
};

Draft PlyReader::read() {
  const std::vector<PlyElement> elements = source_.read_header();
  for (const PlyElement& element : elements) {
    if (element.name == "vertex" && vertices_ == 0) {
      read_vertices(element);
    } else if (element.name == "face" && vertices_ > 0) {
      read_faces(element);
    } else if (element.name == "tristrips" && vertices_ > 0) {
      read_strips(element);
    } else {
      skip(element);
    }
  }
  if (draft_.triangles.empty()) reading_.fail("it has no faces; a cloud of points is no plant model");
  if (triangulator_.gave_up()) reading_.warn("its polygons are too intricate; some were cut as fans");

  DraftMaterial material;
  if (!draft_.colours.empty()) material.colour = Rgb(1.0f, 1.0f, 1.0f);
  if (const std::string& name = source_.texture_file(); !name.empty()) {
    Beneath found = file_beneath(reading_.file.parent_path(), name);
    if (found.file.empty()) {
      reading_.warn("texture \"" + name + "\" " + found.refusal + "; the material gets a plain colour");
      material.picture_lost = true;
    } else {
      material.colour_picture = std::make_shared<const Picture>(Picture{name, std::move(found.file), {}});
      material.alpha_mode = Alpha::by_texture;
    }
    material.colour = Rgb(1.0f, 1.0f, 1.0f);
  }
  material.name = reading_.file.stem().string();
  draft_.materials.push_back(std::move(material));
  draft_.triangle_materials.assign(draft_.triangles.size(), 0);
  if (reading_.options.up == Up::y) {
    for (V3& p : draft_.positions) p = z_up_from_y_up(p);
    for (V3& n : draft_.normals) n = z_up_from_y_up(n);
  }
  return std::move(draft_);
}

void PlyReader::read_vertices(const PlyElement& element) {
  if (element.count > 3 * reading_.options.most_triangles + 1000) {
    reading_.fail("it has more vertices than " + std::to_string(reading_.options.most_triangles) +
                  " triangles can use");
  }
  std::vector<Use> uses;
  bool has_position[3] = {false, false, false}, coloured = false;
  for (const PlyProperty& property : element.properties) {
    Use use = property.is_list ? Use::none : use_of_vertex_property(property.name);
    if (use >= Use::x && use <= Use::z) has_position[static_cast<int>(use) - static_cast<int>(Use::x)] = true;
    coloured = coloured || use == Use::red;
    uses.push_back(use);
  }
  if (!has_position[0] || !has_position[1] || !has_position[2]) reading_.fail("its vertices lack x, y or z");
  vertices_ = element.count;
  draft_.positions.reserve(element.count);
  std::vector<double> ignored;
  for (std::size_t i = 0; i < element.count; ++i) {
    V3 p(0.0f, 0.0f, 0.0f), n(0.0f, 0.0f, 0.0f);
    V2 uv(0.0f, 1.0f);
    Rgb colour(1.0f, 1.0f, 1.0f);
    for (std::size_t k = 0; k < uses.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (property.is_list) {
        read_list(property, ignored);
        continue;
      }
      const double value = source_.number(property.type);
      const auto at = static_cast<float>(value);
      const int use = static_cast<int>(uses[k]);
      if (uses[k] >= Use::x && uses[k] <= Use::z) {
        p[use - static_cast<int>(Use::x)] = at;
      } else if (uses[k] >= Use::nx && uses[k] <= Use::nz) {
        n[use - static_cast<int>(Use::nx)] = at;
      } else if (uses[k] == Use::u) {
        uv.x = at;
      } else if (uses[k] == Use::v) {
        uv.y = at;
      } else if (uses[k] >= Use::red && uses[k] <= Use::blue) {
        const double greatest = ply_greatest(property.type);  // 0 of floats, which are shares
        colour[use - static_cast<int>(Use::red)] =
            static_cast<float>(linear_from_srgb(greatest > 0 ? value / greatest : value));
      }
    }
    draft_.positions.push_back(p);
    draft_.normals.push_back(n);
    draft_.uvs.emplace_back(uv.x, 1.0f - uv.y);
    draft_.smooth_with.push_back(static_cast<std::uint32_t>(i));
    if (coloured) draft_.colours.push_back(colour);
  }
}

void PlyReader::read_faces(const PlyElement& element) {
  std::vector<double> corners, uvs, ignored;
  for (std::size_t i = 0; i < element.count; ++i) {
    corners.clear();
    uvs.clear();
    for (const PlyProperty& property : element.properties) {
      if (!property.is_list) {
        source_.number(property.type);
      } else if (property.name == "vertex_indices" || property.name == "vertex_index") {
        read_list(property, corners);
      } else {
        read_list(property, property.name == "texcoord" ? uvs : ignored);
      }
    }
    add_face(corners, uvs);
  }
}

void PlyReader::read_strips(const PlyElement& element) {
  std::vector<double> strip, ignored;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (property.is_list) {
        read_list(property, property.name == "vertex_indices" || property.name == "vertex_index" ? strip : ignored);
      } else {
        source_.number(property.type);
      }
    }
    // -1 begins a new strip.
    std::size_t start = 0;
    for (std::size_t k = 0; k < strip.size(); ++k) {
      if (strip[k] == -1) {
        start = k + 1;
      } else if (k >= start + 2) {
        std::array<std::uint32_t, 3> t{vertex(strip[k - 2]), vertex(strip[k - 1]), vertex(strip[k])};
        if ((k - start) % 2 == 1) std::swap(t[0], t[1]);
        draft_.triangles.push_back(t);
        reading_.check_triangles(draft_.triangles.size());
      }
    }
  }
}

void PlyReader::skip(const PlyElement& element) {
  if (element.properties.empty()) return;
  std::vector<double> ignored;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (property.is_list) {
        read_list(property, ignored);
      } else {
        source_.number(property.type);
      }
    }
  }
}

void PlyReader::read_list(const PlyProperty& property, std::vector<double>& values) {
  const double count = source_.number(property.count_type);
  const double most = property.name == "vertex_indices" || property.name == "vertex_index" ? 1e9 : 1e6;
  if (!(count >= 0 && count <= most)) reading_.fail("a list \"" + property.name + "\" has an impossible length");
  values.clear();
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) values.push_back(source_.number(property.type));
}

std::uint32_t PlyReader::vertex(double number) const {
  if (!(number >= 0 && number < static_cast<double>(vertices_))) {
    reading_.fail("a face uses vertex " + std::to_string(number) + ", and there are " + std::to_string(vertices_));
  }
  return static_cast<std::uint32_t>(number);
}

void PlyReader::add_face(const std::vector<double>& corners, const std::vector<double>& uvs) {
  if (corners.size() < 3) return;
  if (corners.size() > most_corners) reading_.fail("a face has more than " + std::to_string(most_corners) + " corners");
  std::vector<std::uint32_t> numbers;
  std::vector<V3> points;
  const bool own_uvs = uvs.size() == 2 * corners.size();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    std::uint32_t number = vertex(corners[k]);
    points.push_back(draft_.positions[number]);
    if (own_uvs) {
      // A corner with texture coordinates of its own becomes a vertex of its own, with the same normal.
      draft_.positions.push_back(draft_.positions[number]);
      draft_.normals.push_back(draft_.normals[number]);
      draft_.uvs.emplace_back(static_cast<float>(uvs[2 * k]), 1.0f - static_cast<float>(uvs[2 * k + 1]));
      draft_.smooth_with.push_back(number);
      if (!draft_.colours.empty()) draft_.colours.push_back(draft_.colours[number]);
      number = static_cast<std::uint32_t>(draft_.positions.size() - 1);
    }
    numbers.push_back(number);
  }
  std::vector<std::array<std::uint32_t, 3>> cut;
  triangulator_.cut(points, cut);
  for (const auto& [a, b, c] : cut) draft_.triangles.push_back({numbers[a], numbers[b], numbers[c]});
  reading_.check_triangles(draft_.triangles.size());
}

}  // namespace

Draft read_ply(Reading& reading) {
  PlySource source(reading, silvasim::base::read_file(reading.file, reading.options.most_file_bytes));
  return PlyReader(reading, source).read();
}

}  // namespace assets
