// glTF 2.0, text and binary, by tinygltf.
#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>

#include <cmath>
#include <unordered_map>

#include "assets/gltf_parts.h"

namespace assets {

namespace {

using M44d = Imath::M44d;  // row vectors: point * matrix

constexpr int most_depth = 256;

class Scene {
 public:
  Scene(Reading& reading, const tinygltf::Model& model)
      : reading_(reading),
        model_(model),
        materials_(gltf_materials(reading, model)),
        visited_(model.nodes.size(), false) {}

  Draft read();

 private:
  void visit(int node, const M44d& world_from_parent, int depth);
  void add_mesh(int mesh, const M44d& world_from_mesh);
  void add(const tinygltf::Primitive& primitive, const M44d& world_from_mesh);

  Reading& reading_;
  const tinygltf::Model& model_;
  std::vector<GltfMaterial> materials_;
  std::vector<bool> visited_;
  Draft draft_;
  std::size_t triangles_ = 0;  // also those that are left out
  bool warned_of_lines_ = false, warned_of_skin_ = false, warned_of_rest_ = false;
};

M44d parent_from_node(const Reading& reading, const tinygltf::Node& node) {
  const auto check = [&](const std::vector<double>& numbers, std::size_t due, const char* what) {
    bool good = numbers.empty() || numbers.size() == due;
    for (const double number : numbers) good = good && std::isfinite(number);
    if (!good)
      reading.fail("node \"" + node.name + "\" has a " + what + " that is not of " + std::to_string(due) + " numbers");
    return !numbers.empty();
  };
  M44d matrix;
  if (check(node.matrix, 16, "matrix")) {
    // glTF writes columns for column vectors, which are Imath's rows for row vectors.
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column)
        matrix[row][column] = node.matrix[static_cast<std::size_t>(4 * row + column)];
    }
    return matrix;
  }
  M44d scale, rotation, translation;
  if (check(node.scale, 3, "scale")) scale.setScale(V3d(node.scale[0], node.scale[1], node.scale[2]));
  if (check(node.rotation, 4, "rotation")) {
    Imath::Quatd q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(q.length() > 1e-9)) reading.fail("node \"" + node.name + "\" has a rotation of zero length");
    rotation = q.normalized().toMatrix44();
  }
  if (check(node.translation, 3, "translation")) {
    translation.setTranslation(V3d(node.translation[0], node.translation[1], node.translation[2]));
  }
  return scale * rotation * translation;
}

Draft Scene::read() {
  // The scene that the file shows; without scenes, all nodes that are no children; without nodes, all meshes.
  std::vector<int> roots;
  if (!model_.scenes.empty()) {
    const int scene = model_.defaultScene >= 0 ? model_.defaultScene : 0;
    if (static_cast<std::size_t>(scene) >= model_.scenes.size())
      reading_.fail("there is no scene " + std::to_string(scene));
    roots = model_.scenes[static_cast<std::size_t>(scene)].nodes;
  } else if (!model_.nodes.empty()) {
    std::vector<bool> child(model_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes) {
      for (const int c : node.children) {
        if (c >= 0 && static_cast<std::size_t>(c) < child.size()) child[static_cast<std::size_t>(c)] = true;
      }
    }
    for (std::size_t i = 0; i < child.size(); ++i) {
      if (!child[i]) roots.push_back(static_cast<int>(i));
    }
    if (roots.empty()) reading_.fail("its nodes are all each other's children");
  }
  for (const int root : roots) visit(root, M44d(), 0);
  if (model_.scenes.empty() && model_.nodes.empty()) {
    for (std::size_t i = 0; i < model_.meshes.size(); ++i) add_mesh(static_cast<int>(i), M44d());
  }
  for (GltfMaterial& material : materials_) draft_.materials.push_back(std::move(material.draft));
  if (draft_.triangles.empty()) reading_.fail("there is no triangle in its scene");
  return std::move(draft_);
}

