#include "made_land.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "silvasim/base/random.h"

namespace silvasim::testing {

namespace {

struct Name {
  const char* name;
  const char* common;
  std::uint32_t colour;
};

constexpr std::array<Name, 12> flora = {{
    {"Picea abies", "Norway spruce", 0x1F5F3A},
    {"Fagus sylvatica", "European beech", 0x7FB04A},
    {"Larix decidua", "European larch", 0xD9A441},
    {"Quercus robur", "Pedunculate oak", 0x9A6B3F},
    {"Abies alba", "Silver fir", 0x2F7F86},
    {"Pinus cembra", "Swiss stone pine", 0x5B4E8C},
    {"Acer pseudoplatanus", "Sycamore maple", 0xC8553D},
    {"Betula pendula", "Silver birch", 0xC9CF6A},
    {"Fraxinus excelsior", "European ash", 0x5FA8A0},
    {"Sorbus aucuparia", "Rowan", 0xE07B67},
    {"Pinus sylvestris", "Scots pine", 0x4F7D5B},
    {"Alnus glutinosa", "Black alder", 0x6A5A4A},
}};

double hill(double x, double y, double width) {
  // A ridge, a valley and two rounds of smaller forms, in parts of the land's width.
  const double u = x / width, v = y / width;
  return width * (0.10 * std::sin(3.1 * u + 1.2 * v) + 0.07 * std::cos(4.3 * v - 1.7 * u) +
                  0.02 * std::sin(11 * u + 7 * v) + 0.015 * std::cos(17 * v - 9 * u) + 0.2) +
         300;
}

std::vector<tiles::Site> throw_sites(const MadeLand& made, std::uint32_t tile, std::uint32_t layer) {
  base::Stream random(made.seed, base::Purpose::tile_discs, tile, layer);
  std::vector<tiles::Site> sites;
  for (int dart = 0; dart < made.sites_per_tile * 8 && static_cast<int>(sites.size()) < made.sites_per_tile; ++dart) {
    // Large discs first.
    const double share = 1 - std::min(1.0, dart / (made.sites_per_tile * 2.0));
    const double radius =
        made.least_radius_m + (made.most_radius_m - made.least_radius_m) * share * random.next_double();
    const double x = radius + (made.side_m - 2 * radius) * random.next_double();
    const double y = radius + (made.side_m - 2 * radius) * random.next_double();
    const bool free = std::none_of(sites.begin(), sites.end(), [&](const tiles::Site& site) {
      const double dx = static_cast<double>(site.x_m) - x, dy = static_cast<double>(site.y_m) - y;
      const double apart = static_cast<double>(site.radius_m) + radius;
      return dx * dx + dy * dy < apart * apart;
    });
    if (free) sites.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(radius)});
  }
  std::sort(sites.begin(), sites.end(),
            [](const tiles::Site& a, const tiles::Site& b) { return a.y_m != b.y_m ? a.y_m < b.y_m : a.x_m < b.x_m; });
  return sites;
}

void plant(ecosystem::Layer& layer, const MadeLand& made, std::uint32_t number) {
  const std::uint32_t variety = 18;
  layer.tile_set.side_m = made.side_m;
  layer.tile_set.most_radius_m = made.most_radius_m;
  layer.tile_set.colours = 3;
  layer.tile_set.variants = 2;
  for (std::uint32_t t = 0; t < variety; ++t) layer.tile_set.tiles.push_back({{}, throw_sites(made, t, number)});
  layer.tiling.columns = made.columns;
  layer.tiling.rows = made.rows;
  base::Stream random(made.seed, base::Purpose::tiling, number);
  for (int i = 0; i < made.columns * made.rows; ++i) {
    layer.tiling.tiles.push_back(static_cast<std::uint16_t>(random.next_below(variety)));
  }
  layer.north_west = {made.south_west.x, made.south_west.y + made.rows * made.side_m};
  // Bands of species by height, with soft borders and a clearing.
  const double width = made.columns * made.side_m;
  base::Stream choice(made.seed, base::Purpose::selection, number);
  for (int row = 0; row < made.rows; ++row) {
    for (int column = 0; column < made.columns; ++column) {
      const base::Point origin = ecosystem::tile_origin(layer, column, row);
      for (const tiles::Site& site : layer.tile_set.tiles[layer.tiling.at(column, row)].sites) {
        const double x = origin.x + static_cast<double>(site.x_m) - made.south_west.x;
        const double y = origin.y + static_cast<double>(site.y_m) - made.south_west.y;
        const double zone = (hill(x, y, width) - 300) / (0.4 * width) + 0.25 * (choice.next_double() - 0.5);
        const double dx = x / width - 0.62, dy = y / width - 0.35;
        const bool clearing = dx * dx + dy * dy < 0.006;
        const bool stands = choice.next_double() < made.stands && !clearing;
        const int species = std::clamp(static_cast<int>(zone * made.species), 0, made.species - 1);
        layer.plants.push_back(stands && made.species > 0 ? static_cast<ecosystem::PlantId>(species)
                                                          : ecosystem::no_plant);
        if (made.probabilities) {
          const double probability = std::clamp(1 - std::fabs(zone * made.species - species - 0.5), 0.0, 1.0);
          layer.probabilities.push_back(static_cast<std::uint16_t>(probability * 65535));
        }
      }
    }
  }
}

