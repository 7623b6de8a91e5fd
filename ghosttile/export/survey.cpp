#include "ghosttile/export/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ghosttile/export/formats.h"
#include "silvasim/base/error.h"

namespace ghosttile::exports {

namespace {

void check(const objects::Detail& object, const fill::Instance& instance) {
  const tile::Rotation& r = instance.rotation;
  const double sum =
      instance.at.x + instance.at.y + instance.at.z + static_cast<double>(instance.scale + r.w + r.x + r.y + r.z);
  if (std::isfinite(sum)) return;
  throw silvasim::base::Error(
      fmt::format("candidate {} (\"{}\") in tile ({}, {}, {}) has a place, turn or scale that is no number; create the "
                  "Ghost Tile anew",
                  instance.candidate, object.name, instance.tile.x, instance.tile.y, instance.tile.z));
}

float radius_of(const assets::Model& model) {
  float most = 0;
  for (const V3& p : model.positions) most = std::max(most, p.length2());
  return std::sqrt(most);
}

}  // namespace

Survey survey(const fill::DetailsFile& file) {
  const std::vector<objects::Detail>& objects = file.tile->objects;
  std::vector<double> radii_m;
  for (const objects::Detail& object : objects) radii_m.push_back(static_cast<double>(radius_of(object.model)));
  Survey result;
  result.of_object.assign(objects.size(), 0);
  fill::for_each_instance(*file.tile, file.details, [&](const fill::Instance& instance) {
    check(objects[instance.object], instance);
    const V3d reach(radii_m[instance.object] * static_cast<double>(instance.scale));
    const V3d low = instance.at - reach, high = instance.at + reach;
    if (result.instances++ == 0) {
      result.least = low;
      result.most = high;
    }
    for (int axis = 0; axis < 3; ++axis) {
      result.least[axis] = std::min(result.least[axis], low[axis]);
      result.most[axis] = std::max(result.most[axis], high[axis]);
    }
    ++result.of_object[instance.object];
  });
  for (std::size_t o = 0; o < objects.size(); ++o) {
    result.triangles += result.of_object[o] * objects[o].model.triangles.size();
    if (result.of_object[o] > 0) result.used.push_back(o);
  }
  for (int axis = 0; axis < 3; ++axis)
    result.origin[axis] = std::floor((result.least[axis] + result.most[axis]) / 2 / 100 + 0.5) * 100;
  return result;
}

void check_triangles(const Survey& survey, std::string_view format) {
  if (survey.triangles <= most_triangles) return;
  throw silvasim::base::Error(fmt::format(
      "{} instances are {} triangles, too many for {} (at most {}); usda and csv hold any number of instances",
      survey.instances, survey.triangles, format, most_triangles));
}

}  // namespace ghosttile::exports
