#include "ghosttile/tile/model_bytes.h"

#include <cmath>

namespace ghosttile::tile {

using assets::V3;

namespace {

constexpr int most_texture_px = 4096;

void put_colour(ByteWriter& to, const assets::Rgb& colour) {
  to.put(colour.x);
  to.put(colour.y);
  to.put(colour.z);
}
assets::Rgb get_colour(ByteReader& from) {
  const V3 v = get_vector(from);
  for (int c = 0; c < 3; ++c)
    // A factor to a texture may be above 1.
    if (!(v[c] >= 0 && v[c] <= 1000)) from.fail("a colour is below 0 or far above 1");
  return {v.x, v.y, v.z};
}

bool get_flag(ByteReader& from) {
  const auto byte = from.get<std::uint8_t>();
  if (byte > 1) from.fail("a flag is neither 0 nor 1");
  return byte == 1;
}

assets::Material get_material(ByteReader& from) {
  assets::Material material;
  material.name = from.get_text();
  material.reflectance = get_colour(from);
  material.transmittance = get_colour(from);
  material.texture = from.get<std::int32_t>();
  material.alpha_cutoff = from.get<float>();
  if (!(material.alpha_cutoff >= 0 && material.alpha_cutoff <= 1)) from.fail("an alpha cutoff lies outside of 0 to 1");
  material.two_sided = get_flag(from);
  return material;
}

assets::Texture get_texture(ByteReader& from) {
  assets::Texture texture;
  texture.name = from.get_text();
  texture.width = from.get<std::int32_t>();
  texture.height = from.get<std::int32_t>();
  texture.has_alpha = get_flag(from);
  if (texture.width < 1 || texture.height < 1 || texture.width > most_texture_px || texture.height > most_texture_px)
    from.fail("a texture has 1 to " + std::to_string(most_texture_px) + " pixels a side");
  texture.rgba = get_column<std::uint8_t>(from);
  if (texture.rgba.size() != static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height) * 4)
    from.fail("a texture has not as many bytes as its size asks for");
  return texture;
}

}  // namespace

void put_vector(ByteWriter& to, const V3& v) {
  to.put(v.x);
  to.put(v.y);
  to.put(v.z);
}

V3 get_vector(ByteReader& from) {
  V3 v;
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = from.get<float>();
    if (!(std::abs(v[axis]) < 1e7f)) from.fail("a coordinate is no number, or too large");
  }
  return v;
}

void put_model(ByteWriter& to, const assets::Model& model) {
  to.put_text(model.name);
  to.put(static_cast<std::uint32_t>(model.positions.size()));
  for (std::size_t v = 0; v < model.positions.size(); ++v) {
    put_vector(to, model.positions[v]);
    put_vector(to, model.normals[v]);
    to.put(model.uvs[v].x);
    to.put(model.uvs[v].y);
  }
  to.put(static_cast<std::uint32_t>(model.triangles.size()));
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (const std::uint32_t corner : model.triangles[t]) to.put(corner);
    to.put(model.triangle_materials[t]);
  }
  to.put(static_cast<std::uint32_t>(model.materials.size()));
  for (const assets::Material& material : model.materials) {
    to.put_text(material.name);
    put_colour(to, material.reflectance);
    put_colour(to, material.transmittance);
    to.put(static_cast<std::int32_t>(material.texture));
    to.put(material.alpha_cutoff);
    to.put(static_cast<std::uint8_t>(material.two_sided));
  }
  to.put(static_cast<std::uint32_t>(model.textures.size()));
  for (const assets::Texture& texture : model.textures) {
    to.put_text(texture.name);
    to.put(static_cast<std::int32_t>(texture.width));
    to.put(static_cast<std::int32_t>(texture.height));
    to.put(static_cast<std::uint8_t>(texture.has_alpha));
    put_column(to, texture.rgba);
  }
}

assets::Model get_model(ByteReader& from) {
  assets::Model model;
  model.name = from.get_text();
  const std::uint32_t vertices = from.get_count(32);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    model.positions.push_back(get_vector(from));
    model.normals.push_back(get_vector(from));
    if (std::abs(model.normals.back().length() - 1) > 1e-2f) from.fail("a normal is not of unit length");
    const float u = from.get<float>(), down = from.get<float>();
    if (!(std::abs(u) < 1e7f && std::abs(down) < 1e7f)) from.fail("a place on a texture is no number, or too large");
    model.uvs.emplace_back(u, down);
  }
  model.triangles.resize(from.get_count(14));
  for (auto& triangle : model.triangles) {
    for (std::uint32_t& corner : triangle) {
      corner = from.get<std::uint32_t>();
      if (corner >= vertices) from.fail("a triangle's corner is none of the vertices");
    }
    model.triangle_materials.push_back(from.get<std::uint16_t>());
  }
  model.materials.resize(from.get_count(38));
  for (assets::Material& material : model.materials) material = get_material(from);
  model.textures.resize(from.get_count(17));
  for (assets::Texture& texture : model.textures) texture = get_texture(from);
  for (const assets::Material& material : model.materials)
    if (material.texture < assets::no_texture || material.texture >= static_cast<int>(model.textures.size()))
      from.fail("a material's texture is none of the model's");
  for (const std::uint16_t material : model.triangle_materials)
    if (material >= model.materials.size()) from.fail("a triangle's material is none of the model's");
  return model;
}

}  // namespace ghosttile::tile
