#include "silvasim/tiles/tile_land.h"

#include <cstddef>

#include "silvasim/base/error.h"
#include "silvasim/base/random.h"

namespace silvasim::tiles {

Tiling tile_land(const TileSet& set, int columns, int rows, std::uint64_t seed, std::uint32_t layer) {
  if (columns < 1 || rows < 1) throw base::Error("a tiling needs at least one column and one row");
  const std::uint32_t colours = static_cast<std::uint32_t>(set.colours);
  const std::uint32_t variants = static_cast<std::uint32_t>(set.variants);
  Tiling tiling;
  tiling.columns = columns;
  tiling.rows = rows;
  tiling.tiles.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      base::Stream random(seed, base::Purpose::tiling, layer, static_cast<std::uint32_t>(column),
                          static_cast<std::uint32_t>(row));
      const std::uint32_t variant = random.next_below(variants);
      // Where there is no neighbour any colour will do.
      const std::uint32_t north =
          row > 0 ? set.tiles[tiling.at(column, row - 1)].colours.south : random.next_below(colours);
      const std::uint32_t west =
          column > 0 ? set.tiles[tiling.at(column - 1, row)].colours.east : random.next_below(colours);
      const std::size_t position =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
      tiling.tiles[position] = static_cast<std::uint16_t>((north * colours + west) * variants + variant);
    }
  }
  return tiling;
}

}  // namespace silvasim::tiles
