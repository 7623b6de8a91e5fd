#include "silvasim/config/load.h"

#include <algorithm>
#include <system_error>

#include "silvasim/base/file.h"
#include "silvasim/base/hash.h"
#include "silvasim/config/loading.h"
#include "silvasim/config/xml.h"

namespace silvasim::config {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_include_depth = 16;

// Reads a file and splices in what it includes. `chain` holds the files that are being read, outermost first.
std::optional<Node> read_tree(Loading& loading, const std::string& path, const std::string& root,
                              std::vector<fs::path>& chain) {
  SourceFile source{path, base::read_file(path, most_config_bytes), ""};
  source.sha256 = base::sha256_hex(source.text);
  loading.files.push_back(source);
  std::optional<Node> tree = parse_xml(source.text, path, loading.dialect, root, loading.errors);
  if (!tree) return tree;

  std::error_code ignored;
  chain.push_back(fs::weakly_canonical(path, ignored));
  std::vector<Node> children;
  for (Node& child : tree->children) {
    if (child.rule->type != "Include") {
      children.push_back(std::move(child));
      continue;
    }
    const fs::path included = beside(child.place, child.text);
    const fs::path canonical = fs::weakly_canonical(included, ignored);
    if (std::find(chain.begin(), chain.end(), canonical) != chain.end()) {
      loading.error(child.place, "<include> of \"" + child.text + "\", which is being read already");
    } else if (chain.size() >= most_include_depth) {
      loading.error(child.place, "<include> nested more than " + std::to_string(most_include_depth) + " deep");
    } else if (!fs::is_regular_file(included, ignored)) {
      loading.error(child.place, "<include>: there is no file \"" + included.string() + "\"");
    } else if (auto below = read_tree(loading, included.string(), root, chain)) {
      std::move(below->children.begin(), below->children.end(), std::back_inserter(children));
    }
  }
  tree->children = std::move(children);
  chain.pop_back();
  return tree;
}

// Which plants file: the caller's, the XML's, or the one beside it.
std::optional<fs::path> plants_file(Loading& loading, const Node& ecosystem, const std::optional<fs::path>& override) {
  if (override) return override;
  std::error_code ignored;
  const bool said = ecosystem.has("plants");
  const fs::path path = beside(ecosystem.place, said ? ecosystem.string("plants") : "plants.xml");
  if (fs::is_regular_file(path, ignored)) return path;
  loading.error(ecosystem.place_of("plants"),
                said ? "plants: there is no file \"" + path.string() + "\""
                     : "no plants file: there is no \"" + path.string() + "\"; name it by plants=\"...\" or --plants");
  return std::nullopt;
}

// An including file may say a thing once that the included one says too; the merged whole must obey the counts.
void check_counts(Loading& loading, const Node& node) {
  for (const ChildRule& rule : node.rule->children) {
    const auto found = node.all(rule.type);
    if (rule.most < 0 || static_cast<int>(found.size()) <= rule.most) continue;
    const Node& extra = *found[static_cast<std::size_t>(rule.most)];
    const bool reported = std::any_of(loading.errors.begin(), loading.errors.end(),
                                      [&](const base::Diagnostic& d) { return d.place == extra.place; });
    if (!reported) {
      loading.error(extra.place,
                    "a second <" + extra.rule->tag + ">; the first stands at " + short_place(found[0]->place));
    }
  }
}

}  // namespace

fs::path beside(const base::Place& place, const std::string& name) {
  const fs::path path(name);
  return path.is_absolute() ? path : (fs::path(place.file).parent_path() / path).lexically_normal();
}

std::string short_place(const base::Place& place) { return place.file + ":" + std::to_string(place.line); }

Scenario load_scenario(const fs::path& ecosystem, const std::optional<fs::path>& plants, const Dialect& dialect) {
  Loading loading{dialect, {}, {}};
  std::vector<fs::path> chain;
  Scenario scenario;

  const std::optional<Node> place = read_tree(loading, ecosystem.string(), "Ecosystem", chain);
  std::optional<Node> flora;
  if (place) {
    check_counts(loading, *place);
    if (const auto path = plants_file(loading, *place, plants)) {
      flora = read_tree(loading, path->string(), "Plants", chain);
    }
  }
  if (place) {
    scenario.name = place->string("name").empty() ? ecosystem.stem().string() : place->string("name");
    scenario.seed = static_cast<std::uint64_t>(place->number("seed"));
    read_scene(loading, *place, scenario);
    read_fields(loading, *place, scenario);
    read_layers(loading, *place, scenario);
  }
  if (place && flora) {
    read_plants(loading, *flora, scenario);
    read_pipelines(loading, *place, *flora, scenario);
  }
  if (!loading.errors.empty()) throw base::ConfigError(std::move(loading.errors));

  // The hash covers names and texts, in the order of reading, so that any change of any file changes it.
  std::string all;
  for (const SourceFile& file : loading.files) {
    all += fs::path(file.path).filename().string() + '\0' + file.sha256 + '\n';
  }
  scenario.sha256 = base::sha256_hex(all);
  scenario.files = std::move(loading.files);
  return scenario;
}

}  // namespace silvasim::config
