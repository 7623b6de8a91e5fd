// PLY (Turk 1994), binary little endian, z up.
#include "ghosttile/export/formats.h"
#include "ghosttile/export/painted.h"
#include "ghosttile/export/survey.h"
#include "ghosttile/export/writer.h"
#include "silvasim/base/words.h"

namespace ghosttile::exports {

namespace {

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
