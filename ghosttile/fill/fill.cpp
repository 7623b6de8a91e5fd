#include "ghosttile/fill/fill.h"

#include <algorithm>
#include <bit>
#include <string>

#include "ghosttile/fill/refuse.h"
#include "ghosttile/fill/select.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"

namespace ghosttile::fill {

namespace {

constexpr int first_margin = 4;  // tiles; usually enough

void check_size(const TileBox& box) {
  const auto along = [](int from, int to) { return static_cast<double>(to) - static_cast<double>(from); };
  const double columns = along(box.x0, box.x1) * along(box.y0, box.y1);
  if (box.z0 <= -farthest_tile || box.z1 > farthest_tile)
    throw silvasim::base::Error(
        "the details reach up or down without end: put a <layer> or another shape with bounds into each <fill>");
  if (columns > static_cast<double>(most_tiles))
    throw silvasim::base::Error(
        "the details have no bounds, or too wide ones: say where to fill, with --bbox or --around");
}

void append(const std::uint64_t* bits, std::uint32_t words, std::vector<std::uint16_t>& to) {
  for (std::uint32_t w = 0; w < words; ++w)
    for (std::uint64_t left = bits[w]; left != 0; left &= left - 1)
      to.push_back(static_cast<std::uint16_t>(w * 64 + static_cast<std::uint32_t>(std::countr_zero(left))));
}

// What was chosen in the box, after refusal.
Details gather(const Plan& plan, const Survivors& survivors, Selection selection, const TileBox& box) {
  std::vector<std::uint64_t> refused(survivors.blocks.empty() ? 0 : selection.chosen.size(), 0);
  refuse(plan, survivors, selection.chosen, refused);
  Details details;
  details.first.push_back(0);
  for (std::uint32_t slot = 0; slot < survivors.index.size(); ++slot) {
    const TilePlace& place = survivors.index.place(slot);
    if (!box.holds(place.x, place.y, place.z)) continue;
    const std::size_t before = details.chosen.size(), base = std::size_t{slot} * survivors.words;
    append(selection.chosen.data() + base, survivors.words, details.chosen);
    const std::size_t instances = details.chosen.size() - before;
    if (!refused.empty()) append(refused.data() + base, survivors.words, details.chosen);
    if (details.chosen.size() == before) continue;
    details.tiles.push_back(place);
    details.instances.push_back(static_cast<std::uint16_t>(instances));
    details.first.push_back(static_cast<std::uint32_t>(details.chosen.size()));
  }
  if (details.chosen.size() > 0xFFFFFFFFu)
    throw silvasim::base::Error("more than four thousand million instances: fill a smaller box");
  details.tiles.shrink_to_fit();
  details.first.shrink_to_fit();
  details.chosen.shrink_to_fit();
  details.instances.shrink_to_fit();
  return details;
}

struct Beyond {
  const Plan& plan;
  const TileBox& worked;
};

// Whether a tile outside of what is worked on may hold something.
bool may_hold(const void* context, const TilePlace& place) {
  const Beyond& beyond = *static_cast<const Beyond*>(context);
  if (beyond.worked.holds(place.x, place.y, place.z)) return false;
  const auto side = static_cast<double>(beyond.plan.tile->side_m),
             reach = static_cast<double>(tile::reach_of(*beyond.plan.tile));
  const density::Box3 space{{place.x * side - reach, place.y * side - reach, place.z * side - reach},
                            {(place.x + 1) * side + reach, (place.y + 1) * side + reach, (place.z + 1) * side + reach}};
  return std::ranges::any_of(beyond.plan.objects,
                             [&](const ObjectRule& rule) { return rule.density.range(space).most > 0; });
}

bool settled(const Survivors& survivors, const Selection& selection, const TileBox& box) {
  for (std::uint32_t slot = 0; slot < selection.doubtful.size(); ++slot) {
    const TilePlace& place = survivors.index.place(slot);
    if (selection.doubtful[slot] && box.holds(place.x, place.y, place.z)) return false;
  }
  return true;
}

}  // namespace

Details fill(const Plan& plan, const TileBox& wanted, const silvasim::base::Progress& progress, FillCounts* counts) {
  const TileBox all = tiles_of(plan), box = intersection(wanted, all);
  if (box.empty()) {
    Details nothing;
    nothing.first.push_back(0);
    return nothing;
  }
  check_size(box);
  // What stands in the box may be settled by what stands around it: work on a margin too, as wide as it takes.
  for (int margin = box == all ? 0 : first_margin;; margin *= 2) {
    const TileBox worked = intersection(grown(box, margin), all);
    Survivors survivors = survivors_of(plan, worked, progress);
    if (counts) {
      const auto tiles = static_cast<std::uint64_t>(box.x1 - box.x0) * static_cast<std::uint64_t>(box.y1 - box.y0) *
                         static_cast<std::uint64_t>(box.z1 - box.z0);
      *counts = {tiles * plan.tile->candidates.size(), survivors.looked_at, survivors.order.size(), margin};
    }
    SelectOptions options;
    options.seed = plan.seed;
    const Beyond beyond{plan, worked};
    if (!(worked == all)) {
      options.unknown = may_hold;
      options.context = &beyond;
    }
    Selection selection = select(*plan.tile, survivors, options, progress);
    if (worked == all || settled(survivors, selection, box)) return gather(plan, survivors, std::move(selection), box);
  }
}

Details refill(const Plan& plan, const Details& before, const TileBox& box, const silvasim::base::Progress& progress) {
  const TileBox worked = intersection(box, tiles_of(plan));
  Details inside;
  inside.first.push_back(0);
  if (!worked.empty()) {
    check_size(worked);
    Survivors survivors = survivors_of(plan, worked, progress);
    // What stands around stays: it bars its neighbourhood before anything is chosen.
    const TileBox around = grown(worked, plan.tile->graph.reach);
    for (std::size_t t = 0; t < before.tiles.size(); ++t) {
      const TilePlace& place = before.tiles[t];
      if (!around.holds(place.x, place.y, place.z) || box.holds(place.x, place.y, place.z)) continue;
      for (std::uint32_t c = before.first[t]; c < before.first[t + 1]; ++c)
        bar(plan.tile->graph, place, before.chosen[c], survivors.index, survivors.words, survivors.alive.data());
    }
    SelectOptions options;
    options.seed = plan.seed;
    Selection selection = select(*plan.tile, survivors, options, progress);
    inside = gather(plan, survivors, std::move(selection), worked);
  }
  return joined(before, inside, box);
}

}  // namespace ghosttile::fill
