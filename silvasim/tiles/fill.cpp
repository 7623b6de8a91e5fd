#include "silvasim/tiles/fill.h"

#include <algorithm>
#include <array>

#include "silvasim/base/error.h"
#include "silvasim/tiles/check.h"
#include "silvasim/tiles/modes.h"
#include "silvasim/tiles/radii.h"

namespace silvasim::tiles {

base::Stream darts_for(const Filling& filling, Piece piece, std::size_t index) {
  return {filling.seed, base::Purpose::tile_discs, filling.layer, static_cast<std::uint32_t>(piece),
          static_cast<std::uint32_t>(index)};
}

void append_sites(std::vector<Site>& sites, const std::vector<Disc>& discs, double west, double south, double side) {
  for (const Disc& disc : discs) {
    const double x = disc.x - west, y = disc.y - south;
    const Site site{static_cast<float>(x), static_cast<float>(y), static_cast<float>(disc.radius)};
    // Both tests, because the side need not be a float: rounding may carry a point beyond it back inside.
    const bool inside = x >= 0 && y >= 0 && x < side && y < side;
    if (inside && static_cast<double>(site.x_m) < side && static_cast<double>(site.y_m) < side) sites.push_back(site);
  }
}

TileSet empty_tiles(const config::TileSettings& settings) {
  TileSet set;
  set.side_m = settings.side_m;
  set.most_radius_m = settings.most_radius_m;
  set.colours = settings.colours;
  set.variants = settings.variants;
  const int c = settings.colours;
  for (int n = 0; n < c; ++n) {
    for (int w = 0; w < c; ++w) {
      for (int k = 0; k < settings.variants; ++k) {
        // South runs through the colours other than north, east through those other than west (A1).
        const int s = (n + 1 + k) % c, e = (w + 1 + (k + n) % (c - 1)) % c;
        Tile tile;
        tile.colours = {static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(e), static_cast<std::uint8_t>(s),
                        static_cast<std::uint8_t>(w)};
        set.tiles.push_back(std::move(tile));
      }
    }
  }
  return set;
}

TileSet fill_tiles(const config::TileSettings& settings, std::uint64_t seed, std::uint32_t layer) {
  if (auto found = faults(settings); !found.empty()) throw base::ConfigError(std::move(found));
  TileSet set = empty_tiles(settings);
  const Radii radii(settings);
  const Filling filling{set, radii, radii.sites_per_m2(settings.coverage), seed, layer};
  if (settings.mode == config::TileMode::seamless) {
    fill_seamless(filling);
  } else {
    fill_paper(filling);
  }
  for (Tile& tile : set.tiles) {
    std::sort(tile.sites.begin(), tile.sites.end(), [](const Site& a, const Site& b) {
      return std::array{a.y_m, a.x_m, a.radius_m} < std::array{b.y_m, b.x_m, b.radius_m};
    });
  }
  return set;
}

}  // namespace silvasim::tiles
