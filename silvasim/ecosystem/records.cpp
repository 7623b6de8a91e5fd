#include "silvasim/ecosystem/records.h"

#include <limits>

namespace silvasim::ecosystem {

namespace {

// The least bytes that a species and a tile take.
constexpr std::size_t species_size = 3 * 4 + 5 * 4 + 8, tile_size = 4 + 4, site_size = 3 * 4;

int get_int(ByteReader& from) {
  const auto value = from.get<std::uint32_t>();
  if (value > static_cast<std::uint32_t>(std::numeric_limits<int>::max())) {
    from.fail("the number " + std::to_string(value) + " is too large");
  }
  return static_cast<int>(value);
}

void put_int(ByteWriter& to, int value) { to.put(static_cast<std::uint32_t>(value)); }

}  // namespace

void put_meta(ByteWriter& to, const Ecosystem& ecosystem) {
  to.put(static_cast<std::uint32_t>(ecosystem.layers.size()));
  for (const double side :
       {ecosystem.extent.west, ecosystem.extent.south, ecosystem.extent.east, ecosystem.extent.north}) {
    to.put(side);
  }
  to.put_text(ecosystem.name);
  to.put_text(ecosystem.crs_wkt);
}

std::uint32_t get_meta(ByteReader& from, Ecosystem& ecosystem) {
  const auto layers = from.get<std::uint32_t>();
  base::Box& box = ecosystem.extent;
  for (double* side : {&box.west, &box.south, &box.east, &box.north}) *side = from.get<double>();
  ecosystem.name = from.get_text();
  ecosystem.crs_wkt = from.get_text();
  from.expect_end();
  return layers;
}

void put_terrain(ByteWriter& to, const Terrain& terrain) {
  put_int(to, terrain.columns);
  put_int(to, terrain.rows);
  for (const double number : {terrain.west, terrain.north, terrain.cell_width_m, terrain.cell_height_m}) to.put(number);
}

void get_terrain(ByteReader& from, Terrain& terrain) {
  terrain.columns = get_int(from);
  terrain.rows = get_int(from);
  for (double* number : {&terrain.west, &terrain.north, &terrain.cell_width_m, &terrain.cell_height_m}) {
    *number = from.get<double>();
  }
  from.expect_end();
}

void put_layer(ByteWriter& to, const Layer& layer) {
  to.put_text(layer.name);
  to.put(layer.north_west.x);
  to.put(layer.north_west.y);
  put_int(to, layer.tiling.columns);
  put_int(to, layer.tiling.rows);
  to.put(static_cast<std::uint64_t>(layer.plants.size()));
  to.put(static_cast<std::uint32_t>(layer.probabilities.empty() ? 0 : 1));
}

LayerCounts get_layer(ByteReader& from, Layer& layer) {
  layer.name = from.get_text();
  layer.north_west.x = from.get<double>();
  layer.north_west.y = from.get<double>();
  layer.tiling.columns = get_int(from);
  layer.tiling.rows = get_int(from);
  LayerCounts counts;
  counts.sites = from.get<std::uint64_t>();
  const auto flag = from.get<std::uint32_t>();
  if (flag > 1) from.fail("whether there are probabilities must be 0 or 1, not " + std::to_string(flag));
  counts.has_probabilities = flag == 1;
  from.expect_end();
  return counts;
}

void put_species(ByteWriter& to, const std::vector<Species>& species, const std::vector<std::uint64_t>& plants) {
  to.put(static_cast<std::uint32_t>(species.size()));
  for (std::size_t i = 0; i < species.size(); ++i) {
    const Species& s = species[i];
    to.put_text(s.name);
    to.put_text(s.common_name);
    to.put_text(s.model);
    to.put(s.colour);
    for (const float number : {s.model_radius_m, s.height_m, s.least_scale, s.most_scale}) to.put(number);
    to.put(plants[i]);
  }
}

void get_species(ByteReader& from, std::vector<Species>& species, std::vector<std::uint64_t>& plants) {
  const std::uint32_t count = from.get_count(species_size);
  for (std::uint32_t i = 0; i < count; ++i) {
    Species& s = species.emplace_back();
    s.name = from.get_text();
    s.common_name = from.get_text();
    s.model = from.get_text();
    s.colour = from.get<std::uint32_t>();
    for (float* number : {&s.model_radius_m, &s.height_m, &s.least_scale, &s.most_scale}) *number = from.get<float>();
    plants.push_back(from.get<std::uint64_t>());
  }
  from.expect_end();
}

void put_tile_set(ByteWriter& to, const tiles::TileSet& set) {
  to.put(set.side_m);
  to.put(set.most_radius_m);
  put_int(to, set.colours);
  put_int(to, set.variants);
  to.put(static_cast<std::uint32_t>(set.tiles.size()));
  for (const tiles::Tile& tile : set.tiles) {
    for (const std::uint8_t colour : {tile.colours.north, tile.colours.east, tile.colours.south, tile.colours.west}) {
      to.put(colour);
    }
    to.put(static_cast<std::uint32_t>(tile.sites.size()));
    for (const tiles::Site& site : tile.sites) {
      for (const float number : {site.x_m, site.y_m, site.radius_m}) to.put(number);
    }
  }
}

void get_tile_set(ByteReader& from, tiles::TileSet& set) {
  set.side_m = from.get<double>();
  set.most_radius_m = from.get<double>();
  set.colours = get_int(from);
  set.variants = get_int(from);
  set.tiles.resize(from.get_count(tile_size));
  for (tiles::Tile& tile : set.tiles) {
    tiles::EdgeColours& edge = tile.colours;
    for (std::uint8_t* colour : {&edge.north, &edge.east, &edge.south, &edge.west}) *colour = from.get<std::uint8_t>();
    tile.sites.resize(from.get_count(site_size));
    for (tiles::Site& site : tile.sites) {
      for (float* number : {&site.x_m, &site.y_m, &site.radius_m}) *number = from.get<float>();
    }
  }
  from.expect_end();
}

void put_tiling(ByteWriter& to, const tiles::Tiling& tiling) { to.put_raw(bytes_from_u16(tiling.tiles)); }

void get_tiling(ByteReader& from, tiles::Tiling& tiling) {
  const std::size_t columns = static_cast<std::size_t>(tiling.columns), rows = static_cast<std::size_t>(tiling.rows);
  // columns * rows < 2^62, so nothing overflows.
  if (from.left() != 2 * columns * rows) {
    from.fail(std::to_string(columns) + " x " + std::to_string(rows) + " tiles take " +
              std::to_string(2 * columns * rows) + " bytes, there are " + std::to_string(from.left()));
  }
  tiling.tiles.resize(columns * rows);
  for (std::uint16_t& tile : tiling.tiles) tile = from.get<std::uint16_t>();
}

void put_suitability(ByteWriter& to, const SuitabilityMap& map) {
  put_int(to, map.columns);
  put_int(to, map.rows);
  for (const double number : {map.west, map.north, map.cell_m}) to.put(number);
  to.put_raw(std::as_bytes(std::span(map.shares)));
}

void get_suitability(ByteReader& from, SuitabilityMap& map) {
  map.columns = get_int(from);
  map.rows = get_int(from);
  for (double* number : {&map.west, &map.north, &map.cell_m}) *number = from.get<double>();
  map.shares.resize(from.left());
  for (std::uint8_t& share : map.shares) share = from.get<std::uint8_t>();
  from.expect_end();
}

std::vector<std::byte> bytes_from_plants(std::span<const PlantId> plants, std::size_t species) {
  if (bytes_a_plant(species) == 2) return bytes_from_u16(plants);
  std::vector<std::byte> bytes(plants.size());
  for (std::size_t i = 0; i < plants.size(); ++i) bytes[i] = static_cast<std::byte>(plants[i]);  // no_plant: 0xFF
  return bytes;
}

void plants_from_bytes(std::span<const std::byte> bytes, std::size_t species, std::span<PlantId> plants) {
  if (bytes_a_plant(species) == 2) return u16_from_bytes(bytes, plants);
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const auto byte = std::to_integer<PlantId>(bytes[i]);
    plants[i] = byte == 0xFF ? no_plant : byte;
  }
}

std::vector<std::byte> bytes_from_u16(std::span<const std::uint16_t> numbers) {
  std::vector<std::byte> bytes(2 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) store(numbers[i], bytes.data() + 2 * i);
  return bytes;
}

void u16_from_bytes(std::span<const std::byte> bytes, std::span<std::uint16_t> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = load<std::uint16_t>(bytes.data() + 2 * i);
}

}  // namespace silvasim::ecosystem
