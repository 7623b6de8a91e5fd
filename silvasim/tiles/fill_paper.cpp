// Algorithm 1 of the paper. Tile by tile, in the order of their indices: copy the strips that other tiles have fixed,
// throw the rest, and let the tile fix the strips of the colours that it is the first to bear.
#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "silvasim/base/parallel.h"
#include "silvasim/tiles/modes.h"
#include "silvasim/tiles/throw_discs.h"

namespace silvasim::tiles {

namespace {

enum Side { north, east, south, west };
constexpr std::array<Side, 4> sides{north, east, south, west};

constexpr Side opposite(Side side) { return static_cast<Side>((side + 2) % 4); }

std::uint8_t colour_of(const Tile& tile, Side side) {
  switch (side) {
    case north:
      return tile.colours.north;
    case east:
      return tile.colours.east;
    case south:
      return tile.colours.south;
    default:
      return tile.colours.west;
  }
}

// The sites at most 2 Rmax away from an edge, of the first tile that has the colour on that side.
struct Strip {
  bool fixed = false;
  std::vector<Site> sites;
};

class Paper {
 public:
  explicit Paper(const Filling& filling)
      : filling_(filling), side_m_(filling.set.side_m), width_m_(2 * filling.set.most_radius_m) {
    for (auto& of_side : strips_) of_side.resize(static_cast<std::size_t>(filling.set.colours));
  }

  void fill() {
    // Begin with the tiles that fix most, so that few strips grow beside a fixed one: in lowest-index order each strip would
    // take its ends from the corners of tile 0, and every vertex of the land would look the same.
    std::vector<std::size_t> left(filling_.set.tiles.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    for (;;) {
      const auto next = std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
        return open_strips(filling_.set.tiles[a]) < open_strips(filling_.set.tiles[b]);
      });
      if (next == left.end() || open_strips(filling_.set.tiles[*next]) == 0) break;
      fill_tile(*next);
      for (const Side s : sides) fix(filling_.set.tiles[*next], s);
      left.erase(next);
    }
    // What the others get depends on the strips alone.
    base::parallel_for(left.size(), [&](std::size_t i) { fill_tile(left[i]); });
  }

 private:
  Strip& own(const Tile& tile, Side s) { return strips_[s][colour_of(tile, s)]; }
  const Strip& beyond(const Tile& tile, Side s) { return strips_[opposite(s)][colour_of(tile, s)]; }

  int open_strips(const Tile& tile) {
    return static_cast<int>(std::count_if(sides.begin(), sides.end(), [&](Side s) { return !own(tile, s).fixed; }));
  }

  // How far a point lies beyond an edge; negative inside.
  double distance_past(base::Point p, Side s) const {
    switch (s) {
      case north:
        return p.y - side_m_;
      case east:
        return p.x - side_m_;
      case south:
        return -p.y;
      default:
        return -p.x;
    }
  }

  void fix(const Tile& tile, Side s) {
    Strip& strip = own(tile, s);
    if (strip.fixed) return;
    strip.fixed = true;
    for (const Site& site : tile.sites) {
      const base::Point p{static_cast<double>(site.x_m), static_cast<double>(site.y_m)};
      if (distance_past(p, s) > -width_m_) strip.sites.push_back(site);
    }
  }

  // Where new darts may land: the tile without its fixed strips, and a margin beyond every open strip, where they are
  // thrown away. The margin is there because large discs gather at a rim that nothing presses on; where the strip
  // beyond the edge is fixed, that one presses instead.
  Region open_region(const Tile& tile) {
    std::array<bool, 4> open{};
    for (const Side s : sides) open[s] = !own(tile, s).fixed;
    const double outer = 2 * width_m_;
    const std::vector<double> cuts{
        -outer, -width_m_, 0, width_m_, side_m_ - width_m_, side_m_, side_m_ + width_m_, side_m_ + outer};
    return Region(cuts, cuts, [&](base::Point p) {
      int edges_past = 0;  // 0: in the tile, 1: beside it, 2: in a corner of the margin
      for (const Side s : sides) edges_past += distance_past(p, s) > 0 ? 1 : 0;
      bool kept = true;
      for (const Side s : sides) {
        const double past = distance_past(p, s);
        if (past > (edges_past == 0 ? -width_m_ : 0.0)) kept = kept && open[s];
        if (edges_past == 1 && past > 0 && past < width_m_) kept = kept && !beyond(tile, s).fixed;
      }
      return kept;
    });
  }

  // What other tiles have fixed in this one. A copy that hits one already in the tile is dropped, the smaller one of
  // the two, because two strips that overlap in a corner may come from different tiles.
  std::vector<Site> copied_sites(const Tile& tile) {
    std::vector<Site> copies;
    for (const Side s : sides) {
      const Strip& strip = own(tile, s);
      copies.insert(copies.end(), strip.sites.begin(), strip.sites.end());
    }
    std::sort(copies.begin(), copies.end(), [](const Site& a, const Site& b) {
      return std::array{-a.radius_m, a.y_m, a.x_m} < std::array{-b.radius_m, b.y_m, b.x_m};
    });
    // A corner site may come by two strips of the same tile: keep it once.
    copies.erase(std::unique(copies.begin(), copies.end()), copies.end());
    DiscGrid grid = grid_for(base::Box{-width_m_, -width_m_, side_m_ + width_m_, side_m_ + width_m_},
                             filling_.set.most_radius_m, filling_.sites_per_m2);
    std::erase_if(copies, [&](const Site& site) {
      const Disc disc = disc_of(site, 0, 0);
      const bool fits = grid.fits(disc);
      if (fits) grid.add(disc);
      return !fits;
    });
    return copies;
  }

  void fill_tile(std::size_t index) {
    Tile& tile = filling_.set.tiles[index];
    const Region region = open_region(tile);
    // The window holds the tile and the margin: fixed strips lie at its rims as they lie beside the open part.
    const base::Box& bounds = region.bounds();
    const base::Box window{std::min(bounds.west, 0.0), std::min(bounds.south, 0.0), std::max(bounds.east, side_m_),
                           std::max(bounds.north, side_m_)};
    DiscGrid grid = grid_for(window, filling_.set.most_radius_m, filling_.sites_per_m2);

    tile.sites = copied_sites(tile);
    for (const Site& site : tile.sites) grid.add(disc_of(site, 0, 0));

    // Lay the strips beyond open edges beside the tile: tested against, never output.
    for (const Side s : sides) {
      if (own(tile, s).fixed) continue;
      const double shift_x = s == east ? side_m_ : (s == west ? -side_m_ : 0.0);
      const double shift_y = s == north ? side_m_ : (s == south ? -side_m_ : 0.0);
      for (const Site& site : beyond(tile, s).sites) grid.add(disc_of(site, shift_x, shift_y));
    }

    base::Stream random = darts_for(filling_, Piece::tile, index);
    const std::vector<Disc> thrown =
        throw_discs(grid, region, filling_.radii, {side_m_, filling_.sites_per_m2}, random);
    append_sites(tile.sites, thrown, 0, 0, side_m_);
  }

  const Filling& filling_;
  double side_m_, width_m_;
  std::array<std::vector<Strip>, 4> strips_;
};

}  // namespace

void fill_paper(const Filling& filling) { Paper(filling).fill(); }

}  // namespace silvasim::tiles
