#include "ghosttile/export/formats.h"
#include "ghosttile/export/survey.h"
#include "ghosttile/export/writer.h"
#include "silvasim/base/words.h"

namespace ghosttile::exports {

namespace {

// In quotes where a comma or a quote would break the row.
std::string quoted(const std::string& name) {
  const std::string text = silvasim::base::printable(name);
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

void write_csv(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options) {
  const Survey all = survey(file);
  std::vector<std::string> names;
  for (const objects::Detail& object : file.tile->objects) names.push_back(quoted(object.name));
  Writer out(path, options.inputs);
  out << "object,x,y,z,qw,qx,qy,qz,scale,tile_x,tile_y,tile_z,candidate\n";
  Passes(file, all, options.progress, 1).run([&](const fill::Instance& i) {
    out << names[i.object] << ',' << i.at.x << ',' << i.at.y << ',' << i.at.z << ',' << i.rotation.w << ','
        << i.rotation.x << ',' << i.rotation.y << ',' << i.rotation.z << ',' << i.scale << ',' << i.tile.x << ','
        << i.tile.y << ',' << i.tile.z << ',' << i.candidate << '\n';
  });
  out.commit();
}

}  // namespace ghosttile::exports