// Any shares on cells of 20 m, some of them without sites.
void map_suitability(ecosystem::Layer& layer, const MadeLand& made) {
  ecosystem::SuitabilityMap& map = layer.suitability;
  if (layer.species.empty()) return;
  map.cell_m = 20;
  map.columns = static_cast<int>(std::ceil(made.columns * made.side_m / map.cell_m));
  map.rows = static_cast<int>(std::ceil(made.rows * made.side_m / map.cell_m));
  map.west = layer.north_west.x;
  map.north = layer.north_west.y;
  for (int s = 0; s < static_cast<int>(layer.species.size()); ++s) {
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        const bool bare = (column + 3 * row) % 11 == 0;
        const int share = (column * 5 + row * 3 + s * 60) % 255;
        map.shares.push_back(bare ? ecosystem::SuitabilityMap::no_site : static_cast<std::uint8_t>(share));
      }
    }
  }
}

ecosystem::Species species_of(int index, const MadeLand& made) {
  const Name& name = flora[static_cast<std::size_t>(index) % flora.size()];
  ecosystem::Species species;
  species.name = name.name;
  if (index >= static_cast<int>(flora.size())) species.name += " var. " + std::to_string(index);
  species.common_name = name.common;
  species.colour = name.colour;
  species.model = "./model/tree.obj";
  species.model_radius_m = static_cast<float>(made.most_radius_m * 0.8);
  species.height_m = static_cast<float>(20 + index % 7);
  species.least_scale = 0.1f;
  species.most_scale = 2;
  return species;
}

}  // namespace

ecosystem::Ecosystem make_land(const MadeLand& made) {
  ecosystem::Ecosystem ecosystem;
  ecosystem.name = "Made hills";
  ecosystem.crs_wkt = made.crs_wkt;
  ecosystem.extent = {made.south_west.x, made.south_west.y, made.south_west.x + made.columns * made.side_m,
                      made.south_west.y + made.rows * made.side_m};
  ecosystem.provenance_json = R"({"seed": 7, "version": "0.1.0"})";
  ecosystem::Layer layer;
  layer.name = "trees";
  for (int s = 0; s < made.species; ++s) layer.species.push_back(species_of(s, made));
  plant(layer, made, 0);
  if (made.probabilities) map_suitability(layer, made);
  ecosystem.layers.push_back(std::move(layer));
  if (made.terrain) {
    ecosystem::Terrain& terrain = ecosystem.terrain;
    const double width = ecosystem.extent.width();
    terrain.columns = 240;
    terrain.rows = std::max(1, static_cast<int>(240 * ecosystem.extent.height() / width));
    terrain.west = ecosystem.extent.west;
    terrain.north = ecosystem.extent.north;
    terrain.cell_width_m = width / terrain.columns;
    terrain.cell_height_m = ecosystem.extent.height() / terrain.rows;
    for (int j = 0; j < terrain.rows; ++j) {
      for (int i = 0; i < terrain.columns; ++i) {
        const double x = (i + 0.5) * terrain.cell_width_m;
        const double y = ecosystem.extent.height() - (j + 0.5) * terrain.cell_height_m;
        terrain.heights_m.push_back(static_cast<float>(hill(x, y, width)));
      }
    }
  }
  return ecosystem;
}

void add_shrubs(ecosystem::Ecosystem& ecosystem, const MadeLand& made) {
  MadeLand small = made;
  small.seed += 100;
  small.least_radius_m = made.least_radius_m * 0.3;
  small.most_radius_m = made.most_radius_m * 0.3;
  ecosystem::Layer layer;
  layer.name = "shrubs & herbs";
  for (const Name& name :
       {Name{"Vaccinium myrtillus", "Bilberry", 0x8E4A7A}, Name{"Corylus avellana", "Hazel", 0xB98B4F}}) {
    ecosystem::Species species = species_of(0, small);
    species.name = name.name;
    species.common_name = name.common;
    species.colour = name.colour;
    species.height_m = 1.5f;
    layer.species.push_back(species);
  }
  small.species = 2;
  plant(layer, small, 1);
  if (made.probabilities) map_suitability(layer, small);
  ecosystem.layers.push_back(std::move(layer));
}

std::string utm_10_north() {
  return R"(PROJCRS["WGS 84 / UTM zone 10N",BASEGEOGCRS["WGS 84",DATUM["World Geodetic System 1984",)"
         R"(ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],PRIMEM["Greenwich",0,)"
         R"(ANGLEUNIT["degree",0.0174532925199433]],ID["EPSG",4326]],CONVERSION["UTM zone 10N",)"
         R"(METHOD["Transverse Mercator",ID["EPSG",9807]],PARAMETER["Latitude of natural origin",0,)"
         R"(ANGLEUNIT["degree",0.0174532925199433],ID["EPSG",8801]],PARAMETER["Longitude of natural origin",-123,)"
         R"(ANGLEUNIT["degree",0.0174532925199433],ID["EPSG",8802]],PARAMETER["Scale factor at natural origin",0.9996,)"
         R"(SCALEUNIT["unity",1],ID["EPSG",8805]],PARAMETER["False easting",500000,LENGTHUNIT["metre",1],)"
         R"(ID["EPSG",8806]],PARAMETER["False northing",0,LENGTHUNIT["metre",1],ID["EPSG",8807]]],)"
         R"(CS[Cartesian,2],AXIS["easting",east,ORDER[1],LENGTHUNIT["metre",1]],AXIS["northing",north,ORDER[2],)"
         R"(LENGTHUNIT["metre",1]],ID["EPSG",32610]])";
}

std::uint64_t recount(const ecosystem::Ecosystem& ecosystem, std::size_t layer, std::size_t species,
                      const base::Box& box) {
  const ecosystem::Layer& of = ecosystem.layers[layer];
  std::uint64_t count = 0;
  ecosystem::for_each_plant(
      of, ecosystem::site_offsets(of.tile_set, of.tiling), 0, of.tiling.rows,
      [&](const ecosystem::Plant& each) { count += each.species == species && box.contains(each.at); });
  return count;
}

}  // namespace silvasim::testing
