#include "silvavis/commands/path_geojson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/base/words.h"
#include "silvasim/fields/crs.h"
#include "silvasim/fields/field_set.h"

namespace silvavis::commands {

namespace {

namespace base = silvasim::base;
namespace fields = silvasim::fields;
using Json = nlohmann::json;

constexpr std::size_t most_bytes = std::size_t{64} << 20;
constexpr std::size_t most_points = 100000;
constexpr double farthest_m = 1e8;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message, int line = 0, int column = 0) {
  throw base::ConfigError({file.string(), line, column}, message);
}

Json parsed(const std::filesystem::path& file) {
  const std::string text = base::read_file(file, most_bytes);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
    const auto begin = text.begin(), end = begin + static_cast<std::ptrdiff_t>(at);
    const int line = 1 + static_cast<int>(std::count(begin, end, '\n'));
    const std::size_t newline = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    fail(file, "not well-formed JSON", line, static_cast<int>(newline == std::string::npos ? at + 1 : at - newline));
  } catch (const Json::exception&) {
    fail(file, "it holds a number that is too large");
  }
}

std::string type_of(const Json& object) {
  if (!object.is_object()) return "";
  const auto type = object.find("type");
  return type != object.end() && type->is_string() ? type->get<std::string>() : "";
}

std::string shown(const std::string& type) { return type.empty() ? "nothing" : base::shortened(type, 40); }

// The coordinates of the one line in the file.
const Json& line_in(const std::filesystem::path& file, const Json& root) {
  const Json* object = &root;
  if (type_of(*object) == "FeatureCollection") {
    const auto features = object->find("features");
    if (features == object->end() || !features->is_array() || features->empty())
      fail(file, "its FeatureCollection holds no feature; a path is one LineString");
    if (features->size() > 1)
      fail(file, fmt::format("it holds {} features; a path is one LineString", features->size()));
    object = &(*features)[0];
  }
  if (type_of(*object) == "Feature") {
    const auto geometry = object->find("geometry");
    if (geometry == object->end() || !geometry->is_object()) fail(file, "its feature has no geometry");
    object = &*geometry;
  }
  const std::string type = type_of(*object);
  const auto coordinates = object->is_object() ? object->find("coordinates") : object->end();
  if (type == "MultiLineString" && coordinates != object->end() && coordinates->is_array() && coordinates->size() == 1)
    return (*coordinates)[0];
  if (type != "LineString") fail(file, "it holds " + shown(type) + "; a path is one LineString");
  if (coordinates == object->end()) fail(file, "its LineString has no coordinates");
  return *coordinates;
}

// From the file's coordinates to the scene's.
fields::Transformation way_of(const std::filesystem::path& file, const Json& root, const scene::Scene& scene) {
  if (scene.crs_wkt.empty()) return {nullptr, nullptr};
  fields::Crs from = fields::wgs84();
  if (const auto crs = root.is_object() ? root.find("crs") : root.end(); crs != root.end() && crs->is_object()) {
    const auto properties = crs->find("properties");
    const auto name = properties != crs->end() && properties->is_object() ? properties->find("name") : crs->end();
    if (properties == crs->end() || !properties->is_object() || name == properties->end() || !name->is_string())
      fail(file, "its \"crs\" has no name; write it without one, in degrees of WGS 84");
    try {
      from = fields::crs_from_text(name->get<std::string>());
    } catch (const base::Error& error) {
      fail(file, error.what());
    }
  }
  try {
    return {from, fields::crs_from_text(scene.crs_wkt)};
  } catch (const base::Error& error) {
    fail(file, error.what());
  }
}

}  // namespace

FlightPath read_geojson_path(const std::filesystem::path& file, const scene::Scene& scene,
                             std::optional<double> height_above_ground_m) {
  const Json root = parsed(file);
  const Json& line = line_in(file, root);
  if (!line.is_array() || line.size() < 2)
    fail(file, fmt::format("its line has {}; a path needs two points at least",
                           line.is_array() && line.size() == 1 ? "one point" : "no points"));
  if (line.size() > most_points)
    fail(file, fmt::format("its line has {} points; a path has at most {}", line.size(), most_points));
  const fields::Transformation to_scene = way_of(file, root, scene);

  FlightPath path;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Json& position = line[i];
    const bool numbers = position.is_array() && position.size() >= 2 && position.size() <= 4 &&
                         std::all_of(position.begin(), position.end(), [](const Json& n) { return n.is_number(); });
    if (!numbers) fail(file, fmt::format("point {} of its line is no position of two or three numbers", i + 1));
    if (position.size() < 3 && !height_above_ground_m) {
      fail(file, fmt::format("point {} of its line has no height; give heights above the sea as third numbers, or "
                             "--height-above-ground 60",
                             i + 1));
    }
    const auto at = to_scene.apply(base::Point{position[0].get<double>(), position[1].get<double>()});
    if (!at || !(std::abs(at->x) < farthest_m && std::abs(at->y) < farthest_m)) {
      fail(file, fmt::format("point {} of its line, ({:g}, {:g}), has no place in the scene's CRS", i + 1,
                             position[0].get<double>(), position[1].get<double>()));
    }
    PathPoint point;
    point.eye = {at->x - scene.origin.x, at->y - scene.origin.y, 0};
    point.above_ground = height_above_ground_m.has_value();
    point.height_m = height_above_ground_m ? *height_above_ground_m : position[2].get<double>();
    if (!(std::abs(point.height_m) < farthest_m))
      fail(file, fmt::format("point {} of its line is {:g} m high", i + 1, point.height_m));
    point.eye.z = point.height_m;
    if (point.above_ground) point.eye.z += scene::ground_at(scene.ground, point.eye.x, point.eye.y).height_m;
    // Lines drawn by hand have double points.
    if (path.points.empty() || (path.points.back().eye - point.eye).length() >= least_distance_m)
      path.points.push_back(point);
  }
  if (path.points.size() < 2) fail(file, "all points of its line are one; a path needs two at least");
  return path;
}

}  // namespace silvavis::commands
