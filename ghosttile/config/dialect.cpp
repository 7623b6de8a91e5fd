#include "ghosttile/config/dialect.h"

#include <algorithm>

#include "ghosttile/cover/rule_xml.h"
#include "ghosttile/objects/made/made.h"
#include "silvasim/config/elements/elements.h"

namespace ghosttile::config {

using xml::attribute;
using xml::choice;
using xml::ElementRule;
using xml::required;
using xml::within;
using VT = xml::ValueType;

namespace {

constexpr double most_seed = 9007199254740991.0;

xml::AttributeRule seed(const std::string& help) {
  return within(attribute("seed", VT::integer, help, "1"), 0, most_seed);
}
xml::AttributeRule count_of(const std::string& name, const std::string& help, const std::string& fallback,
                            double most) {
  return within(attribute(name, VT::integer, help, fallback), 1, most);
}
xml::AttributeRule at(const std::string& name, const std::string& help) {
  return required(attribute(name, VT::text, help + ": \"x, y, z\" in metres"));
}

std::vector<ElementRule> tile_rules() {
  std::vector<std::string> forms;
  for (const auto& form : objects::made::made_forms()) forms.push_back(form.name);
  return {
      {"GhostTile",
       "ghosttile",
       "A Ghost Tile: a cube of space with many more candidates than there is room for.",
       {within(attribute("side", VT::length, "of the cube; one to three times its largest object", "50 cm"), 1e-4, 1e5),
        within(attribute("delta", VT::length,
                         "candidates collide where the gap between their spheres is at most this; below 0 they may dip "
                         "into each other",
                         "0 m"),
               -1e4, 1e4),
        seed("decides where the candidates are and how they are turned")},
       {{"TileObject", 1}},
       VT::none,
       true,
       "<ghosttile side=\"50 cm\" delta=\"-2 mm\"><object name=\"stone\" made=\"stone\" count=\"300\"/></ghosttile>"},
      {"TileObject",
       "object",
       "One of the things that the tile repeats, and how its candidates are spread.",
       {required(attribute("name", VT::name, "by which scenes say where it may be")),
        attribute("model", VT::path, "a model file: OBJ, PLY, glTF"),
        choice("made", forms, "instead of a model: one that is made here"),
        within(attribute("length", VT::length,
                         "of what is made, or the longest side that a model file is scaled to; default: as it is"),
               xml::tiny, 100),
        choice("season", {"summer", "autumn", "winter"}, "of leaves, tufts and needles that are made", "autumn"),
        attribute("colour", VT::colour, "of what is made, instead of its own"),
        within(attribute("variant", VT::integer, "another number, another one of its kind", "0"), 0, most_seed),
        required(count_of("count", "candidates in the tile", "", 65535)),
        within(attribute("least-scale", VT::number, "of the candidates' sizes", "1"), 1e-3, 1e3),
        within(attribute("most-scale", VT::number, "of the candidates' sizes", "1"), 1e-3, 1e3),
        count_of(
            "spheres",
            "at most so many stand for it where collisions are looked for; default: as its form needs, 24 for a model",
            "", 1024),
        within(attribute("thickness", VT::length,
                         "radius of the spheres of what has no volume; default: as the number of spheres needs"),
               0, 100),
        choice("anchor", {"origin", "centre", "foot", "volume", "surface"},
               "where it asks the density: outside of it at any of these points it is left out", "origin"),
        count_of("anchors", "how many points within its volume or on its surface", "1", 256)},
       {{"Tilt"}, {"GivenSphere"}, {"GivenAnchor"}},
       VT::none,
       true,
       "<object name=\"beech leaf\" made=\"beech-leaf\" count=\"300\" least-scale=\"0.8\" most-scale=\"1.2\"><tilt "
       "to=\"30\"/></object>"},
      {"Tilt",
       "tilt",
       "A share of the candidates whose z-axis leans off the vertical by an angle between these. Without any, they are "
       "turned anyhow.",
       {within(attribute("from", VT::angle, "least angle", "0"), 0, 180),
        required(within(attribute("to", VT::angle, "greatest angle"), 0, 180)),
        within(attribute("share", VT::number, "relative to the other tilts", "1"), 0, 1e6)},
       {},
       VT::none,
       true,
       "<tilt from=\"45\" to=\"60\" share=\"0.25\"/>"},
      {"GivenSphere",
       "sphere",
       "A sphere of the object, by hand; then none are fitted.",
       {at("at", "its centre in the model's space"),
        required(within(attribute("radius", VT::length, "its radius"), xml::tiny))},
       {},
       VT::none,
       true,
       "<sphere at=\"0, 0, 0.02\" radius=\"1 cm\"/>"},
      {"GivenAnchor",
       "anchor",
       "An anchor of the object, by hand.",
       {at("at", "its place in the model's space")},
       {},
       VT::none,
       true,
       "<anchor at=\"0, 0, 0\"/>"},
  };
}

// What falls off around a skeleton or a solid.
std::vector<xml::AttributeRule> with_falloff(std::vector<xml::AttributeRule> own, const std::string& radius) {
  own.push_back(
      within(attribute("radius", VT::length, "the density falls from 1 to 0 within this distance of it", radius), 0));
  own.push_back(within(attribute("core", VT::fraction, "share of the radius within which the density is still 1", "0"),
                       0, 0.999));
  return own;
}

ElementRule primitive(std::string type, std::string tag, std::string help, std::vector<xml::AttributeRule> attributes,
                      std::string example) {
  return {std::move(type), std::move(tag), std::move(help),   std::move(attributes), {},
          VT::none,        true,           std::move(example)};
}

std::vector<ElementRule> primitive_rules() {
  const auto size = [](const std::string& help) { return required(within(attribute("size", VT::length, help), 0)); };
  std::vector<xml::AttributeRule> trunks = cover::choice_attributes();
  trunks.push_back(within(attribute("gap", VT::length, "kept free around the stem", "0 m"), 0, 10));
  std::vector<ElementRule> rules = {
      primitive("Everywhere", "constant", "The same density everywhere.",
                {required(within(attribute("value", VT::number, "the density"), 0, 1e6))}, "<constant value=\"0.3\"/>"),
      primitive("Point", "point", "A ball of density around a point.", with_falloff({at("at", "the point")}, "1 m"),
                "<point at=\"2, 3, 0\" radius=\"1.5 m\"/>"),
      primitive("Segment", "segment", "Density around a straight line.",
                with_falloff({at("from", "one end"), at("to", "the other")}, "1 m"),
                "<segment from=\"0, 0, 0\" to=\"4, 0, 0\" radius=\"50 cm\"/>"),
      primitive("Disc", "disc", "Density around a disc that lies flat.",
                with_falloff({at("at", "its middle"), size("its radius")}, "1 m"),
                "<disc at=\"0, 0, 0\" size=\"2 m\" radius=\"30 cm\"/>"),
      primitive("Box", "box", "A box.",
                with_falloff(
                    {at("at", "its middle"), required(attribute("size", VT::text, "its sides: \"x, y, z\" in metres")),
                     attribute("turn", VT::angle, "about the vertical, anticlockwise", "0")},
                    "0 m"),
                "<box at=\"0, 0, 0.5\" size=\"2, 1, 1\" turn=\"30\"/>"),
      primitive(
          "Cylinder", "cylinder", "A cylinder.",
          with_falloff({at("from", "the middle of one end"), at("to", "of the other"), size("its radius")}, "0 m"),
          "<cylinder from=\"0, 0, 0\" to=\"0, 0, 1.2\" size=\"60 cm\"/>"),
      primitive("Ball", "sphere", "A sphere.", with_falloff({at("at", "its centre"), size("its radius")}, "0 m"),
                "<sphere at=\"0, 0, 0\" size=\"1 m\"/>"),
      primitive("GroundLayer", "layer", "A layer over the ground.",
                {attribute("from", VT::length, "above the ground", "0 m"),
                 required(attribute("to", VT::length, "above the ground")),
                 within(attribute("radius", VT::length,
                                  "the density falls from 1 to 0 within this distance of it, up and down", "0 m"),
                        0)},
                "<layer to=\"6 cm\" radius=\"2 cm\"/>"),
      primitive("Trunks", "trunks", "The stems of the ecosystem's plants, as upright cylinders; for differences.",
                trunks, "<trunks layer=\"trees\" gap=\"1 cm\"/>"),
  };
  rules.push_back({"Curve",
                   "curve",
                   "Density along a line with corners.",
                   with_falloff({}, "1 m"),
                   {{"CurvePoint", 2}},
                   VT::none,
                   true,
                   "<curve radius=\"40 cm\"><to at=\"0, 0, 0\"/><to at=\"3, 1, 0\"/><to at=\"5, 0, 0\"/></curve>"});
  rules.push_back(
      primitive("CurvePoint", "to", "The curve's next corner.", {at("at", "where it is")}, "<to at=\"3, 1, 0\"/>"));
  return rules;
}

std::vector<ElementRule> operator_rules() {
  const auto rule = [](std::string type, std::string tag, std::string help, std::vector<xml::AttributeRule> attributes,
                       std::string example) {
    return ElementRule{std::move(type), std::move(tag), std::move(help),   std::move(attributes), {},
                       VT::none,        true,           std::move(example)};
  };
  return {
      rule("Blend", "blend", "The sum of what it holds, at most 1.", {}, "<blend>...</blend>"),
      rule("Union", "union", "The greatest of what it holds.", {}, "<union>...</union>"),
      rule("Intersection", "intersection", "The least of what it holds.", {}, "<intersection>...</intersection>"),
      rule("Difference", "difference", "The first without all others.", {},
           "<difference><layer to=\"6 cm\"/><trunks/></difference>"),
      rule("Multiply", "multiply", "The product of what it holds: a shape times rules.", {},
           "<multiply>...</multiply>"),
      rule("Scaled", "scaled", "What it holds, times a number.",
           {required(within(attribute("value", VT::number, "the number"), 0, 1e6))},
           "<scaled value=\"0.3\">...</scaled>"),
      rule("Warp", "warp", "What it holds, moved about by noise.",
           {required(within(attribute("distance", VT::length, "how far at most"), 0, 1e4)),
            within(attribute("wavelength", VT::length, "from one bulge to the next", "1 m"), 1e-3, 1e5),
            seed("of the noise")},
           "<warp distance=\"20 cm\" wavelength=\"80 cm\">...</warp>"),
      rule("Scatter", "scatter",
           "Copies of what it holds, at chance places of a rectangle, turned anyhow; heights are above the ground "
           "there.",
           {required(attribute("box", VT::text, "\"west, south, east, north\" in metres")),
            required(within(attribute("count", VT::integer, "how many"), 1, 10000)),
            within(attribute("apart", VT::length, "least distance between two", "0 m"), 0), seed("of the places")},
           "<scatter box=\"0, 0, 40, 40\" count=\"12\" apart=\"5 m\"><cylinder from=\"0,0,0\" to=\"0,0,1.5\" size=\"80 "
           "cm\"/></scatter>"),
  };
}

std::vector<ElementRule> scene_rules() {
  return {
      {"Details",
       "details",
       "A scene of details: which Ghost Tile, over which land, and where each of its objects may be.",
       {seed("decides every draw; the same seed gives the same details"),
        choice("priority", {"random", "elevation", "boundary"},
               "which candidates come first: any, for thin layers; the lowest, for piles; those near the surface",
               "random"),
        choice("ground", {"ecosystem", "flat", "none"},
               "what lies beneath: nothing is placed with an anchor below it; default: the ecosystem's land, or none"),
        within(attribute("sink", VT::length, "how deep below the ground anchors may lie", "0 m"), 0, 100),
        choice("heights", {"ground", "absolute"}, "what the z of places is measured from", "ground"),
        attribute("origin", VT::text, "\"x, y\" that places are measured from, in the land's coordinates", "0, 0"),
        within(attribute("month", VT::number, "time of the year, 1 to 13: 10.5 is the middle of October", "10.5"), 1,
               13)},
       {{"TileReference", 1, 1}, {"EcosystemReference", 0, 1}, {"Fill", 1}},
       VT::none,
       true,
       ""},
      {"TileReference",
       "tile",
       "The Ghost Tile: its XML, or the file that was created of it.",
       {},
       {},
       VT::path,
       true,
       "<tile>litter.xml</tile>"},
      {"EcosystemReference",
       "ecosystem",
       "The land: an ecosystem file, whose ground and plants rules ask for.",
       {attribute("fields", VT::path, "the XML that it was grown from, for rules over its data fields")},
       {},
       VT::path,
       true,
       "<ecosystem fields=\"../ecosystem.xml\">valley.silva</ecosystem>"},
      {"Fill",
       "fill",
       "Where one of the tile's objects may be, and how dense: one shape, times the rules.",
       {required(attribute("object", VT::name, "by its name in the tile")),
        within(attribute("density", VT::number,
                         "what the shape is multiplied with; where all objects' densities add up to less than 1, land "
                         "is left free",
                         "1"),
               0, 1e6)},
       {},
       VT::none,
       true,
       "<fill object=\"beech leaf\"><layer to=\"5 cm\"/><where><response><litter "
       "species=\"Fagus\"/></response></where></fill>"},
      {"DirectionRule",
       "direction",
       "Which way the object's z-axis must point.",
       {choice("kind", {"vertical", "constant", "gradient", "rotational", "radial", "normal"},
               "up; along `vector`; out of the shape; around or away from the upright line through `centre`; as the "
               "ground's normal",
               "vertical"),
        attribute("vector", VT::text, "\"x, y, z\"", "0, 0, 1"), attribute("centre", VT::text, "\"x, y\"", "0, 0"),
        within(attribute("least-cosine", VT::number, "of the angle between the two: 1 is exactly so, 0 at right angles",
                         "-1"),
               -1, 1),
        within(attribute("most-cosine", VT::number, "of the angle between the two", "1"), -1, 1)},
       {},
       VT::none,
       true,
       "<direction kind=\"gradient\" least-cosine=\"0.9\"/>"},
      {"LeastScale",
       "leastscale",
       "The least scale of candidates by place: a density element times `value`.",
       {within(attribute("value", VT::number, "times this", "1"), 0, 1e6)},
       {},
       VT::none,
       true,
       "<leastscale value=\"0.5\"><constant value=\"1\"/></leastscale>"},
      {"MostScale",
       "mostscale",
       "The greatest scale of candidates by place: a density element times `value`.",
       {within(attribute("value", VT::number, "times this", "1"), 0, 1e6)},
       {},
       VT::none,
       true,
       "<mostscale value=\"1.2\"><constant value=\"1\"/></mostscale>"},
      {"Strokes",
       "strokes",
       "An edit: strokes in their order.",
       {},
       {{"AddStroke"}, {"RemoveStroke"}},
       VT::none,
       true,
       ""},
      {"AddStroke",
       "add",
       "The object is where the shape is too.",
       {required(attribute("object", VT::name, "by its name in the tile; * for all"))},
       {},
       VT::none,
       true,
       "<add object=\"stone\"><sphere at=\"3, 4, 0\" size=\"60 cm\"/></add>"},
      {"RemoveStroke",
       "remove",
       "The object is no longer where the shape is.",
       {required(attribute("object", VT::name, "by its name in the tile; * for all"))},
       {},
       VT::none,
       true,
       "<remove object=\"*\"><sphere at=\"3, 4, 0\" size=\"60 cm\"/></remove>"},
  };
}

std::vector<std::string> types_of(const std::vector<ElementRule>& rules) {
  std::vector<std::string> types;
  for (const ElementRule& rule : rules) types.push_back(rule.type);
  return types;
}

xml::Dialect make() {
  xml::Dialect dialect;
  dialect.program = "ghosttile";
  dialect.about = "Ghost Tiles, scenes of details, and strokes";
  dialect.roots = {"Details", "GhostTile", "Strokes"};
  dialect.chapters = {{"Scenes", {"Details"}},
                      {"Ghost Tiles", types_of(tile_rules())},
                      {"Strokes", {"Strokes", "AddStroke", "RemoveStroke"}},
                      {"Densities: shapes", types_of(primitive_rules())},
                      {"Densities: operators", types_of(operator_rules())},
                      {"Rules over the land", types_of(cover::cover_rules())},
                      {"Properties", types_of(cover::property_rules())}};
  for (const auto& family : {tile_rules(), scene_rules(), primitive_rules(), operator_rules(), cover::cover_rules(),
                             cover::property_rules()})
    dialect.rules.insert(dialect.rules.end(), family.begin(), family.end());
  for (ElementRule& rule : dialect.rules) {
    static const std::vector<std::string> holders = {
        "Blend",   "Union", "Intersection", "Difference", "Multiply",  "Scaled",      "Warp",
        "Scatter", "Fill",  "LeastScale",   "MostScale",  "AddStroke", "RemoveStroke"};
    if (std::find(holders.begin(), holders.end(), rule.type) == holders.end()) continue;
    for (const std::string& type : density_types()) rule.children.push_back({type});
    if (rule.type == "Fill") {
      rule.children.push_back({"DirectionRule", 0, 1});
      rule.children.push_back({"LeastScale", 0, 1});
      rule.children.push_back({"MostScale", 0, 1});
    }
  }
  return dialect;
}

}  // namespace

const std::vector<std::string>& density_types() {
  static const std::vector<std::string> types = {"Everywhere", "Point",    "Segment", "Curve",        "Disc",
                                                 "Box",        "Cylinder", "Ball",    "GroundLayer",  "Trunks",
                                                 "Where",      "Blend",    "Union",   "Intersection", "Difference",
                                                 "Multiply",   "Scaled",   "Warp",    "Scatter"};
  return types;
}

const xml::Dialect& dialect() {
  static const xml::Dialect made = make();
  return made;
}

}  // namespace ghosttile::config
