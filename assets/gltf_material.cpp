#include <algorithm>

#include "assets/beneath.h"
#include "assets/gltf_parts.h"

namespace assets {

namespace {

using Pictures = std::vector<std::shared_ptr<const Picture>>;

// The picture of a texture; null with a warning where there is none that may be read.
std::shared_ptr<const Picture> picture(Reading& reading, const tinygltf::Model& model, int texture, Pictures& known) {
  const auto lost = [&](const std::string& why) {
    reading.warn(why + "; the material gets a plain colour");
    return nullptr;
  };
  if (texture < 0 || static_cast<std::size_t>(texture) >= model.textures.size()) {
    return lost("there is no texture " + std::to_string(texture));
  }
  const int image = model.textures[static_cast<std::size_t>(texture)].source;
  if (image < 0 || static_cast<std::size_t>(image) >= model.images.size()) {
    return lost("texture " + std::to_string(texture) + " has no PNG or JPEG picture");
  }
  std::shared_ptr<const Picture>& slot = known[static_cast<std::size_t>(image)];
  if (slot) return slot;
  const tinygltf::Image& i = model.images[static_cast<std::size_t>(image)];
  Picture found{i.name.empty() ? reading.file.filename().string() + " image " + std::to_string(image) : i.name, {}, {}};
  if (i.bufferView >= 0) {
    const auto view = static_cast<std::size_t>(i.bufferView);
    if (view >= model.bufferViews.size()) return lost("picture \"" + found.name + "\" has no buffer view");
    const tinygltf::BufferView& v = model.bufferViews[view];
    if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= model.buffers.size()) {
      return lost("picture \"" + found.name + "\" has no buffer");
    }
    const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(v.buffer)].data;
    if (v.byteLength == 0 || v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset) {
      return lost("picture \"" + found.name + "\" ends beyond its buffer");
    }
    const auto* start = reinterpret_cast<const std::byte*>(data.data() + v.byteOffset);
    found.bytes.assign(start, start + v.byteLength);
  } else if (i.as_is && !i.image.empty()) {
    const auto* start = reinterpret_cast<const std::byte*>(i.image.data());
    found.bytes.assign(start, start + i.image.size());
  } else {
    const std::string name = percent_decoded(i.uri);
    Beneath file = file_beneath(reading.file.parent_path(), name);
    if (file.file.empty()) return lost("texture \"" + name + "\" " + file.refusal);
    found = {name, std::move(file.file), {}};
  }
  slot = std::make_shared<const Picture>(std::move(found));
  return slot;
}

double number(const tinygltf::Value& object, const char* key, double otherwise) {
  if (!object.IsObject() || !object.Has(key)) return otherwise;
  const tinygltf::Value& value = object.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

double number(const tinygltf::Value& object, const char* key, std::size_t i, double otherwise) {
  if (!object.IsObject() || !object.Has(key)) return otherwise;
  const tinygltf::Value& list = object.Get(key);
  if (!list.IsArray() || list.ArrayLen() <= i) return otherwise;
  const tinygltf::Value& value = list.Get(static_cast<int>(i));
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

void read_uv_transform(const tinygltf::Value& transform, GltfMaterial& material) {
  for (std::size_t i = 0; i < 2; ++i) {
    material.uv_offset[i] = number(transform, "offset", i, 0);
    material.uv_scale[i] = number(transform, "scale", i, 1);
  }
  material.uv_turn_rad = number(transform, "rotation", 0);
  const double set = number(transform, "texCoord", material.uv_set);
  if (set >= 0 && set < 16) material.uv_set = static_cast<int>(set);
}

GltfMaterial material_from(Reading& reading, const tinygltf::Model& model, const tinygltf::Material& m,
                           Pictures& known) {
  GltfMaterial material;
  DraftMaterial& draft = material.draft;
  draft.name = m.name;
  draft.two_sided = m.doubleSided;
  draft.cutoff = static_cast<float>(m.alphaCutoff);
  if (m.alphaMode == "MASK") draft.alpha_mode = Alpha::cut;
  if (m.alphaMode == "BLEND") draft.alpha_mode = Alpha::blend;

  std::vector<double> factor = m.pbrMetallicRoughness.baseColorFactor;
  int texture = m.pbrMetallicRoughness.baseColorTexture.index;
  material.uv_set = m.pbrMetallicRoughness.baseColorTexture.texCoord;
  const tinygltf::ExtensionMap* texture_extensions = &m.pbrMetallicRoughness.baseColorTexture.extensions;
  // The older description by specular and glossiness, whose diffuse colour is what is meant here.
  if (const auto it = m.extensions.find("KHR_materials_pbrSpecularGlossiness"); it != m.extensions.end()) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (factor.size() == 4) factor[i] = number(it->second, "diffuseFactor", i, factor[i]);
    }
    if (texture < 0 && it->second.IsObject() && it->second.Has("diffuseTexture")) {
      texture = static_cast<int>(std::clamp(number(it->second.Get("diffuseTexture"), "index", -1), -1.0, 1e6));
      material.uv_set =
          static_cast<int>(std::clamp(number(it->second.Get("diffuseTexture"), "texCoord", 0), 0.0, 16.0));
      texture_extensions = nullptr;
    }
  }
  if (factor.size() != 4) reading.fail("material \"" + m.name + "\" has a base colour that is not of 4 numbers");
  draft.colour = Rgb(static_cast<float>(factor[0]), static_cast<float>(factor[1]), static_cast<float>(factor[2]));
  draft.alpha = static_cast<float>(factor[3]);
  if (texture >= 0) {
    draft.colour_picture = picture(reading, model, texture, known);
    draft.picture_lost = draft.colour_picture == nullptr;
  }
  if (texture_extensions != nullptr) {
    const auto it = texture_extensions->find("KHR_texture_transform");
    if (it != texture_extensions->end()) read_uv_transform(it->second, material);
  }
  if (const auto it = m.extensions.find("KHR_materials_transmission"); it != m.extensions.end()) {
    draft.transmission = Rgb(static_cast<float>(number(it->second, "transmissionFactor", 0)));
  }
  if (const auto it = m.extensions.find("KHR_materials_diffuse_transmission"); it != m.extensions.end()) {
    draft.transmission = Rgb(static_cast<float>(number(it->second, "diffuseTransmissionFactor", 0)));
  }
  return material;
}

}  // namespace

std::vector<GltfMaterial> gltf_materials(Reading& reading, const tinygltf::Model& model) {
  Pictures known(model.images.size());
  std::vector<GltfMaterial> materials;
  materials.reserve(model.materials.size() + 1);
  for (const tinygltf::Material& m : model.materials) materials.push_back(material_from(reading, model, m, known));
  materials.emplace_back();  // for primitives without a material
  return materials;
}

}  // namespace assets
