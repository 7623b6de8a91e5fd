// No overlap in any tiling. The plane is parted so that every disc meets only discs that it was tested against:
//
//   a plus-shaped patch around every vertex, the same one at all of them;
//   a strip of half-width Rmax along every edge between two patches, one a colour;
//   the squares that are left, one a tile.
//
// Two squares are 2 Rmax apart, since a strip lies between them; a patch's arms reach so far that strips of different
// edges are 2 Rmax apart as well. So a patch is thrown alone, a strip beside the patch, a square beside its four
// strips. Patches and strips are cut out of wider distributions, because large discs gather at a rim that nothing
// presses on.
#include <cmath>
#include <vector>

#include "silvasim/base/parallel.h"
#include "silvasim/tiles/modes.h"
#include "silvasim/tiles/throw_discs.h"

namespace silvasim::tiles {

namespace {

using base::Box;
using base::Point;

class Seamless {
 public:
  explicit Seamless(const Filling& filling)
      : filling_(filling),
        side_(filling.set.side_m),
        half_width_(1.001 * filling.set.most_radius_m),
        arm_(half_width_ + 1.4153 * filling.set.most_radius_m),
        margin_(4 * filling.set.most_radius_m),
        throwing_{filling.set.side_m, filling.sites_per_m2} {}

  void fill() {
    vertex_ = throw_vertex();
    const std::size_t colours = static_cast<std::size_t>(filling_.set.colours);
    horizontal_.resize(colours);
    vertical_.resize(colours);
    base::parallel_for(2 * colours, [&](std::size_t i) {
      (i < colours ? horizontal_ : vertical_)[i % colours] = throw_strip(i < colours, i % colours);
    });
    base::parallel_for(filling_.set.tiles.size(), [&](std::size_t i) { fill_tile(i); });
  }

 private:
  // Is the point in the patch around the vertex at the origin?
  bool in_patch(Point p) const {
    const double x = std::fabs(p.x), y = std::fabs(p.y);
    return (x < arm_ && y < half_width_) || (x < half_width_ && y < arm_);
  }

  template <typename Keep>
  std::vector<Disc> cut_out(DiscGrid& grid, const Region& region, base::Stream random, Keep&& keep) const {
    std::vector<Disc> discs = throw_discs(grid, region, filling_.radii, throwing_, random);
    std::erase_if(discs, [&](const Disc& disc) { return !keep(Point{disc.x, disc.y}); });
    return discs;
  }

  std::vector<Disc> throw_vertex() const {
    const double outer = arm_ + margin_;
    const Region region(Box{-outer, -outer, outer, outer});
    DiscGrid grid = grid_for(region.bounds(), filling_.set.most_radius_m, filling_.sites_per_m2);
    return cut_out(grid, region, darts_for(filling_, Piece::vertex, 0), [&](Point p) { return in_patch(p); });
  }

  // A horizontal strip lies between the vertices (0, 0) and (side, 0), a vertical one between (0, 0) and (0, side).
  std::vector<Disc> throw_strip(bool is_horizontal, std::size_t colour) const {
    const std::vector<double> along{0, half_width_, arm_, side_ - arm_, side_ - half_width_, side_};
    const std::vector<double> across{-margin_, -arm_, -half_width_, half_width_, arm_, margin_};
    const Point other = is_horizontal ? Point{side_, 0} : Point{0, side_};
    const Region region(is_horizontal ? along : across, is_horizontal ? across : along, [&](Point p) {
      return !in_patch(p) && !in_patch({p.x - other.x, p.y - other.y});
    });
    DiscGrid grid = grid_for(region.bounds(), filling_.set.most_radius_m, filling_.sites_per_m2);
    add(grid, vertex_, {});
    add(grid, vertex_, other);
    const Piece piece = is_horizontal ? Piece::horizontal_strip : Piece::vertical_strip;
    return cut_out(grid, region, darts_for(filling_, piece, colour), [&](Point p) {
      const double u = is_horizontal ? p.x : p.y, v = is_horizontal ? p.y : p.x;
      return u >= arm_ && u < side_ - arm_ && v >= -half_width_ && v < half_width_;
    });
  }

  static void add(DiscGrid& grid, const std::vector<Disc>& discs, Point shift) {
    for (const Disc& disc : discs) grid.add({disc.x + shift.x, disc.y + shift.y, disc.radius});
  }

  void fill_tile(std::size_t index) {
    Tile& tile = filling_.set.tiles[index];
    const Region region(Box{half_width_, half_width_, side_ - half_width_, side_ - half_width_});
    DiscGrid grid =
        grid_for(base::grown(region.bounds(), 2 * half_width_), filling_.set.most_radius_m, filling_.sites_per_m2);
    const auto place = [&](const std::vector<Disc>& discs, Point at) {
      add(grid, discs, at);
      append_sites(tile.sites, discs, -at.x, -at.y, side_);
    };
    for (const Point corner : {Point{0, 0}, Point{side_, 0}, Point{0, side_}, Point{side_, side_}})
      place(vertex_, corner);
    place(horizontal_[tile.colours.south], {0, 0});
    place(horizontal_[tile.colours.north], {0, side_});
    place(vertical_[tile.colours.west], {0, 0});
    place(vertical_[tile.colours.east], {side_, 0});
    base::Stream random = darts_for(filling_, Piece::interior, index);
    append_sites(tile.sites, throw_discs(grid, region, filling_.radii, throwing_, random), 0, 0, side_);
  }

  const Filling& filling_;
  double side_;
  double half_width_;  // of strips and of a patch's arms
  double arm_;         // a patch's arms end here: sqrt(2) (arm - half_width) > 2 Rmax
  double margin_;      // how far a distribution goes beyond what is cut out of it
  Throwing throwing_;
  std::vector<Disc> vertex_;  // around the origin
  std::vector<std::vector<Disc>> horizontal_, vertical_;
};

}  // namespace

void fill_seamless(const Filling& filling) { Seamless(filling).fill(); }

}  // namespace silvasim::tiles