void Scene::visit(int node, const M44d& world_from_parent, int depth) {
  if (node < 0 || static_cast<std::size_t>(node) >= model_.nodes.size()) {
    reading_.fail("there is no node " + std::to_string(node) + ", there are " + std::to_string(model_.nodes.size()));
  }
  const auto i = static_cast<std::size_t>(node);
  if (visited_[i]) reading_.fail("node " + std::to_string(node) + " is its own ancestor or has two parents");
  if (depth > most_depth) reading_.fail("its nodes are nested deeper than " + std::to_string(most_depth) + " levels");
  visited_[i] = true;
  const tinygltf::Node& n = model_.nodes[i];
  const M44d world_from_node = parent_from_node(reading_, n) * world_from_parent;
  if (n.mesh >= 0) {
    if (n.skin >= 0 && !warned_of_skin_) {
      reading_.warn("its skeleton is not applied; the model stands as it was drawn");
      warned_of_skin_ = true;
    }
    add_mesh(n.mesh, world_from_node);
  }
  for (const int child : n.children) visit(child, world_from_node, depth + 1);
}

void Scene::add_mesh(int mesh, const M44d& world_from_mesh) {
  if (static_cast<std::size_t>(mesh) >= model_.meshes.size()) {
    reading_.fail("there is no mesh " + std::to_string(mesh) + ", there are " + std::to_string(model_.meshes.size()));
  }
  for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<std::size_t>(mesh)].primitives) {
    add(primitive, world_from_mesh);
  }
}

// Normals keep to surfaces: the matrix of cofactors is det * inverse transpose, and needs no inverse.
V3d cofactor_times(const M44d& m, const V3d& n) {
  const V3d a(m[0][0], m[0][1], m[0][2]), b(m[1][0], m[1][1], m[1][2]), c(m[2][0], m[2][1], m[2][2]);
  return b.cross(c) * n.x + c.cross(a) * n.y + a.cross(b) * n.z;
}

double determinant(const M44d& m) {
  const V3d a(m[0][0], m[0][1], m[0][2]), b(m[1][0], m[1][1], m[1][2]), c(m[2][0], m[2][1], m[2][2]);
  return a.dot(b.cross(c));
}

std::size_t triangle_count(int mode, std::size_t corners) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

// Corner numbers of a triangle of a list, a strip or a fan.
std::array<std::size_t, 3> corners_of(int mode, std::size_t triangle) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return {3 * triangle, 3 * triangle + 1, 3 * triangle + 2};
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {0, triangle + 1, triangle + 2};
  const std::size_t odd = triangle % 2;  // every other triangle of a strip runs the other way
  return {triangle, triangle + 1 + odd, triangle + 2 - odd};
}

