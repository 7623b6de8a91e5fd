// OpenUSD's text form: an Xform at the origin, in it a PointInstancer, in that the models as its prototypes.
#include <algorithm>
#include <array>

#include "ghosttile/export/formats.h"
#include "ghosttile/export/survey.h"
#include "ghosttile/export/usda_prototype.h"
#include "silvasim/base/error.h"
#include "silvasim/base/words.h"

namespace ghosttile::exports {

namespace {

// Numbers for instances that tell tile and candidate: those of one box of tiles, candidate by candidate.
class Ids {
 public:
  explicit Ids(const fill::DetailsFile& file) : box_(file.filled), candidates_(file.tile->candidates.size()) {
    // Of all that was filled, so that ids stay; where that is too much for 63 bits, as when it has no bounds, of what stands.
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (attempt > 0) box_ = {};
      for (const fill::TilePlace& t : file.details.tiles) take_in(t);
      const double count =
          side(box_.x0, box_.x1) * side(box_.y0, box_.y1) * side(box_.z0, box_.z1) * static_cast<double>(candidates_);
      if (count < 9e18) return;
    }
    throw silvasim::base::Error("the tiles are too far apart for usda's ids; csv holds any");
  }
  std::int64_t operator()(const fill::Instance& i) const {
    const std::int64_t nx = std::int64_t{box_.x1} - box_.x0, ny = std::int64_t{box_.y1} - box_.y0;
    const std::int64_t x = std::int64_t{i.tile.x} - box_.x0, y = std::int64_t{i.tile.y} - box_.y0,
                       z = std::int64_t{i.tile.z} - box_.z0;
    return ((z * ny + y) * nx + x) * static_cast<std::int64_t>(candidates_) + i.candidate;
  }
  std::string meaning() const {
    std::string text = "An id is ((z * ";
    text += std::to_string(std::int64_t{box_.y1} - box_.y0) + " + y) * ";
    text += std::to_string(std::int64_t{box_.x1} - box_.x0) + " + x) * ";
    text += std::to_string(candidates_) + " + candidate, with the tile (x, y, z) counted from (";
    text += std::to_string(box_.x0) + ", " + std::to_string(box_.y0) + ", " + std::to_string(box_.z0) + ").";
    return text;
  }

 private:
  void take_in(const fill::TilePlace& t) {
    const fill::TileBox one{t.x, t.y, t.z, t.x + 1, t.y + 1, t.z + 1};
    if (box_.empty()) box_ = one;
    box_ = {std::min(box_.x0, one.x0), std::min(box_.y0, one.y0), std::min(box_.z0, one.z0),
            std::max(box_.x1, one.x1), std::max(box_.y1, one.y1), std::max(box_.z1, one.z1)};
  }
  static double side(int from, int to) { return static_cast<double>(to) - from; }

  fill::TileBox box_;
  std::size_t candidates_;
};

std::string documentation(const fill::DetailsFile& file, const Survey& all, const Ids& ids, const std::string& crs) {
  std::string text = std::to_string(all.instances) + " details";
  if (!file.scene.empty()) text += " of " + file.scene;
  text += ". Metres; x east, y north, z up. " + ids.meaning();
  text += crs.empty() ? " The scene names no coordinate reference system." : " Coordinate reference system: " + crs;
  // Two characters would end the text or change it.
  std::string safe;
  for (const char c : silvasim::base::printable(text)) {
    if (c == '"' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe;
}

// An attribute of the instancer: a value an instance, several a line.
template <typename Value>
void write_column(Writer& out, Passes& passes, std::string_view type_and_name, const Value& value) {
  out << "\n        " << type_and_name << " = [";
  std::uint64_t i = 0;
  passes.run([&](const fill::Instance& instance) {
    if (i > 0) out << (i % 8 == 0 ? ",\n            " : ", ");
    ++i;
    value(instance);
  });
  out << "]\n";
}

}  // namespace

void write_usda(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options) {
  const Survey all = survey(file);
  const Ids ids(file);
  Writer out(path, options.inputs);
  SideFiles beside(path, options.inputs);
  const auto textures = add_textures(beside, file, all);

  UniqueNames names;
  std::vector<std::string> prototypes(file.tile->objects.size());
  std::vector<std::size_t> number(file.tile->objects.size(), 0);
  for (std::size_t k = 0; k < all.used.size(); ++k) {
    prototypes[all.used[k]] = names(identifier_of(file.tile->objects[all.used[k]].name));
    number[all.used[k]] = k;
  }

  out << "#usda 1.0\n(\n    defaultPrim = \"details\"\n    doc = \"" << documentation(file, all, ids, options.crs_wkt)
      << "\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n"
      << "def Xform \"details\" (\n    kind = \"assembly\"\n)\n{\n    double3 xformOp:translate = (" << all.origin.x
      << ", " << all.origin.y << ", " << all.origin.z << ")\n"
      << "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\n    def PointInstancer \"instances\"\n    {\n";
  const V3 least(all.least - all.origin), most(all.most - all.origin);
  if (all.instances > 0) {
    out << "        float3[] extent = [";
    write_tuple(out, {least.x, least.y, least.z});
    out << ", ";
    write_tuple(out, {most.x, most.y, most.z});
    out << "]\n";
  }
  out << "        rel prototypes = [";
  for (std::size_t k = 0; k < all.used.size(); ++k)
    out << (k > 0 ? ", " : "") << "</details/instances/prototypes/" << prototypes[all.used[k]] << '>';
  out << "]\n";

  Passes passes(file, all, options.progress, 5);
  using fill::Instance;
  write_column(out, passes, "int[] protoIndices", [&](const Instance& i) { out << number[i.object]; });
  write_column(out, passes, "int64[] ids", [&](const Instance& i) { out << ids(i); });
  write_column(out, passes, "point3f[] positions", [&](const Instance& i) {
    const V3 at(i.at - all.origin);
    write_tuple(out, {at.x, at.y, at.z});
  });
  write_column(out, passes, "quath[] orientations", [&](const Instance& i) {
    write_tuple(out, {i.rotation.w, i.rotation.x, i.rotation.y, i.rotation.z});
  });
  write_column(out, passes, "float3[] scales", [&](const Instance& i) {
    write_tuple(out, {i.scale, i.scale, i.scale});
  });

  out << "\n        def Scope \"prototypes\"\n        {\n";
  for (const std::size_t o : all.used) {
    write_prototype(out, file.tile->objects[o].model, prototypes[o], "/details/instances/prototypes/" + prototypes[o],
                    textures[o]);
  }
  out << "        }\n    }\n}\n";
  beside.commit();
  out.commit();
}

}  // namespace ghosttile::exports
