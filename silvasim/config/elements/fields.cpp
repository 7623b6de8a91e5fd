// <datafield>, <vectorfield>, <derivedfield>: what describes the place.
#include "silvasim/config/elements/elements.h"

namespace silvasim::config {

using VT = ValueType;

namespace {

// What every data field says about missing data.
std::vector<AttributeRule> with_no_data(std::vector<AttributeRule> attributes) {
  attributes.push_back(choice(
      "nodata", {"exclude", "ignore", "fill"},
      "where the field has no data: nothing grows, its evaluators say 1, or it has the value of fill", "exclude"));
  attributes.push_back(attribute("fill", VT::number, "the value where the field has no data, with nodata=\"fill\""));
  return attributes;
}

}  // namespace

std::vector<ElementRule> field_rules() {
  return {
      {"Datafield",
       "datafield",
       "A raster that describes the place: any format, coordinate system and resolution. An image without georeference "
       "is stretched over the scene and read as 0 to 1.",
       with_no_data(
           {required(attribute("name", VT::name, "the name by which evaluators ask for it")),
            attribute("terrain", VT::boolean, "it is the ground's height in metres", "false"),
            choice("kind", {"value", "class"}, "a quantity (read between its cells) or codes of classes (nearest cell)",
                   "value"),
            within(attribute("band", VT::integer, "which band of the file", "1"), 1, 65535),
            attribute("crs", VT::name, "its coordinate system where the file does not say it, or says it wrongly"),
            attribute("nodata-value", VT::number, "a value that means no data, besides what the file says"),
            attribute("scale", VT::number, "value = raw * scale + offset"),
            attribute("offset", VT::number, "value = raw * scale + offset")}),
       {},
       VT::path,
       true,
       "<datafield name=\"elevation\" terrain=\"true\">dem.tif</datafield>"},
      {"Vectorfield",
       "vectorfield",
       "Polygons, lines or points that describe the place, turned into a field.",
       with_no_data(
           {required(attribute("name", VT::name, "the name by which evaluators ask for it")),
            choice("measure", {"inside", "attribute", "distance"},
                   "1 inside and 0 outside, the value of an attribute, or metres to the nearest feature", "inside"),
            attribute("attribute", VT::name, "the attribute whose number is taken, with measure=\"attribute\""),
            choice("kind", {"value", "class"}, "a quantity or codes of classes", "value"),
            attribute("layer", VT::name, "which layer of the file; default: the first"),
            attribute("where", VT::text, "only features for which this is true, as in SQL: FTYPE = 'STREAM'"),
            attribute("crs", VT::name, "its coordinate system where the file does not say it, or says it wrongly"),
            within(attribute("resolution", VT::length,
                             "cell size of the field; default: a 2000th of the scene's longer side, 1 m at least"),
                   tiny)}),
       {},
       VT::path,
       true,
       "<vectorfield name=\"to_stream\" measure=\"distance\" where=\"FTYPE = 'STREAM'\">streams.shp</vectorfield>"},
      {"Derivedfield",
       "derivedfield",
       "A field computed from the terrain.",
       with_no_data(
           {required(attribute("name", VT::name, "the name by which evaluators ask for it")),
            required(
                choice("measure",
                       {"slope", "aspect", "northness", "eastness", "curvature", "tpi", "tri", "wetness", "hillshade"},
                       "slope and aspect in degrees; northness and eastness from -1 to 1; curvature in 1/m; "
                       "topographic position (tpi) and ruggedness (tri) in metres; wetness index; hillshade 0 to 1")),
            attribute("of", VT::name, "the field it is derived from; default: the terrain"),
            within(attribute("radius", VT::length, "of the disc for tpi; default: the eight neighbours"), tiny)}),
       {},
       VT::none,
       true,
       "<derivedfield name=\"slope\" measure=\"slope\"/>"},
  };
}

}  // namespace silvasim::config
