#include "ghosttile/export/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "silvasim/base/error.h"

namespace ghosttile::exports {

namespace base = silvasim::base;

const std::vector<Format>& formats() {
  static const std::vector<Format> table = {
      {"csv", {".csv"}, "comma-separated values with a row an instance, for spreadsheets, R and QGIS", &write_csv},
      {"usda",
       {".usda"},
       "OpenUSD with a point instancer, for programs of films; any number of instances",
       &write_usda},
      {"gltf",
       {".glb", ".gltf"},
       "glTF 2.0 with a node an instance, for Blender and the web; up to 200,000 instances",
       &write_gltf},
      {"obj",
       {".obj"},
       "Wavefront OBJ with all triangles, materials and textures; up to 50 million triangles",
       &write_obj},
      {"ply", {".ply"}, "PLY with all triangles and their colours; up to 50 million triangles", &write_ply},
  };
  return table;
}

const Format& format_for(const std::string& name, const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::vector<std::string> names;
  for (const Format& format : formats()) {
    const auto& known = format.extensions;
    const bool by_extension = name.empty() && std::find(known.begin(), known.end(), extension) != known.end();
    if (format.name == name || by_extension) return format;
    names.push_back(format.name);
  }
  const std::string one_of = fmt::format("; give one of {}", fmt::join(names, ", "));
  if (name.empty()) {
    throw base::ConfigError(
        {"--to"}, fmt::format("the name \"{}\" does not tell the format{}", path.filename().string(), one_of));
  }
  const std::string near = base::did_you_mean(name, names);
  throw base::ConfigError({"--to"}, fmt::format("there is no format \"{}\"{}", name, near.empty() ? one_of : near));
}

}  // namespace ghosttile::exports
