#include "silvavis/commands/path.h"

#include <algorithm>
#include <array>

#include "silvasim/base/file.h"
#include "silvasim/config/elements/elements.h"
#include "silvasim/config/xml.h"
#include "silvasim/terminal/terminal.h"
#include "silvavis/commands/path_geojson.h"
#include "silvavis/commands/spot.h"

namespace silvavis::commands {

namespace {

namespace base = silvasim::base;
namespace config = silvasim::config;
using VT = config::ValueType;
using Diagnostics = std::vector<base::Diagnostic>;

constexpr double longest_s = 24 * 3600;

config::Dialect path_dialect() {
  using config::attribute, config::within;
  std::vector<config::AttributeRule> point = spot_rules("", "the eye");
  for (config::AttributeRule& rule : spot_rules("look-", "what it looks at")) point.push_back(std::move(rule));
  point.push_back(
      within(attribute("heading", VT::angle, "where it looks, clockwise from the grid's north"), -360, 360));
  point.push_back(within(attribute("pitch", VT::angle, "how far up it looks, with heading"), -90, 90));
  point.push_back(within(attribute("time", VT::duration, "when the eye is there"), 0, longest_s));
  config::Dialect dialect;
  dialect.rules = {
      {"Path",
       "path",
       "A flight through points.",
       {within(attribute("fps", VT::number, "frames a second"), 0.01, 1000),
        within(attribute("duration", VT::duration, "of the whole flight"), config::tiny, longest_s),
        within(attribute("fov", VT::angle, "horizontal angle of view"), 0.01, 170)},
       {{"PathPoint", 2}},
       VT::none,
       true,
       ""},
      {"PathPoint", "point", "A point that the eye goes through.", std::move(point), {}, VT::none, true, ""}};
  return dialect;
}

PathPoint point_of(const config::Node& node, const scene::Scene& scene, Diagnostics& errors) {
  PathPoint point;
  const std::size_t before = errors.size();
  if (const auto eye = spot_of(node, "", scene, errors)) {
    point.eye = eye->at;
    point.height_m = eye->height_m;
    point.above_ground = eye->above_ground;
  } else if (errors.size() == before) {
    base::add(errors, node.place, "<point> needs \"x\" and \"y\", or \"longitude\" and \"latitude\", and \"height\"");
  }
  const auto look = spot_of(node, "look-", scene, errors);
  if (look) point.look_at = look->at;
  if (node.has("heading")) point.heading_deg = node.number("heading");
  if (node.has("pitch")) point.pitch_deg = node.number("pitch");
  if (look && (node.given("heading") || node.given("pitch")))
    base::add(errors, node.place, "<point> has both a place to look at and a heading; one is enough");
  if (node.given("pitch") && !node.given("heading"))
    base::add(errors, node.place_of("pitch"), "<point> has a pitch without a heading");
  if (look && errors.size() == before && (look->at - point.eye).length() < least_distance_m)
    base::add(errors, node.place, "<point> looks at the place where the eye is");
  if (node.has("time")) point.time_s = node.number("time");
  return point;
}

// Times stand everywhere or nowhere, and go on.
void check_times(const config::Node& path, const FlightPath& result, Diagnostics& errors) {
  const std::vector<PathPoint>& points = result.points;
  const bool timed =
      std::any_of(points.begin(), points.end(), [](const PathPoint& point) { return point.time_s.has_value(); });
  if (timed && result.duration_s)
    base::add(errors, path.place_of("duration"), "<path> has a duration, and its points have times; one is enough");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const config::Node& node = path.children[i];
    if (timed && !points[i].time_s) {
      base::add(errors, node.place, "<point> needs the attribute \"time\", because other points have one");
    } else if (timed && i > 0 && points[i - 1].time_s && !(*points[i].time_s > *points[i - 1].time_s)) {
      base::add(errors, node.place_of("time"), "<point> time: it is not later than that of the point before");
    } else if (!timed && i > 0 && (points[i].eye - points[i - 1].eye).length() < least_distance_m) {
      base::add(errors, node.place, "<point> is where the one before is; to stay there, give all points a time");
    }
  }
}

}  // namespace

FlightPath read_path(const std::filesystem::path& file, const scene::Scene& scene,
                     std::optional<double> height_above_ground_m) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (ending == ".geojson" || ending == ".json") return read_geojson_path(file, scene, height_above_ground_m);
  if (ending != ".xml")
    silvasim::terminal::wrong_option("the path \"" + file.string() + "\" should end in .xml, .geojson or .json");
  if (height_above_ground_m)
    silvasim::terminal::wrong_option("--height-above-ground is for GeoJSON; in XML each point says height and above");

  const config::Dialect dialect = path_dialect();
  Diagnostics errors;
  FlightPath result;
  const auto tree =
      config::parse_xml(base::read_file(file, config::most_config_bytes), file.string(), dialect, "Path", errors);
  if (tree) {
    if (tree->has("fps")) result.fps = tree->number("fps");
    if (tree->has("duration")) result.duration_s = tree->number("duration");
    if (tree->has("fov")) result.fov_deg = tree->number("fov");
    for (const config::Node& node : tree->children) result.points.push_back(point_of(node, scene, errors));
    if (errors.empty()) check_times(*tree, result, errors);
  }
  if (!errors.empty()) throw base::ConfigError(std::move(errors));
  return result;
}

}  // namespace silvavis::commands
