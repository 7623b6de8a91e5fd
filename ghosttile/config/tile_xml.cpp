#include "ghosttile/config/tile_xml.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "assets/load.h"
#include "assets/srgb.h"
#include "ghosttile/config/dialect.h"
#include "ghosttile/config/words.h"
#include "ghosttile/objects/made/made.h"
#include "ghosttile/objects/make_detail.h"
#include "ghosttile/tile/file.h"
#include "silvasim/base/file.h"
#include "silvasim/base/parallel.h"
#include "silvasim/config/xml.h"

namespace ghosttile::config {

using silvasim::base::add;
using silvasim::base::ConfigError;

namespace {

assets::Rgb linear_colour(const std::string& hex) {
  const auto channel = [&](std::size_t at) {
    int value = 0;
    std::from_chars(hex.data() + at, hex.data() + at + 2, value, 16);
    return assets::linear_of_bytes()[static_cast<std::size_t>(value)];
  };
  return {channel(1), channel(3), channel(5)};
}

void scale_to_length(assets::Model& model, float length_m) {
  assets::V3 least = model.positions[0], most = least;
  for (const assets::V3& p : model.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      most[axis] = std::max(most[axis], p[axis]);
    }
  }
  const assets::V3 sides = most - least;
  const float longest = std::max({sides.x, sides.y, sides.z});
  for (assets::V3& p : model.positions) p *= length_m / longest;
}

objects::AnchorPlaces anchor_places(const std::string& word) {
  if (word == "centre") return objects::AnchorPlaces::centre;
  if (word == "foot") return objects::AnchorPlaces::foot;
  if (word == "volume") return objects::AnchorPlaces::volume;
  if (word == "surface") return objects::AnchorPlaces::surface;
  return objects::AnchorPlaces::origin;
}

tile::Spread spread_of(const xml::Node& node, Errors& errors) {
  tile::Spread spread;
  spread.count = static_cast<std::uint32_t>(node.number("count"));
  spread.least_scale = static_cast<float>(node.number("least-scale"));
  spread.most_scale = static_cast<float>(node.number("most-scale"));
  if (spread.least_scale > spread.most_scale)
    add(errors, node.place_of("least-scale"), "least-scale is greater than most-scale");
  for (const xml::Node* tilt : node.all("Tilt")) {
    const tile::Tilt t{static_cast<float>(tilt->number("from")), static_cast<float>(tilt->number("to")),
                       static_cast<float>(tilt->number("share"))};
    if (t.least_deg > t.most_deg) add(errors, tilt->place, "<tilt>: from is greater than to");
    if (t.share > 0) spread.tilts.push_back(t);
  }
  if (spread.tilts.empty() && !node.all("Tilt").empty()) add(errors, node.place, "<tilt>: all shares are 0");
  return spread;
}

// Everything but the model itself.
struct ObjectPlan {
  const xml::Node* node = nullptr;
  objects::SphereFitOptions fit;
  objects::AnchorOptions anchors;
  std::vector<objects::Sphere> given;
};

ObjectPlan plan_of(const xml::Node& node, std::uint64_t seed, Errors& errors) {
  ObjectPlan plan;
  plan.node = &node;
  for (const objects::made::MadeForm& form : objects::made::made_forms()) {
    if (!node.has("made") || form.name != node.string("made")) continue;
    plan.fit.spheres = form.spheres;
    plan.fit.outside_share = form.outside_share;
    // Blades of neighbouring tufts pass through each other; their feet do not.
    if (form.foot_share > 0) {
      const float height_m = node.has("length") ? static_cast<float>(node.number("length")) : form.length_m;
      plan.given.push_back({{0, 0, form.foot_share * height_m}, form.foot_share * height_m});
    }
  }
  if (node.has("spheres")) plan.fit.spheres = static_cast<int>(node.number("spheres"));
  plan.fit.seed = seed;
  if (node.has("thickness")) plan.fit.thickness_m = static_cast<float>(node.number("thickness"));
  plan.anchors.places = anchor_places(node.string("anchor"));
  plan.anchors.count = static_cast<int>(node.number("anchors"));
  plan.anchors.seed = seed;
  if (!node.all("GivenSphere").empty()) plan.given.clear();
  for (const xml::Node* sphere : node.all("GivenSphere"))
    plan.given.push_back({assets::V3(place(*sphere, "at", errors)), static_cast<float>(sphere->number("radius"))});
  for (const xml::Node* anchor : node.all("GivenAnchor")) {
    plan.anchors.places = objects::AnchorPlaces::given;
    plan.anchors.given.push_back(assets::V3(place(*anchor, "at", errors)));
  }
  if (node.has("model") == node.has("made"))
    add(errors, node.place, "<object> \"" + node.string("name") + "\": give it either model=\"FILE\" or made=\"FORM\"");
  return plan;
}

assets::Model model_of(const xml::Node& node, TileXml& into) {
  if (node.has("made")) {
    objects::made::MadeOptions made;
    made.form = node.string("made");
    if (node.has("length")) made.length_m = static_cast<float>(node.number("length"));
    made.seed = static_cast<std::uint64_t>(node.number("variant"));
    made.season = *objects::made::season_named(node.string("season"));
    if (node.has("colour")) made.colour = linear_colour(node.string("colour"));
    return objects::made::make(made);
  }
  const std::filesystem::path file = beside(node, node.string("model"));
  assets::LoadReport report;
  assets::Model model = assets::load(file, {}, &report);
  into.inputs.push_back(file);
  into.warnings.insert(into.warnings.end(), report.warnings.begin(), report.warnings.end());
  if (node.has("length")) scale_to_length(model, static_cast<float>(node.number("length")));
  return model;
}

}  // namespace

TileXml load_tile_xml(const std::filesystem::path& file) {
  TileXml loaded;
  Errors errors;
  const auto root = xml::parse_xml(silvasim::base::read_file(file, xml::most_config_bytes), file.string(), dialect(),
                                   "GhostTile", errors);
  if (!root) throw ConfigError(std::move(errors));
  loaded.inputs.push_back(file);
  loaded.options.side_m = static_cast<float>(root->number("side"));
  loaded.options.delta_m = static_cast<float>(root->number("delta"));
  loaded.options.seed = static_cast<std::uint64_t>(root->number("seed"));
  std::vector<ObjectPlan> plans;
  std::set<std::string> names;
  for (const xml::Node* node : root->all("TileObject")) {
    if (!names.insert(node->string("name")).second)
      add(errors, node->place_of("name"), "there is an <object> \"" + node->string("name") + "\" already");
    loaded.options.spreads.push_back(spread_of(*node, errors));
    plans.push_back(plan_of(*node, loaded.options.seed, errors));
  }
  if (!errors.empty()) throw ConfigError(std::move(errors));
  for (ObjectPlan& plan : plans)
    loaded.objects.push_back(objects::make_detail(plan.node->string("name"), model_of(*plan.node, loaded), plan.fit,
                                                  plan.anchors, std::move(plan.given)));
  return loaded;
}

LoadedTile load_tile(const std::filesystem::path& file, const silvasim::base::Progress& progress) {
  if (file.extension() == ".ghost") return {tile::read(file), {file}, {}};
  TileXml loaded = load_tile_xml(file);
  return {tile::create(std::move(loaded.objects), loaded.options, progress), std::move(loaded.inputs),
          std::move(loaded.warnings)};
}

}  // namespace ghosttile::config
