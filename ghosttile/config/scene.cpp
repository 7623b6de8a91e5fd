#include "ghosttile/config/scene.h"

#include <algorithm>
#include <limits>

#include "ghosttile/config/dialect.h"
#include "ghosttile/config/tile_xml.h"
#include "ghosttile/density/ground_plane.h"
#include "silvasim/base/file.h"
#include "silvasim/base/hash.h"
#include "silvasim/config/load.h"
#include "silvasim/config/xml.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/evaluators/evaluator.h"

namespace ghosttile::config {

using density::Kind;
using density::Node;
using silvasim::base::add;
using silvasim::base::ConfigError;

struct Scene::Parts {
  xml::Node root;
  std::shared_ptr<const silvasim::ecosystem::Ecosystem> ecosystem;
  std::unique_ptr<silvasim::config::Scenario> scenario;
  std::unique_ptr<cover::Land> land;
  std::shared_ptr<const density::Plane> ground;
};

Scene::~Scene() = default;

density::Box3 everywhere() {
  constexpr double far = std::numeric_limits<double>::infinity();
  return {{-far, -far, -far}, {far, far, far}};
}

Scene::Scene(const std::filesystem::path& file, const silvasim::base::Progress& progress)
    : parts_(std::make_unique<Parts>()) {
  Errors errors;
  const std::string text = silvasim::base::read_file(file, xml::most_config_bytes);
  auto root = xml::parse_xml(text, file.string(), dialect(), "Details", errors);
  if (!root || !errors.empty()) throw ConfigError(std::move(errors));
  parts_->root = std::move(*root);
  inputs_.push_back(file);
  const xml::Node& tile = *parts_->root.child("TileReference");
  LoadedTile loaded = load_tile(beside(tile, tile.text), progress);
  tile_ = std::make_shared<tile::GhostTile>(std::move(loaded.tile));
  std::ranges::move(loaded.inputs, std::back_inserter(inputs_));
  std::ranges::move(loaded.warnings, std::back_inserter(warnings_));
  read_land(progress);
  std::string hashes;
  for (const std::filesystem::path& input : inputs_) hashes += silvasim::base::sha256_of_file(input) + '\n';
  sha256_ = silvasim::base::sha256_hex(hashes);
  // All findings now, not when the first plan is made.
  plan(land_box_.empty() ? density::Box3{}
                         : density::Box3{{land_box_.west, land_box_.south, 0}, {land_box_.west, land_box_.south, 0}});
}

void Scene::read_land(const silvasim::base::Progress& progress) {
  const xml::Node& root = parts_->root;
  const std::string wanted = root.has("ground") ? root.string("ground") : "";
  if (const xml::Node* reference = root.child("EcosystemReference")) {
    const std::filesystem::path file = beside(*reference, reference->text);
    parts_->ecosystem = std::make_shared<silvasim::ecosystem::Ecosystem>(silvasim::ecosystem::read(file, progress));
    inputs_.push_back(file);
    land_box_ = parts_->ecosystem->extent;
    std::shared_ptr<silvasim::fields::FieldSet> fields;
    if (reference->has("fields")) {
      const std::filesystem::path config = beside(*reference, reference->string("fields"));
      parts_->scenario = std::make_unique<silvasim::config::Scenario>(
          silvasim::config::load_scenario(config, std::nullopt, silvasim::evaluators::dialect()));
      fields = std::make_shared<silvasim::fields::FieldSet>(
          silvasim::fields::load_fields(parts_->scenario->scene, parts_->scenario->fields, progress));
      inputs_.push_back(config);
    }
    cover::LandOptions options;
    options.month = root.number("month");
    options.seed = static_cast<std::uint64_t>(root.number("seed"));
    parts_->land = std::make_unique<cover::Land>(
        std::make_shared<cover::Plants>(parts_->ecosystem, parts_->scenario.get()), fields, options);
    if (wanted.empty() || wanted == "ecosystem")
      parts_->ground = parts_->ecosystem->terrain.columns > 0 ? density::ground_plane(parts_->ecosystem->terrain)
                                                              : density::flat_plane(0);
  } else if (wanted == "ecosystem") {
    throw ConfigError(root.place_of("ground"), "ground=\"ecosystem\" asks for an <ecosystem>");
  }
  if (wanted == "flat") parts_->ground = density::flat_plane(0);
}

void Scene::use_tile(std::shared_ptr<const tile::GhostTile> tile) { tile_ = std::move(tile); }

std::string Scene::crs_wkt() const { return parts_->ecosystem ? parts_->ecosystem->crs_wkt : std::string(); }

Surroundings Scene::around(const density::Box3& region) const {
  const xml::Node& root = parts_->root;
  Surroundings around;
  around.land = parts_->land.get();
  around.ground = parts_->ground;
  around.above_ground = root.string("heights") == "ground";
  Errors errors;
  const std::vector<double> origin = numbers(root, "origin", 2, 2, errors);
  if (!errors.empty()) throw ConfigError(std::move(errors));
  around.origin = {origin[0], origin[1], 0};
  // Filling works on a margin around what is asked for, and candidates stick out of their tiles.
  const double margin_m = 32 * static_cast<double>(tile_->side_m) + 2 * static_cast<double>(tile::reach_of(*tile_));
  around.region = {region.least - density::V3d(margin_m, margin_m, margin_m),
                   region.most + density::V3d(margin_m, margin_m, margin_m)};
  return around;
}

namespace {

density::Direction direction_of(const xml::Node& node, const Surroundings& around, Errors& errors) {
  density::Direction direction;
  const std::string& kind = node.string("kind");
  using DK = density::DirectionKind;
  direction.kind = kind == "constant"     ? DK::constant
                   : kind == "gradient"   ? DK::gradient
                   : kind == "rotational" ? DK::rotational
                   : kind == "radial"     ? DK::radial
                   : kind == "normal"     ? DK::normal
                                          : DK::vertical;
  direction.vector = place(node, "vector", errors);
  if (direction.vector.length() < 1e-9) add(errors, node.place_of("vector"), "vector: it has no length");
  const std::vector<double> centre = numbers(node, "centre", 2, 2, errors);
  direction.centre = around.origin + density::V3d(centre[0], centre[1], 0);
  direction.ground = around.ground.get();
  direction.least_cosine = static_cast<float>(node.number("least-cosine"));
  direction.most_cosine = static_cast<float>(node.number("most-cosine"));
  if (direction.least_cosine > direction.most_cosine)
    add(errors, node.place, "<direction>: least-cosine is greater than most-cosine");
  if (direction.kind == DK::normal && !around.ground)
    add(errors, node.place_of("kind"), "kind=\"normal\" asks for a ground");
  return direction;
}

density::Field field_of(Node tree, const xml::Node& node, Errors& errors) {
  if (const std::string problem = density::problem_with(tree); !problem.empty()) {
    add(errors, node.place, "<" + node.rule->tag + ">: " + problem);
    return {};
  }
  return density::Field(std::move(tree));
}

std::size_t object_named(const tile::GhostTile& tile, const xml::Node& node, Errors& errors) {
  std::vector<std::string> names;
  for (std::size_t o = 0; o < tile.objects.size(); ++o) {
    if (tile.objects[o].name == node.string("object")) return o;
    names.push_back(tile.objects[o].name);
  }
  add(errors, node.place_of("object"),
      "the tile has no object \"" + node.string("object") + "\"" +
          silvasim::base::did_you_mean(node.string("object"), names));
  return 0;
}

// A stroke changes what was there.
Node stroked(Node before, const xml::Node& stroke, Node shape) {
  Node after;
  after.kind = stroke.rule->type == "AddStroke" ? Kind::unite : Kind::differ;
  after.children = {std::move(before), std::move(shape)};
  return after;
}

}  // namespace

fill::Plan Scene::plan(const density::Box3& region, const std::vector<std::string>& edits) const {
  const xml::Node& root = parts_->root;
  Errors errors;
  const Surroundings land = around(region);
  Node nothing;
  nothing.value = 0;
  std::vector<Node> trees(tile_->objects.size(), nothing);
  fill::Plan plan;
  plan.tile = tile_;
  plan.objects.resize(tile_->objects.size());
  plan.ground = parts_->ground;
  plan.seed = static_cast<std::uint64_t>(root.number("seed"));
  const std::string& priority = root.string("priority");
  plan.priority = priority == "elevation"  ? fill::Priority::elevation
                  : priority == "boundary" ? fill::Priority::boundary
                                           : fill::Priority::random;
  std::vector<const xml::Node*> said(tile_->objects.size(), nullptr);
  for (const xml::Node* node : root.all("Fill")) {
    const std::size_t object = object_named(*tile_, *node, errors);
    if (said[object]) {
      add(errors, node->place,
          "a second <fill> of \"" + node->string("object") + "\"; put both shapes into one <union>");
      continue;
    }
    said[object] = node;
    trees[object] = product_of(*node, node->number("density"), land, errors);
    fill::ObjectRule& rule = plan.objects[object];
    if (const xml::Node* direction = node->child("DirectionRule"))
      rule.direction = direction_of(*direction, land, errors);
    if (const xml::Node* least = node->child("LeastScale"))
      rule.least_scale = field_of(product_of(*least, least->number("value"), land, errors), *least, errors);
    if (const xml::Node* most = node->child("MostScale"))
      rule.most_scale = field_of(product_of(*most, most->number("value"), land, errors), *most, errors);
  }
  for (const std::string& text : edits) {
    const auto strokes = xml::parse_xml(text, "strokes", dialect(), "Strokes", errors);
    if (!strokes) break;
    for (const xml::Node& stroke : strokes->children) {
      const Node shape = product_of(stroke, 1, land, errors);
      for (std::size_t o = 0; o < trees.size(); ++o) {
        if (stroke.string("object") != "*" && tile_->objects[o].name != stroke.string("object")) continue;
        trees[o] = stroked(std::move(trees[o]), stroke, shape);
      }
    }
  }
  // Nothing lies in the ground.
  for (std::size_t o = 0; o < trees.size(); ++o) {
    const xml::Node& place = said[o] ? *said[o] : root;
    if (parts_->ground && !(trees[o].kind == Kind::constant && trees[o].value == 0)) {
      Node above;
      above.kind = Kind::above;
      above.plane = parts_->ground;
      above.from_m = -root.number("sink");
      Node both;
      both.kind = Kind::multiply;
      both.children = {std::move(trees[o]), std::move(above)};
      trees[o] = std::move(both);
    }
    plan.objects[o].density = field_of(std::move(trees[o]), place, errors);
  }
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return plan;
}

density::Box3 Scene::touched_by(const std::string& text, const std::string& name) const {
  Errors errors;
  const auto strokes = xml::parse_xml(text, name, dialect(), "Strokes", errors);
  if (!strokes || !errors.empty()) throw ConfigError(std::move(errors));
  const Surroundings land = around(everywhere());
  density::Box3 all{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (const xml::Node& stroke : strokes->children) {
    if (stroke.string("object") != "*") object_named(*tile_, stroke, errors);
    const density::Box3 box = field_of(product_of(stroke, 1, land, errors), stroke, errors).bounds();
    for (int axis = 0; axis < 3; ++axis) {
      all.least[axis] = std::min(all.least[axis], box.least[axis]);
      all.most[axis] = std::max(all.most[axis], box.most[axis]);
    }
    if (errors.empty() && !(box.most.x - box.least.x < 1e6 && box.most.y - box.least.y < 1e6))
      add(errors, stroke.place,
          "<" + stroke.rule->tag + ">: the stroke has no bounds; give it a <sphere>, <box> or the like");
  }
  if (!errors.empty()) throw ConfigError(std::move(errors));
  if (strokes->children.empty()) throw ConfigError(strokes->place, "<strokes> holds no <add> and no <remove>");
  return all;
}

}  // namespace ghosttile::config
