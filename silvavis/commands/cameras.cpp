#include "silvavis/commands/cameras.h"

#include <algorithm>

#include "silvasim/base/file.h"
#include "silvasim/config/elements/elements.h"
#include "silvasim/config/xml.h"
#include "silvavis/commands/spot.h"

namespace silvavis::commands {

namespace {

namespace base = silvasim::base;
namespace config = silvasim::config;
using VT = config::ValueType;

config::Dialect camera_dialect() {
  using config::attribute, config::required, config::within;
  config::Dialect dialect;
  dialect.rules = {
      {"Cameras", "cameras", "Cameras by name.", {}, {{"Camera", 1}}, VT::none, true, ""},
      {"Camera",
       "camera",
       "Where the eye is, and what it looks at.",
       {required(attribute("name", VT::name, "what stands behind # in --camera")),
        within(attribute("fov", VT::angle, "horizontal angle of view", "50"), 0.01, 170)},
       {{"Eye", 1, 1}, {"LookAt", 1, 1}},
       VT::none,
       true,
       ""},
      {"Eye", "eye", "The eye.", spot_rules("", "the eye"), {}, VT::none, true, ""},
      {"LookAt", "look-at", "The picture's middle.", spot_rules("", "the picture's middle"), {}, VT::none, true, ""}};
  return dialect;
}

struct Reference {
  std::filesystem::path file;
  std::string name;
};

Reference split(const std::string& reference) {
  const std::size_t hash = reference.rfind('#');
  if (hash == std::string::npos) return {reference, ""};
  return {reference.substr(0, hash), reference.substr(hash + 1)};
}

// A spot that must be there.
Spot need_spot(const config::Node& camera, const char* type, const scene::Scene& scene,
               std::vector<base::Diagnostic>& errors) {
  const config::Node* node = camera.child(type);
  if (!node) return {};
  const std::size_t before = errors.size();
  const auto spot = spot_of(*node, "", scene, errors);
  if (!spot && errors.size() == before) {
    base::add(errors, node->place,
              "<" + node->rule->tag + "> needs \"x\" and \"y\", or \"longitude\" and \"latitude\", and \"height\"");
  }
  return spot.value_or(Spot{});
}

}  // namespace

std::filesystem::path camera_file(const std::string& reference) { return split(reference).file; }

shade::Camera camera_from(const std::string& reference, const scene::Scene& scene) {
  const auto [file, name] = split(reference);
  const config::Dialect dialect = camera_dialect();
  std::vector<base::Diagnostic> errors;
  const auto tree =
      config::parse_xml(base::read_file(file, config::most_config_bytes), file.string(), dialect, "Cameras", errors);
  const config::Node* found = nullptr;
  shade::Camera camera;
  if (tree) {
    std::vector<std::string> names;
    // Every camera is looked at, so that a mistake shows before the day on which its camera is used.
    for (const config::Node& node : tree->children) {
      const std::string& own = node.string("name");
      if (std::find(names.begin(), names.end(), own) != names.end())
        base::add(errors, node.place_of("name"), "a second camera \"" + own + "\"");
      names.push_back(own);
      const Spot eye = need_spot(node, "Eye", scene, errors), at = need_spot(node, "LookAt", scene, errors);
      if (found || (own != name && !(name.empty() && tree->children.size() == 1))) continue;
      found = &node;
      camera.eye = eye.at;
      camera.look_at = at.at;
      camera.fov_deg = node.number("fov");
    }
    if (errors.empty() && !found) {
      std::string list;
      for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
      base::add(errors, {file.string(), 0, 0},
                name.empty()
                    ? "it holds several cameras; name one, like " + file.string() + "#" + names.front()
                    : "there is no camera \"" + name + "\"" + base::did_you_mean(name, names) + "; there are " + list);
    }
    if (errors.empty() && camera.eye == camera.look_at)
      base::add(errors, found->place, "the eye is where it looks at; the two must be different points");
  }
  if (!errors.empty()) throw base::ConfigError(std::move(errors));
  return camera;
}

}  // namespace silvavis::commands
