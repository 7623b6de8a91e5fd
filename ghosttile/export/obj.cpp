// Wavefront OBJ: y up, as Blender and most others take it.
#include <fmt/format.h>

#include <algorithm>

#include "ghosttile/export/formats.h"
#include "ghosttile/export/groups.h"
#include "ghosttile/export/side_files.h"
#include "ghosttile/export/writer.h"
#include "silvasim/base/words.h"

namespace ghosttile::exports {

namespace {

// What all instances of an object share. Texture coordinates stand once in the file, as corners name them by number.
struct Shared {
  std::string name;
  std::vector<Group> groups;
  std::vector<std::string> materials;  // by the model's material
  bool textured = false;
  std::uint64_t first_uv = 0;
  std::uint64_t instances = 0;  // so far
};

float share(float x) { return std::clamp(x, 0.0f, 1.0f); }

std::string library_entry(const std::string& name, const assets::Material& material, const std::string& texture) {
  std::string text = fmt::format("newmtl {}\nKd {} {} {}\nKs 0 0 0\nillum 1\n", name, share(material.reflectance.x),
                                 share(material.reflectance.y), share(material.reflectance.z));
  if (texture.empty()) return text + "\n";
  text += "map_Kd " + texture + "\n";
  if (material.alpha_cutoff > 0) text += "map_d " + texture + "\n";
  return text + "\n";
}

void write_y_up(Writer& out, std::string_view word, const V3& v) {
  out << word << v.x << ' ' << v.z << ' ' << -v.y << '\n';
}

void write_head(Writer& out, const Survey& all, const std::string& library, const std::string& crs_wkt) {
  out << "# " << all.instances << " instances, " << all.triangles << " triangles, metres\n"
      << "# origin_m " << all.origin.x << ' ' << all.origin.y << ' ' << all.origin.z << '\n'
      << "# a vertex (x, y, z) is at origin + (x, -z, y) of the scene, whose axes are east, north, up\n";
  if (!crs_wkt.empty()) out << "# crs " << silvasim::base::printable(crs_wkt) << '\n';
  if (all.instances > 0) out << "mtllib " << library << '\n';
}

void write_instance(Writer& out, const fill::Instance& instance, const V3d& origin, const assets::Model& model,
                    Shared& shared, std::uint64_t first) {
  out << "o " << shared.name << '_' << ++shared.instances << '\n';
  for (const V3& p : model.positions) write_y_up(out, "v ", placed(instance, origin, p));
  for (const V3& n : model.normals) write_y_up(out, "vn ", instance.rotation(n));
  for (const Group& group : shared.groups) {
    out << "usemtl " << shared.materials[group.material] << '\n';
    for (const auto& triangle : group.triangles) {
      out << 'f';
      for (const std::uint32_t corner : triangle) {
        out << ' ' << first + corner << '/';
        if (shared.textured) out << shared.first_uv + corner;
        out << '/' << first + corner;
      }
      out << '\n';
    }
  }
}

}  // namespace

void write_obj(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options) {
  const Survey all = survey(file);
  check_triangles(all, "obj");
  Writer out(path, options.inputs);
  SideFiles beside(path, options.inputs);
  const auto textures = add_textures(beside, file, all);

  // Name objects and materials, and write the library.
  UniqueNames object_names, material_names;
  std::string library;
  std::vector<Shared> shared(file.tile->objects.size());
  for (const std::size_t o : all.used) {
    const objects::Detail& object = file.tile->objects[o];
    shared[o].name = object_names(word_of(object.name));
    shared[o].groups = groups_of(object.model);
    shared[o].textured = textured(object.model);
    for (const assets::Material& material : object.model.materials) {
      const std::string name = material_names(word_of(material.name.empty() ? object.name : material.name));
      const bool plain = material.texture == assets::no_texture;
      library += library_entry(name, material, plain ? "" : textures[o][static_cast<std::size_t>(material.texture)]);
      shared[o].materials.push_back(name);
    }
  }
  const std::string library_name = all.used.empty() ? "" : beside.add(".mtl", library);

  write_head(out, all, library_name, options.crs_wkt);
  std::uint64_t first_uv = 1;
  for (const std::size_t o : all.used) {
    if (!shared[o].textured) continue;
    shared[o].first_uv = first_uv;
    first_uv += file.tile->objects[o].model.uvs.size();
    for (const V2& uv : file.tile->objects[o].model.uvs) out << "vt " << uv.x << ' ' << 1 - uv.y << '\n';
  }
  std::uint64_t first = 1;
  Passes(file, all, options.progress, 1).run([&](const fill::Instance& instance) {
    const assets::Model& model = file.tile->objects[instance.object].model;
    write_instance(out, instance, all.origin, model, shared[instance.object], first);
    first += model.positions.size();
  });
  beside.commit();
  out.commit();
}

}  // namespace ghosttile::exports
