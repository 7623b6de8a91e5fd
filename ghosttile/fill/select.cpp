#include "ghosttile/fill/select.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "ghosttile/fill/place_hash.h"
#include "silvasim/base/parallel.h"

namespace ghosttile::fill {

namespace {

constexpr std::size_t worth_threads = 256;  // tiles of one colour

// Calls use(bits of that tile, first word of the stretch, last) for every tile that candidate's neighbourhood has a part in.
template <typename Use>
void each_neighbour(const tile::CollisionGraph& graph, const TilePlace& at, std::uint32_t candidate,
                    const TileIndex& index, const Use& use) {
  const std::uint32_t words = graph.words_a_tile(), last = graph.first_word[candidate + 1];
  for (std::uint32_t w = graph.first_word[candidate]; w < last;) {
    const std::uint32_t offset = graph.places[w] / words, begin = offset * words, end = begin + words;
    std::uint32_t next = w;
    while (next < last && graph.places[next] < end) ++next;
    const tile::Offset v = graph.offset(offset);
    const std::uint32_t slot = index.slot(at.x + v[0], at.y + v[1], at.z + v[2]);
    if (slot != no_slot) use(slot, w, next, begin);
    w = next;
  }
}

class Selecting {
 public:
  Selecting(const tile::GhostTile& tile, Survivors& survivors, const SelectOptions& options)
      : graph_(tile.graph), s_(survivors), seed_(options.seed), colours_side_(2 * graph_.reach + 1) {
    selection_.chosen.assign(s_.alive.size(), 0);
    next_run_.assign(s_.index.size(), 0);
    done_.assign(s_.index.size(), 0);
    if (options.unknown) find_doubts(options);
  }

  Selection run(const silvasim::base::Progress& progress) {
    std::vector<std::vector<std::uint32_t>> waiting(s_.stages);
    for (std::uint32_t slot = 0; slot < s_.index.size(); ++slot) wait(slot, waiting);
    for (std::uint32_t stage = 0; stage < s_.stages; ++stage) {
      play(stage, waiting[stage]);
      for (const std::uint32_t slot : waiting[stage]) wait(slot, waiting);
      waiting[stage] = {};
      silvasim::base::report(progress, "select", static_cast<double>(stage) / static_cast<double>(s_.stages));
    }
    return std::move(selection_);
  }

 private:
  // Puts a tile into the line of its next stage in which any of its candidates is still possible.
  void wait(std::uint32_t slot, std::vector<std::vector<std::uint32_t>>& waiting) {
    const std::uint32_t first = s_.first_run[slot], runs = s_.first_run[slot + 1] - first;
    const std::uint64_t* alive = s_.alive.data() + std::size_t{slot} * s_.words;
    for (; next_run_[slot] < runs; ++next_run_[slot]) {
      const Run& run = s_.runs[first + next_run_[slot]];
      const std::uint16_t* candidates = s_.order.data() + s_.first[slot] + done_[slot];
      for (std::uint32_t k = 0; k < run.count; ++k) {
        if (alive[candidates[k] / 64] >> candidates[k] % 64 & 1) {
          waiting[run.stage].push_back(slot);
          return;
        }
      }
      done_[slot] = static_cast<std::uint16_t>(done_[slot] + run.count);
    }
  }

  std::uint32_t colour_of(std::uint32_t slot) const {
    const TilePlace& place = s_.index.place(slot);
    const auto along = [&](int tile) {
      const int rest = tile % colours_side_;
      return static_cast<std::uint32_t>(rest < 0 ? rest + colours_side_ : rest);
    };
    const auto side = static_cast<std::uint32_t>(colours_side_);
    return (along(place.z) * side + along(place.y)) * side + along(place.x);
  }

