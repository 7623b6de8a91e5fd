#include "ghosttile/export/gltf_models.h"

#include <algorithm>

#include "ghosttile/export/groups.h"
#include "ghosttile/export/png.h"
#include "silvasim/base/words.h"

namespace ghosttile::exports {

namespace {

using Json = nlohmann::ordered_json;
using assets::V3;

// glTF 2.0's numbers for types and uses of bytes, from OpenGL.
constexpr int type_u32 = 5125, type_f32 = 5126, use_vertices = 34962, use_indices = 34963, wrap_repeat = 10497,
              filter_linear = 9729, filter_mipmaps = 9987;

std::vector<V3> y_up(const std::vector<V3>& z_up) {
  std::vector<V3> result;
  result.reserve(z_up.size());
  for (const V3& v : z_up) result.emplace_back(v.x, v.z, -v.y);
  return result;
}

}  // namespace

std::string json_string(const std::string& text) { return Json(silvasim::base::printable(text)).dump(); }

GltfModels::GltfModels() {
  document_["asset"] = {{"version", "2.0"}, {"generator", "ghosttile"}};
  document_["scene"] = 0;
  document_["scenes"] = Json::array({{{"name", "details"}, {"nodes", Json::array({0})}}});
}

std::size_t GltfModels::view(const void* data, std::size_t size, int target) {
  Json& views = document_["bufferViews"];
  Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
  if (target != 0) view["target"] = target;
  bytes_.append(static_cast<const char*>(data), size);
  bytes_.append((4 - bytes_.size() % 4) % 4, '\0');
  views.push_back(std::move(view));
  return views.size() - 1;
}

std::size_t GltfModels::accessor(const void* data, std::size_t size, int target, const Json& what) {
  Json accessor = {{"bufferView", view(data, size, target)}};
  accessor.update(what);
  Json& accessors = document_["accessors"];
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

std::size_t GltfModels::add_material(const assets::Material& material, std::size_t first_texture) {
  const auto share = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
  const assets::Rgb& colour = material.reflectance;
  Json surface = {{"baseColorFactor", {share(colour.x), share(colour.y), share(colour.z), 1}},
                  {"metallicFactor", 0},
                  {"roughnessFactor", 1}};
  if (material.texture != assets::no_texture)
    surface["baseColorTexture"] = {{"index", first_texture + static_cast<std::size_t>(material.texture)}};
  Json entry = {{"name", silvasim::base::printable(material.name)},
                {"pbrMetallicRoughness", surface},
                {"doubleSided", material.two_sided}};
  if (material.alpha_cutoff > 0) {
    entry["alphaMode"] = "MASK";
    entry["alphaCutoff"] = material.alpha_cutoff;
  }
  Json& materials = document_["materials"];
  materials.push_back(std::move(entry));
  return materials.size() - 1;
}

void GltfModels::add(const objects::Detail& object) {
  const assets::Model& model = object.model;
  const std::size_t first_texture = document_.contains("textures") ? document_["textures"].size() : 0;
  for (const assets::Texture& texture : model.textures) {
    if (!document_.contains("samplers")) {
      document_["samplers"] = Json::array({{{"magFilter", filter_linear},
                                            {"minFilter", filter_mipmaps},
                                            {"wrapS", wrap_repeat},
                                            {"wrapT", wrap_repeat}}});
    }
    const std::string png = png_of(texture);
    Json& images = document_["images"];
    images.push_back({{"name", silvasim::base::printable(texture.name)},
                      {"mimeType", "image/png"},
                      {"bufferView", view(png.data(), png.size(), 0)}});
    document_["textures"].push_back({{"sampler", 0}, {"source", images.size() - 1}});
  }

  const std::vector<V3> positions = y_up(model.positions), normals = y_up(model.normals);
  V3 least = positions[0], most = least;
  for (const V3& p : positions) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      most[axis] = std::max(most[axis], p[axis]);
    }
  }
  const Json vectors = {{"componentType", type_f32}, {"count", positions.size()}, {"type", "VEC3"}};
  Json bounded = vectors;
  bounded["min"] = {least.x, least.y, least.z};
  bounded["max"] = {most.x, most.y, most.z};
  const std::size_t bytes = positions.size() * sizeof(V3);
  Json attributes = {{"POSITION", accessor(positions.data(), bytes, use_vertices, bounded)},
                     {"NORMAL", accessor(normals.data(), bytes, use_vertices, vectors)}};
  if (textured(model)) {
    attributes["TEXCOORD_0"] = accessor(model.uvs.data(), model.uvs.size() * sizeof(assets::V2), use_vertices,
                                        {{"componentType", type_f32}, {"count", model.uvs.size()}, {"type", "VEC2"}});
  }
  Json primitives = Json::array();
  for (const Group& group : groups_of(model)) {
    const std::size_t corners = 3 * group.triangles.size();
    const std::size_t indices = accessor(group.triangles.data(), corners * sizeof(std::uint32_t), use_indices,
                                         {{"componentType", type_u32}, {"count", corners}, {"type", "SCALAR"}});
    primitives.push_back({{"attributes", attributes},
                          {"indices", indices},
                          {"material", add_material(model.materials[group.material], first_texture)}});
  }
  document_["meshes"].push_back({{"name", silvasim::base::printable(object.name)}, {"primitives", primitives}});
}

}  // namespace ghosttile::exports
