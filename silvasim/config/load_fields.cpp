// <scene> and the data fields.
#include <algorithm>
#include <map>
#include <system_error>

#include "silvasim/config/loading.h"
#include "silvasim/config/value.h"

namespace silvasim::config {

namespace {

void read_no_data(Loading& loading, const Node& node, FieldSettings& field) {
  const std::string& policy = node.string("nodata");
  field.no_data = policy == "ignore" ? NoDataPolicy::ignore
                  : policy == "fill" ? NoDataPolicy::fill
                                     : NoDataPolicy::exclude;
  if (field.no_data == NoDataPolicy::fill) {
    if (!node.has("fill")) {
      loading.error(node.place_of("nodata"), "nodata=\"fill\" needs the attribute \"fill\"");
    } else {
      field.no_data_fill = node.number("fill");
    }
  } else if (node.given("fill")) {
    loading.error(node.place_of("fill"), "fill is used with nodata=\"fill\" only, and nodata is \"" + policy + "\"");
  }
}

void read_path(Loading& loading, const Node& node, FieldSettings& field) {
  std::error_code ignored;
  field.path = beside(node.place, node.text);
  if (!node.text.empty() && !std::filesystem::exists(field.path, ignored)) {
    loading.error(node.place, "data field \"" + field.name + "\": there is no file \"" + field.path.string() + "\"");
  }
}

FieldKind kind_of(const Node& node) {
  return node.string("kind") == "class" ? FieldKind::class_code : FieldKind::value;
}

// What every field says of itself.
FieldSettings begin_field(const Node& node, Source source) {
  FieldSettings field;
  field.name = node.string("name");
  field.place = node.place;
  field.source = source;
  return field;
}

FieldSettings read_raster(Loading& loading, const Node& node) {
  FieldSettings field = begin_field(node, Source::raster);
  field.kind = kind_of(node);
  field.terrain = node.boolean("terrain");
  field.band = static_cast<int>(node.number("band"));
  field.crs = node.string("crs");
  if (node.has("nodata-value")) field.no_data_value = node.number("nodata-value");
  field.scaled = node.has("scale") || node.has("offset");
  if (node.has("scale")) field.scale = node.number("scale");
  if (field.scale == 0) {
    loading.error(node.place_of("scale"),
                  "data field \"" + field.name + "\": scale=\"0\" would give every cell the same value, its offset");
  }
  if (node.has("offset")) field.offset = node.number("offset");
  if (field.terrain && field.kind == FieldKind::class_code) {
    loading.error(node.place_of("kind"), "a terrain is a quantity, not classes");
  }
  read_no_data(loading, node, field);
  read_path(loading, node, field);
  return field;
}

FieldSettings read_vector(Loading& loading, const Node& node) {
  FieldSettings field = begin_field(node, Source::vector);
  field.kind = kind_of(node);
  field.crs = node.string("crs");
  field.layer = node.string("layer");
  field.where = node.string("where");
  field.attribute = node.string("attribute");
  if (node.has("resolution")) field.resolution_m = node.number("resolution");
  const std::string& measure = node.string("measure");
  field.measure = measure == "distance"    ? VectorMeasure::distance
                  : measure == "attribute" ? VectorMeasure::attribute
                                           : VectorMeasure::inside;
  if (field.measure == VectorMeasure::attribute && field.attribute.empty()) {
    loading.error(node.place, "measure=\"attribute\" needs the attribute \"attribute\": the one whose number is taken");
  }
  if (field.measure != VectorMeasure::attribute && node.given("attribute")) {
    loading.error(node.place_of("attribute"), "attribute is used with measure=\"attribute\" only");
  }
  read_no_data(loading, node, field);
  read_path(loading, node, field);
  return field;
}

FieldSettings read_derived(Loading& loading, const Node& node) {
  static const std::map<std::string, TerrainMeasure> measures = {{"slope", TerrainMeasure::slope_deg},
                                                                 {"aspect", TerrainMeasure::aspect_deg},
                                                                 {"northness", TerrainMeasure::northness},
                                                                 {"eastness", TerrainMeasure::eastness},
                                                                 {"curvature", TerrainMeasure::curvature},
                                                                 {"tpi", TerrainMeasure::tpi},
                                                                 {"tri", TerrainMeasure::tri},
                                                                 {"wetness", TerrainMeasure::wetness},
                                                                 {"hillshade", TerrainMeasure::hillshade}};
  FieldSettings field = begin_field(node, Source::derived);
  field.derivation = measures.at(node.string("measure"));
  field.of = node.string("of");
  if (node.has("radius")) field.radius_m = node.number("radius");
  if (node.given("radius") && field.derivation != TerrainMeasure::tpi) {
    loading.error(node.place_of("radius"), "radius is used with measure=\"tpi\" only");
  }
  read_no_data(loading, node, field);
  return field;
}

// Every derived field must stand on a raster field that exists.
void check_derived(Loading& loading, const Scenario& scenario) {
  std::vector<std::string> rasters;
  const FieldSettings* terrain = nullptr;
  for (const FieldSettings& field : scenario.fields) {
    if (field.source == Source::raster) rasters.push_back(field.name);
    if (!field.terrain) continue;
    if (terrain) {
      loading.error(field.place, "data field \"" + field.name + "\" is a second terrain; the first is \"" +
                                     terrain->name + "\" at " + short_place(terrain->place));
    } else {
      terrain = &field;
    }
  }
  for (const FieldSettings& field : scenario.fields) {
    if (field.source != Source::derived) continue;
    if (field.of.empty()) {
      if (!terrain) {
        loading.error(field.place, "derived field \"" + field.name +
                                       "\" needs a terrain: a <datafield terrain=\"true\">, or of=\"...\"");
      }
    } else if (std::find(rasters.begin(), rasters.end(), field.of) == rasters.end()) {
      loading.error(field.place, "derived field \"" + field.name + "\" is of \"" + field.of +
                                     "\", which is no raster data field" + base::did_you_mean(field.of, rasters));
    }
  }
}

}  // namespace

void read_scene(Loading& loading, const Node& ecosystem, Scenario& scenario) {
  SceneSettings& scene = scenario.scene;
  scene.place = ecosystem.place;
  const Node* node = ecosystem.child("Scene");
  if (!node) return;
  scene.place = node->place;
  scene.crs = node->string("crs");
  const Node* extent = node->child("Extent");
  const Node* size = node->child("Size");
  if (extent && size) loading.error(size->place, "<scene> takes an <extent> or a <size>, not both");
  if (extent) {
    const base::Box box{extent->number("west"), extent->number("south"), extent->number("east"),
                        extent->number("north")};
    const bool degrees = extent->boolean("degrees");
    if (box.west >= box.east)
      loading.error(extent->place, "<extent> reversed or empty: west=\"" + to_text(box.west) +
                                       "\" is not less than east=\"" + to_text(box.east) + "\"");
    if (box.south >= box.north)
      loading.error(extent->place, "<extent> reversed or empty: south=\"" + to_text(box.south) +
                                       "\" is not less than north=\"" + to_text(box.north) + "\"");
    if (degrees && (box.west < -180 || box.east > 180 || box.south < -90 || box.north > 90)) {
      loading.error(extent->place, "<extent> in degrees lies outside -180 to 180 and -90 to 90");
    }
    (degrees ? scene.extent_geographic : scene.extent) = box;
  }
  if (size) {
    scene.width_m = size->number("width");
    scene.height_m = size->number("height");
  }
}

void read_fields(Loading& loading, const Node& ecosystem, Scenario& scenario) {
  std::map<std::string, base::Place> seen;
  for (const Node& node : ecosystem.children) {
    const std::string& type = node.rule->type;
    if (type != "Datafield" && type != "Vectorfield" && type != "Derivedfield") continue;
    FieldSettings field = type == "Datafield"     ? read_raster(loading, node)
                          : type == "Vectorfield" ? read_vector(loading, node)
                                                  : read_derived(loading, node);
    const auto [first, is_new] = seen.emplace(field.name, field.place);
    if (!is_new) {
      loading.error(field.place,
                    "data field \"" + field.name + "\" stands twice; the first is at " + short_place(first->second));
    }
    scenario.fields.push_back(std::move(field));
  }
  check_derived(loading, scenario);
}

}  // namespace silvasim::config
