#include "silvavis/commands/spot.h"

#include "silvasim/config/elements/elements.h"
#include "silvasim/fields/field_set.h"

namespace silvavis::commands {

namespace config = silvasim::config;
namespace fields = silvasim::fields;
using VT = config::ValueType;

namespace {

constexpr double farthest_m = 1e8;

}  // namespace

std::vector<config::AttributeRule> spot_rules(const std::string& prefix, const std::string& what) {
  using config::attribute, config::choice, config::within;
  return {
      within(attribute(prefix + "x", VT::length, what + ": easting in the scene's metres"), -farthest_m, farthest_m),
      within(attribute(prefix + "y", VT::length, what + ": northing in the scene's metres"), -farthest_m, farthest_m),
      within(attribute(prefix + "longitude", VT::angle, "instead of x: degrees east of Greenwich"), -180, 180),
      within(attribute(prefix + "latitude", VT::angle, "instead of y: degrees north of the equator"), -90, 90),
      within(attribute(prefix + "height", VT::length, what + ": height"), -farthest_m, farthest_m),
      choice(prefix + "above", {"sea", "ground"}, "what the height counts from", "sea")};
}

std::optional<silvasim::base::Point> world_from_degrees(const scene::Scene& scene, double longitude_deg,
                                                        double latitude_deg) {
  const auto at = fields::scene_from_geographic({scene.crs_wkt, "", {}}, {latitude_deg, longitude_deg});
  if (!at) return std::nullopt;
  return silvasim::base::Point{at->x - scene.origin.x, at->y - scene.origin.y};
}

std::optional<Spot> spot_of(const config::Node& node, const std::string& prefix, const scene::Scene& scene,
                            std::vector<silvasim::base::Diagnostic>& errors) {
  const auto given = [&](const char* name) { return node.given(prefix + name); };
  const std::string tag = "<" + node.rule->tag + ">";
  const bool metres = given("x") || given("y"), degrees = given("longitude") || given("latitude");
  if (!metres && !degrees && !given("height") && !given("above")) return std::nullopt;
  const auto wrong = [&](const std::string& message) {
    silvasim::base::add(errors, node.place, tag + " " + message);
    return std::nullopt;
  };
  if (metres && degrees) return wrong("has both metres and degrees; one pair is enough");
  if (degrees ? !(given("longitude") && given("latitude")) : !(given("x") && given("y"))) {
    return wrong("needs both \"" + prefix + (degrees ? "longitude\" and \"" : "x\" and \"") + prefix +
                 (degrees ? "latitude\"" : "y\"") + (metres || degrees ? "" : ", or longitude and latitude"));
  }
  if (!given("height")) return wrong("needs the attribute \"" + prefix + "height\"");
  const auto number = [&](const char* name) { return node.has(prefix + name) ? node.number(prefix + name) : 0.0; };
  Spot spot;
  if (degrees) {
    if (scene.crs_wkt.empty()) return wrong("is in degrees, but the scene has no CRS; give x and y in its metres");
    const auto at = world_from_degrees(scene, number("longitude"), number("latitude"));
    if (!at) return wrong("lies where the scene's CRS has no map");
    spot.at = {at->x, at->y, 0};
  } else {
    spot.at = {number("x") - scene.origin.x, number("y") - scene.origin.y, 0};
  }
  spot.height_m = number("height");
  spot.above_ground = node.string(prefix + "above") == "ground";
  spot.at.z = spot.height_m;
  if (spot.above_ground) spot.at.z += scene::ground_at(scene.ground, spot.at.x, spot.at.y).height_m;
  return spot;
}

}  // namespace silvavis::commands