  void play(std::uint32_t stage, const std::vector<std::uint32_t>& slots) {
    if (slots.empty()) return;
    // Colours come in an order of their own in each stage, and tiles of a colour after one another.
    const auto colours = static_cast<std::uint32_t>(colours_side_ * colours_side_ * colours_side_);
    const std::uint64_t chance =
        mixed(seed_ ^
              (static_cast<std::uint64_t>(static_cast<std::uint32_t>(s_.first_stage + static_cast<std::int32_t>(stage)))
               << 20));
    std::vector<std::uint32_t> first(colours + 1, 0), of(slots.size());
    for (std::size_t t = 0; t < slots.size(); ++t) ++first[(of[t] = colour_of(slots[t])) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> sorted(slots.size()), next(first.begin(), first.end() - 1);
    for (std::size_t t = 0; t < slots.size(); ++t) sorted[next[of[t]]++] = slots[t];
    std::vector<std::uint32_t> order;
    for (std::uint32_t c = 0; c < colours; ++c)
      if (first[c] < first[c + 1]) order.push_back(c);
    std::ranges::sort(order, {}, [&](std::uint32_t c) { return mixed(chance + 0x9E3779B97F4A7C15u * (c + 1)); });
    for (const std::uint32_t c : order) {
      const std::uint32_t* begin = sorted.data() + first[c];
      const std::size_t count = first[c + 1] - first[c];
      if (count < worth_threads) {
        for (std::size_t t = 0; t < count; ++t) play_tile(begin[t]);
      } else {
        const std::size_t pieces = (count + worth_threads / 2 - 1) / (worth_threads / 2);
        silvasim::base::parallel_for(pieces, [&](std::size_t p) {
          for (std::size_t t = count * p / pieces; t < count * (p + 1) / pieces; ++t) play_tile(begin[t]);
        });
      }
    }
  }

  // The turn of one run of a tile's candidates.
  void play_tile(std::uint32_t slot) {
    const Run& run = s_.runs[s_.first_run[slot] + next_run_[slot]];
    const std::uint16_t* candidates = s_.order.data() + s_.first[slot] + done_[slot];
    const TilePlace& place = s_.index.place(slot);
    std::uint64_t* alive = s_.alive.data() + std::size_t{slot} * s_.words;
    const auto possible = [&](std::uint16_t c) { return alive[c / 64] >> (c % 64) & 1; };
    struct Turn {
      std::uint64_t chance;
      std::uint16_t candidate;
    };
    // All at once: an order that is made piece by piece would depend on who is still possible.
    thread_local std::vector<Turn> left;
    left.clear();
    const std::uint64_t chance = tile_hash(seed_, place);
    for (std::uint32_t k = 0; k < run.count; ++k)
      if (possible(candidates[k])) left.push_back({candidate_hash(chance, candidates[k]), candidates[k]});
    std::sort(left.begin(), left.end(), [](const Turn& a, const Turn& b) { return a.chance < b.chance; });
    for (const Turn& turn : left)
      if (possible(turn.candidate)) choose(slot, place, turn.candidate);
    done_[slot] = static_cast<std::uint16_t>(done_[slot] + run.count);
    ++next_run_[slot];
  }

  void choose(std::uint32_t slot, const TilePlace& place, std::uint16_t candidate) {
    const std::size_t word = std::size_t{slot} * s_.words + candidate / 64;
    const std::uint64_t bit = std::uint64_t{1} << candidate % 64;
    s_.alive[word] &= ~bit;
    const bool doubtful = !doubt_.empty() && (doubt_[word] & bit);
    if (doubtful) {
      selection_.doubtful[slot] = 1;
    } else {
      selection_.chosen[word] |= bit;
    }
    each_neighbour(graph_, place, candidate, s_.index,
                   [&](std::uint32_t of, std::uint32_t w, std::uint32_t last, std::uint32_t begin) {
                     std::uint64_t* bits = (doubtful ? doubt_ : s_.alive).data() + std::size_t{of} * s_.words;
                     if (doubtful) {
                       for (; w < last; ++w) bits[graph_.places[w] - begin] |= graph_.bits[w];
                     } else {
                       for (; w < last; ++w) bits[graph_.places[w] - begin] &= ~graph_.bits[w];
                     }
                   });
  }

  // What collides with any candidate of an unknown tile.
  void find_doubts(const SelectOptions& options) {
    doubt_.assign(s_.alive.size(), 0);
    selection_.doubtful.assign(s_.index.size(), 0);
    const std::uint32_t words = s_.words;
    // By offset: the candidates that collide with something there.
    const auto side = static_cast<std::uint32_t>(graph_.side());
    std::vector<std::uint64_t> touching(std::size_t{side} * side * side * words, 0);
    for (std::uint32_t c = 0; c < graph_.candidates; ++c)
      for (std::uint32_t w = graph_.first_word[c]; w < graph_.first_word[c + 1]; ++w)
        touching[std::size_t{graph_.places[w] / words} * words + c / 64] |= std::uint64_t{1} << c % 64;
    silvasim::base::parallel_for(s_.index.size(), [&](std::size_t slot) {
      const TilePlace& at = s_.index.place(static_cast<std::uint32_t>(slot));
      for (std::uint32_t offset = 0; offset < side * side * side; ++offset) {
        const tile::Offset v = graph_.offset(offset);
        const TilePlace place{at.x + v[0], at.y + v[1], at.z + v[2]};
        if (s_.index.slot(place.x, place.y, place.z) != no_slot || !options.unknown(options.context, place)) continue;
        for (std::uint32_t w = 0; w < words; ++w) doubt_[slot * words + w] |= touching[std::size_t{offset} * words + w];
      }
    });
  }

  const tile::CollisionGraph& graph_;
  Survivors& s_;
  std::uint64_t seed_;
  int colours_side_;
  Selection selection_;
  std::vector<std::uint64_t> doubt_;
  std::vector<std::uint16_t> next_run_, done_;  // by slot: runs, and candidates, whose turn is over
};

}  // namespace

void bar(const tile::CollisionGraph& graph, const TilePlace& tile, std::uint32_t candidate, const TileIndex& index,
         std::uint32_t words, std::uint64_t* bits) {
  each_neighbour(graph, tile, candidate, index,
                 [&](std::uint32_t slot, std::uint32_t w, std::uint32_t last, std::uint32_t begin) {
                   std::uint64_t* of = bits + std::size_t{slot} * words;
                   for (; w < last; ++w) of[graph.places[w] - begin] &= ~graph.bits[w];
                 });
}

Selection select(const tile::GhostTile& tile, Survivors& survivors, const SelectOptions& options,
                 const silvasim::base::Progress& progress) {
  return Selecting(tile, survivors, options).run(progress);
}

}  // namespace ghosttile::fill
