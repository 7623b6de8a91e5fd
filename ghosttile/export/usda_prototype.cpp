#include "ghosttile/export/usda_prototype.h"

#include <algorithm>

#include "ghosttile/export/groups.h"

namespace ghosttile::exports {

namespace {

constexpr std::string_view indent = "                ";  // of what stands in a prototype

// A list with several values a line; `value(i)` writes one.
template <typename Value>
void write_list(Writer& out, std::size_t count, const Value& value) {
  out << '[';
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) out << ", ";
    if (i % 16 == 15) out << '\n' << indent << "    ";
    value(i);
  }
  out << ']';
}

void write_vectors(Writer& out, const std::vector<V3>& vectors) {
  write_list(out, vectors.size(), [&](std::size_t i) { write_tuple(out, {vectors[i].x, vectors[i].y, vectors[i].z}); });
}

void write_mesh(Writer& out, const assets::Model& model, const std::vector<Group>& groups,
                const std::vector<std::string>& materials, const std::string& prim) {
  V3 least = model.positions[0], most = least;
  for (const V3& p : model.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      most[axis] = std::max(most[axis], p[axis]);
    }
  }
  bool two_sided = false;
  std::vector<std::uint32_t> corners;
  for (const Group& group : groups) {
    two_sided = two_sided || model.materials[group.material].two_sided;
    for (const auto& triangle : group.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  }

  out << indent << "def Mesh \"mesh\" (\n" << indent << "    prepend apiSchemas = [\"MaterialBindingAPI\"]\n";
  out << indent << ")\n" << indent << "{\n";
  const auto attribute = [&](std::string_view text) -> Writer& { return out << indent << "    " << text << " = "; };
  attribute("uniform bool doubleSided") << (two_sided ? "1\n" : "0\n");
  attribute("uniform token subdivisionScheme") << "\"none\"\n";
  attribute("float3[] extent") << '[';
  write_tuple(out, {least.x, least.y, least.z});
  out << ", ";
  write_tuple(out, {most.x, most.y, most.z});
  out << "]\n";
  attribute("int[] faceVertexCounts");
  write_list(out, corners.size() / 3, [&](std::size_t) { out << '3'; });
  out << '\n';
  attribute("int[] faceVertexIndices");
  write_list(out, corners.size(), [&](std::size_t i) { out << corners[i]; });
  out << '\n';
  attribute("point3f[] points");
  write_vectors(out, model.positions);
  out << '\n';
  attribute("normal3f[] normals");
  write_vectors(out, model.normals);
  out << " (\n" << indent << "        interpolation = \"vertex\"\n" << indent << "    )\n";
  if (textured(model)) {
    attribute("texCoord2f[] primvars:st");
    write_list(out, model.uvs.size(), [&](std::size_t i) { write_tuple(out, {model.uvs[i].x, 1 - model.uvs[i].y}); });
    out << " (\n" << indent << "        interpolation = \"vertex\"\n" << indent << "    )\n";
  }

  // Bind one material to all of it, or several to its parts.
  const auto bind = [&](const Group& group) {
    attribute("rel material:binding") << '<' << prim << "/materials/" << materials[group.material] << ">\n";
  };
  if (groups.size() == 1) {
    bind(groups[0]);
  } else {
    attribute("uniform token subsetFamily:materialBind:familyType") << "\"partition\"\n";
    std::size_t first = 0;
    for (const Group& group : groups) {
      out << '\n' << indent << "    def GeomSubset \"" << materials[group.material] << "\" (\n";
      out << indent << "        prepend apiSchemas = [\"MaterialBindingAPI\"]\n" << indent << "    )\n";
      out << indent << "    {\n";
      attribute("uniform token elementType") << "\"face\"\n";
      attribute("uniform token familyName") << "\"materialBind\"\n";
      attribute("int[] indices");
      write_list(out, group.triangles.size(), [&](std::size_t i) { out << first + i; });
      out << '\n';
      bind(group);
      out << indent << "    }\n";
      first += group.triangles.size();
    }
  }
  out << indent << "}\n";
}

void write_material(Writer& out, const assets::Material& material, const std::string& name, const std::string& prim,
                    const std::string& texture) {
  const std::string path = prim + "/materials/" + name;
  const assets::Rgb& colour = material.reflectance;
  const auto line = [&](std::string_view text) -> Writer& { return out << indent << "        " << text; };
  out << indent << "    def Material \"" << name << "\"\n" << indent << "    {\n";
  line("token outputs:surface.connect = <") << path << "/surface.outputs:surface>\n\n";
  line("def Shader \"surface\"\n");
  line("{\n");
  line("    uniform token info:id = \"UsdPreviewSurface\"\n");
  if (texture.empty()) {
    line("    color3f inputs:diffuseColor = ");
    write_tuple(out, {colour.x, colour.y, colour.z});
    out << '\n';
  } else {
    line("    color3f inputs:diffuseColor.connect = <") << path << "/texture.outputs:rgb>\n";
    if (material.alpha_cutoff > 0) {
      line("    float inputs:opacity.connect = <") << path << "/texture.outputs:a>\n";
      line("    float inputs:opacityThreshold = ") << material.alpha_cutoff << '\n';
    }
  }
  line("    float inputs:roughness = 1\n");
  line("    float inputs:metallic = 0\n");
  line("    token outputs:surface\n");
  line("}\n");
  if (!texture.empty()) {
    out << '\n';
    line("def Shader \"texture\"\n");
    line("{\n");
    line("    uniform token info:id = \"UsdUVTexture\"\n");
    line("    asset inputs:file = @./") << texture << "@\n";
    line("    token inputs:sourceColorSpace = \"sRGB\"\n");
    line("    token inputs:wrapS = \"repeat\"\n");
    line("    token inputs:wrapT = \"repeat\"\n");
    line("    float4 inputs:scale = ");
    write_tuple(out, {colour.x, colour.y, colour.z, 1});
    out << '\n';
    line("    float2 inputs:st.connect = <") << path << "/coordinates.outputs:result>\n";
    line("    float3 outputs:rgb\n");
    line("    float outputs:a\n");
    line("}\n\n");
    line("def Shader \"coordinates\"\n");
    line("{\n");
    line("    uniform token info:id = \"UsdPrimvarReader_float2\"\n");
    line("    string inputs:varname = \"st\"\n");
    line("    float2 outputs:result\n");
    line("}\n");
  }
  out << indent << "    }\n";
}

}  // namespace

void write_prototype(Writer& out, const assets::Model& model, const std::string& name, const std::string& prim,
                     const std::vector<std::string>& textures) {
  const std::vector<Group> groups = groups_of(model);
  UniqueNames unique;
  std::vector<std::string> materials;
  for (const assets::Material& material : model.materials)
    materials.push_back(unique(identifier_of(material.name.empty() ? name : material.name)));

  out << "            def Xform \"" << name
      << "\" (\n                kind = \"component\"\n            )\n            {\n";
  write_mesh(out, model, groups, materials, prim);
  out << '\n' << indent << "def Scope \"materials\"\n" << indent << "{\n";
  for (const Group& group : groups) {
    const assets::Material& material = model.materials[group.material];
    const bool plain = material.texture == assets::no_texture;
    write_material(out, material, materials[group.material], prim,
                   plain ? "" : textures[static_cast<std::size_t>(material.texture)]);
  }
  out << indent << "}\n            }\n\n";
}

}  // namespace ghosttile::exports
