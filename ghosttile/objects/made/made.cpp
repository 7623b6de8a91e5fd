#include "ghosttile/objects/made/made.h"

#include <fmt/format.h>

#include <cmath>

#include "ghosttile/objects/made/parts.h"
#include "silvasim/base/error.h"

namespace ghosttile::objects::made {

namespace {

struct Entry {
  MadeForm form;
  Model (*make)(const MadeOptions&);
  Stand stand;
};

const std::vector<Entry>& table() {
  static const std::vector<Entry> entries{
      {{"beech-leaf", "egg-shaped, entire, straight side veins; copper when fallen", 0.085f, 16},
       make_leaf,
       Stand::lies},
      {{"oak-leaf", "round lobes; brown when fallen", 0.11f, 16}, make_leaf, Stand::lies},
      {{"maple-leaf", "five pointed lobes on a long stalk; yellow to red when fallen", 0.16f, 16},
       make_leaf,
       Stand::lies},
      {{"birch-leaf", "small, triangular, toothed; yellow when fallen", 0.06f, 16}, make_leaf, Stand::lies},
      {{"twig", "bent, forked, thin: fallen from a crown", 0.30f, 200, 32, 0.6f}, make_twig, Stand::lies},
      {{"branch", "as thick as a wrist, with the stubs of its side branches", 1.5f, 200, 32, 0.3f},
       make_twig,
       Stand::lies},
      {{"stick", "straight, bare of bark at its cut ends: a beaver's", 1.2f, 200, 24, 0.3f}, make_twig, Stand::lies},
      {{"stone", "rounded, as of a moraine", 0.25f, 320}, make_stone, Stand::lies},
      {{"pebble", "smooth and oval, from water", 0.08f, 320}, make_stone, Stand::lies},
      {{"rock", "broken, with edges", 0.35f, 320}, make_stone, Stand::lies},
      {{"slab", "flat, with edges: for walls and roofs of dry stone", 0.40f, 320, 40, 0.15f}, make_stone, Stand::lies},
      {{"tuft", "grass: bent blades from one foot", 0.22f, 240, 1, 0, 0.25f}, make_tuft, Stand::stands},
      {{"sedge", "a dense, taller tuft of narrow blades that hang over", 0.45f, 240, 1, 0, 0.25f},
       make_tuft,
       Stand::stands},
      {{"pine-needles", "two needles from one foot", 0.055f, 12, 16, 2.0f}, make_needle, Stand::lies},
      {{"spruce-needle", "one short needle", 0.016f, 12, 8, 0.6f}, make_needle, Stand::lies},
      {{"mushroom", "brown cap on a stout stalk: a cep", 0.10f, 500}, make_mushroom, Stand::stands},
      {{"toadstool", "red cap with white flakes: a fly agaric", 0.13f, 500, 24, 0.2f}, make_mushroom, Stand::stands},
      {{"straw", "a stalk of cut grass or grain, with its nodes", 0.45f, 80, 32, 2.0f}, make_straw, Stand::lies},
      {{"pine-cone", "short and broad, of a pine", 0.055f, 400, 16, 0.3f}, make_cone, Stand::lies},
      {{"spruce-cone", "long, of a spruce", 0.13f, 400, 16, 0.3f}, make_cone, Stand::lies},
  };
  return entries;
}

}  // namespace

const std::vector<MadeForm>& made_forms() {
  static const std::vector<MadeForm> forms = [] {
    std::vector<MadeForm> result;
    for (const Entry& entry : table()) result.push_back(entry.form);
    return result;
  }();
  return forms;
}

Model make(const MadeOptions& options) {
  std::vector<std::string> names;
  for (const Entry& entry : table()) {
    names.push_back(entry.form.name);
    if (entry.form.name != options.form) continue;
    const float length_m = options.length_m == 0 ? entry.form.length_m : options.length_m;
    if (!(length_m > 0 && length_m <= 100)) {
      throw silvasim::base::Error(
          fmt::format("detail form \"{}\": {} m is no length; above 0 to 100 m are possible", options.form, length_m));
    }
    Model model = entry.make(options);
    model.name = options.form;
    finish(model, length_m, entry.stand);
    return model;
  }
  throw silvasim::base::Error(fmt::format("no detail form is called \"{}\"{}", options.form,
                                          silvasim::base::did_you_mean(options.form, names)));
}

std::optional<Season> season_named(const std::string& name) {
  if (name == "summer") return Season::summer;
  if (name == "autumn") return Season::autumn;
  if (name == "winter") return Season::winter;
  return std::nullopt;
}

}  // namespace ghosttile::objects::made