void Scene::add(const tinygltf::Primitive& primitive, const M44d& world_from_mesh) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN) {
    if (!warned_of_lines_) reading_.warn("points and lines are left out");
    warned_of_lines_ = true;
    return;
  }
  std::size_t material = materials_.size() - 1;
  if (primitive.material >= 0) {
    material = static_cast<std::size_t>(primitive.material);
    if (material >= materials_.size() - 1) reading_.fail("there is no material " + std::to_string(material));
  }
  const GltfMaterial& m = materials_[material];

  const auto column = [&](const std::string& name, int least, int most) -> std::unique_ptr<Column> {
    const auto it = primitive.attributes.find(name);
    if (it == primitive.attributes.end()) return nullptr;
    return std::make_unique<Column>(reading_, model_, it->second, name, least, most);
  };
  const auto position = column("POSITION", 3, 3);
  if (!position) {
    reading_.warn("a part without positions is left out");
    return;
  }
  const auto normal = column("NORMAL", 3, 3);
  const auto uv = column("TEXCOORD_" + std::to_string(m.uv_set), 2, 2);
  const auto colour = column("COLOR_0", 3, 4);
  for (const Column* other : {normal.get(), uv.get(), colour.get()}) {
    if (other != nullptr && other->size() != position->size()) {
      reading_.fail("a part has " + std::to_string(position->size()) + " positions but " +
                    std::to_string(other->size()) + " normals, texture coordinates or colours");
    }
  }
  std::unique_ptr<Column> indices;
  if (primitive.indices >= 0) {
    indices = std::make_unique<Column>(reading_, model_, primitive.indices, "the indices", 1, 1);
    if (!indices->is_unsigned()) reading_.fail("indices are not of unsigned integers");
  }
  const std::size_t corners = indices ? indices->size() : position->size();
  const std::size_t count = triangle_count(mode, corners);
  triangles_ += count;
  reading_.check_triangles(triangles_);
  if (mode == TINYGLTF_MODE_TRIANGLES && corners % 3 != 0 && !warned_of_rest_) {
    reading_.warn("the number of indices is no multiple of 3; the last ones are left out");
    warned_of_rest_ = true;
  }

  const double det = determinant(world_from_mesh);
  const bool mirrored = det < 0;
  const bool turn = reading_.options.up != Up::z;
  const double cosine = std::cos(m.uv_turn_rad), sine = std::sin(m.uv_turn_rad);

  const auto add_vertex = [&](std::uint32_t i) {
    const V3d at = V3d(position->number(i, 0), position->number(i, 1), position->number(i, 2)) * world_from_mesh;
    const V3 p(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z));
    draft_.positions.push_back(turn ? z_up_from_y_up(p) : p);
    V3 n(0.0f, 0.0f, 0.0f);
    if (normal) {
      V3d along =
          cofactor_times(world_from_mesh, V3d(normal->number(i, 0), normal->number(i, 1), normal->number(i, 2)));
      if (mirrored) along = -along;
      const double length = along.length();
      // Very small matrices make very small normals, which are still directions; zero and NaN are left for make_normals.
      if (length > 0) along /= length;
      n = V3(static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z));
    }
    draft_.normals.push_back(turn ? z_up_from_y_up(n) : n);
    V2 t(0.0f, 0.0f);
    if (uv) {
      const double u = uv->number(i, 0) * m.uv_scale[0], v = uv->number(i, 1) * m.uv_scale[1];
      t = V2(static_cast<float>(cosine * u + sine * v + m.uv_offset[0]),
             static_cast<float>(-sine * u + cosine * v + m.uv_offset[1]));
    }
    draft_.uvs.push_back(t);
    const auto number = static_cast<std::uint32_t>(draft_.positions.size() - 1);
    draft_.smooth_with.push_back(number);
    if (colour && draft_.colours.empty()) draft_.colours.resize(number, Rgb(1.0f, 1.0f, 1.0f));
    if (colour) {
      draft_.colours.emplace_back(colour->number(i, 0), colour->number(i, 1), colour->number(i, 2));
    } else if (!draft_.colours.empty()) {
      draft_.colours.emplace_back(1.0f, 1.0f, 1.0f);
    }
    return number;
  };

  // Only vertices that are used are taken, since many parts may share one long column. Without normals the standard asks
  // for flat triangles, so there each corner is a vertex of its own.
  std::unordered_map<std::uint32_t, std::uint32_t> taken;
  draft_.triangles.reserve(draft_.triangles.size() + count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<std::uint32_t, 3> triangle{};
    const std::array<std::size_t, 3> at = corners_of(mode, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = indices ? indices->index(at[k]) : static_cast<std::uint32_t>(at[k]);
      if (i >= position->size()) {
        reading_.fail("a triangle uses vertex " + std::to_string(i) + " of " + std::to_string(position->size()));
      }
      triangle[k] = i;
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    for (std::uint32_t& i : triangle) {
      if (!normal) {
        i = add_vertex(i);
        continue;
      }
      const auto [it, is_new] = taken.try_emplace(i, 0);
      if (is_new) it->second = add_vertex(i);
      i = it->second;
    }
    if (mirrored) std::swap(triangle[1], triangle[2]);
    draft_.triangles.push_back(triangle);
    draft_.triangle_materials.push_back(static_cast<std::uint32_t>(material));
  }
}

}  // namespace

Draft read_gltf(Reading& reading) {
  const tinygltf::Model model = parse_gltf(reading);
  return Scene(reading, model).read();
}

}  // namespace assets
