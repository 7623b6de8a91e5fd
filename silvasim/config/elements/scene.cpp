// <scene>: the piece of land, and <include>.
#include "silvasim/config/elements/elements.h"

namespace silvasim::config {

using VT = ValueType;

namespace {

constexpr double farthest = 1e9;  // metres; an ecosystem file takes no more

}  // namespace

std::vector<ElementRule> scene_rules() {
  return {
      {"Include",
       "include",
       "Takes in the elements of another file with the same root.",
       {},
       {},
       VT::path,
       true,
       "<include>common.xml</include>"},
      {"Scene",
       "scene",
       "The piece of land that is planted, and its coordinates.",
       {attribute(
           "crs", VT::name,
           "coordinate system: EPSG code, WKT or PROJ text, or \"local\" for metres without a place on the earth; "
           "default: the terrain's, or its UTM zone where the terrain is in degrees")},
       {{"Extent", 0, 1}, {"Size", 0, 1}},
       VT::none,
       true,
       "<scene crs=\"EPSG:32632\"><extent west=\"570000\" south=\"5725000\" east=\"574000\" "
       "north=\"5728000\"/></scene>"},
      {"Extent",
       "extent",
       "The scene's box, in the scene's coordinates or in degrees.",
       {required(within(attribute("west", VT::number, "least easting or longitude"), -farthest, farthest)),
        required(within(attribute("south", VT::number, "least northing or latitude"), -farthest, farthest)),
        required(within(attribute("east", VT::number, "greatest easting or longitude"), -farthest, farthest)),
        required(within(attribute("north", VT::number, "greatest northing or latitude"), -farthest, farthest)),
        attribute("degrees", VT::boolean, "the four numbers are degrees of WGS 84", "false")},
       {},
       VT::none,
       true,
       "<extent west=\"-121.9\" south=\"46.7\" east=\"-121.6\" north=\"46.9\" degrees=\"true\"/>"},
      {"Size",
       "size",
       "The scene's size: about the terrain's middle, or a local box from (0, 0).",
       {required(within(attribute("width", VT::length, "from west to east"), tiny, farthest)),
        required(within(attribute("height", VT::length, "from south to north"), tiny, farthest))},
       {},
       VT::none,
       true,
       "<size width=\"3 km\" height=\"3 km\"/>"},
  };
}

}  // namespace silvasim::config
