// PLY (Turk 1994), binary little endian, z up.
#include <map>

#include "assets/srgb.h"
#include "assets/texture.h"
#include "ghosttile/export/formats.h"
#include "ghosttile/export/survey.h"
#include "ghosttile/export/writer.h"
#include "silvasim/base/words.h"

namespace ghosttile::exports {

namespace {

// A model whose vertices bear colours: one that two materials share is there twice.
struct Painted {
  struct Vertex {
    std::uint32_t of_model = 0;
    std::array<std::uint8_t, 3> rgb{};
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

std::array<std::uint8_t, 3> colour_of(const assets::Model& model, const assets::Material& material) {
  assets::Rgb colour = material.reflectance;
  if (material.texture != assets::no_texture) {
    const auto texture = static_cast<std::size_t>(material.texture);
    colour *= assets::mean_colour(model.textures[texture], material.alpha_cutoff);
  }
  return {assets::byte_of_linear(colour.x), assets::byte_of_linear(colour.y), assets::byte_of_linear(colour.z)};
}

Painted painted(const assets::Model& model) {
  std::vector<std::array<std::uint8_t, 3>> colours;
  for (const assets::Material& material : model.materials) colours.push_back(colour_of(model, material));
  Painted result;
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> numbers;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const std::uint16_t material = model.triangle_materials[t];
    auto& triangle = result.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = model.triangles[t][k];
      const auto next = static_cast<std::uint32_t>(result.vertices.size());
      const auto [at, is_new] = numbers.try_emplace({vertex, material}, next);
      if (is_new) result.vertices.push_back({vertex, colours[material]});
      triangle[k] = at->second;
    }
  }
  return result;
}

void write_head(Writer& out, const Survey& all, std::uint64_t vertices, const std::string& crs_wkt) {
  out << "ply\nformat binary_little_endian 1.0\n"
      << "comment " << all.instances << " instances; metres; x east, y north, z up\n"
      << "comment origin_m " << all.origin.x << ' ' << all.origin.y << ' ' << all.origin.z << '\n';
  if (!crs_wkt.empty()) out << "comment crs " << silvasim::base::printable(crs_wkt) << '\n';
  out << "element vertex " << vertices << '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) out << "property float " << name << '\n';
  for (const char* name : {"red", "green", "blue"}) out << "property uchar " << name << '\n';
  out << "element face " << all.triangles << "\nproperty list uchar uint vertex_indices\nend_header\n";
}

}  // namespace

void write_ply(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options) {
  const Survey all = survey(file);
  check_triangles(all, "ply");
  std::vector<Painted> models(file.tile->objects.size());
  std::uint64_t vertices = 0;
  for (const std::size_t o : all.used) {
    models[o] = painted(file.tile->objects[o].model);
    vertices += all.of_object[o] * models[o].vertices.size();
  }
  Writer out(path, options.inputs);
  write_head(out, all, vertices, options.crs_wkt);
  Passes passes(file, all, options.progress, 2);
  passes.run([&](const fill::Instance& instance) {
    const assets::Model& model = file.tile->objects[instance.object].model;
    for (const Painted::Vertex& vertex : models[instance.object].vertices) {
      const V3 p = placed(instance, all.origin, model.positions[vertex.of_model]);
      const V3 n = instance.rotation(model.normals[vertex.of_model]);
      for (const float number : {p.x, p.y, p.z, n.x, n.y, n.z}) out.put(number);
      for (const std::uint8_t channel : vertex.rgb) out.put(channel);
    }
  });
  std::uint32_t first = 0;
  passes.run([&](const fill::Instance& instance) {
    const Painted& model = models[instance.object];
    for (const auto& triangle : model.triangles) {
      out.put(std::uint8_t{3});
      for (const std::uint32_t corner : triangle) out.put(first + corner);
    }
    first += static_cast<std::uint32_t>(model.vertices.size());
  });
  out.commit();
}

}  // namespace ghosttile::exports
