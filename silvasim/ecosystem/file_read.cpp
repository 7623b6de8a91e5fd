// ecosystem::read(): sorts the chunks by what they are, reads the small ones, checks that the sizes of the large ones
// agree with them, and only then makes room and unpacks those in parallel.
#include <algorithm>
#include <new>
#include <set>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/ecosystem/chunks.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/ecosystem/heights.h"
#include "silvasim/ecosystem/records.h"
#include "silvasim/ecosystem/validity.h"

namespace silvasim::ecosystem {

namespace {

using ChunkRef = const Chunk*;

struct LayerChunks {
  ChunkRef layer = nullptr, species = nullptr, tile_set = nullptr, tiling = nullptr, suitability = nullptr;
  std::vector<ChunkRef> plants, probabilities;
};

struct SortedChunks {
  ChunkRef meta = nullptr, provenance = nullptr, terrain = nullptr;
  std::vector<ChunkRef> heights;
  std::vector<LayerChunks> layers;
  std::vector<ChunkRef> skipped;
};

// Where a chunk of this type belongs; null for unknown types.
struct Place {
  ChunkRef* one = nullptr;
  std::vector<ChunkRef>* bands = nullptr;
};

Place place_of(const Chunk& chunk, SortedChunks& sorted, LayerChunks* layer) {
  if (chunk.layer == no_layer) {
    if (chunk.type == meta_type) return {&sorted.meta};
    if (chunk.type == provenance_type) return {&sorted.provenance};
    if (chunk.type == terrain_type) return {&sorted.terrain};
    if (chunk.type == heights_type) return {nullptr, &sorted.heights};
  } else if (layer != nullptr) {
    if (chunk.type == layer_type) return {&layer->layer};
    if (chunk.type == species_type) return {&layer->species};
    if (chunk.type == tile_set_type) return {&layer->tile_set};
    if (chunk.type == tiling_type) return {&layer->tiling};
    if (chunk.type == suitability_type) return {&layer->suitability};
    if (chunk.type == plants_type) return {nullptr, &layer->plants};
    if (chunk.type == probabilities_type) return {nullptr, &layer->probabilities};
  }
  return {};
}

bool is_known(ChunkType type) {
  constexpr std::array known{meta_type,   provenance_type,    terrain_type,    heights_type,
                             layer_type,  species_type,       tile_set_type,   tiling_type,
                             plants_type, probabilities_type, suitability_type};
  return std::ranges::find(known, type) != known.end();
}

SortedChunks sort_chunks(const ChunkFile& file) {
  SortedChunks sorted;
  for (const Chunk& chunk : file.chunks()) {
    if (!is_known(chunk.type)) {
      if (!chunk.optional()) {
        file.fail(chunk, "this type of chunk is unknown and must not be skipped; the file is of format version " +
                             std::to_string(format_major) + "." + std::to_string(file.minor()) +
                             ", this program knows version " + std::to_string(format_major) + "." +
                             std::to_string(format_minor));
      }
      sorted.skipped.push_back(&chunk);
      continue;
    }
    const std::uint16_t flags = chunk.type == suitability_type ? flag_optional : 0;
    if (chunk.flags != flags) {
      file.fail(chunk, "its flags are " + std::to_string(chunk.flags) + ", they must be " + std::to_string(flags));
    }
    // Each layer has at least one chunk, so there are no more layers than chunks.
    LayerChunks* layer = nullptr;
    if (chunk.layer != no_layer) {
      if (chunk.layer >= file.chunks().size()) file.fail(chunk, "there is no layer " + std::to_string(chunk.layer));
      if (chunk.layer >= sorted.layers.size()) sorted.layers.resize(chunk.layer + 1);
      layer = &sorted.layers[chunk.layer];
    }
    const Place place = place_of(chunk, sorted, layer);
    if (place.bands != nullptr) {
      place.bands->push_back(&chunk);
      continue;
    }
    if (place.one == nullptr) {
      file.fail(chunk, chunk.layer == no_layer ? "it belongs to no layer, but should"
                                               : "it belongs to a layer, but should not");
    }
    if (*place.one != nullptr) file.fail(chunk, "there is another, the " + name_of(**place.one));
    if (chunk.first_row != 0 || chunk.rows != 0) file.fail(chunk, "it is no band, but its table entry speaks of rows");
    *place.one = &chunk;
  }
  return sorted;
}

const Chunk& need(const ChunkFile& file, ChunkRef chunk, ChunkType type, const std::string& of) {
  if (chunk == nullptr) file.fail("the chunk " + std::string(type.begin(), type.end()) + of + " is missing");
  return *chunk;
}

// Unpacks a small chunk and hands it to `get`.
template <typename Get>
void read_record(const ChunkFile& file, const Chunk& chunk, Get get) {
  const std::vector<std::byte> content = file.content(chunk);
  ByteReader from(content, file.where(chunk));
  get(from);
}

void refuse(const ChunkFile& file, const Chunk& chunk, const std::string& problem) {
  if (!problem.empty()) file.fail(chunk, problem);
}

// Bands lie one after another and hold rows [0, rows) together. `items_before(row)` counts what the rows before hold.
template <typename ItemsBefore>
void check_bands(const ChunkFile& file, const std::vector<ChunkRef>& bands, ChunkType type, std::uint64_t rows,
                 std::uint64_t bytes_an_item, ItemsBefore items_before) {
  std::uint64_t next = 0;
  for (const ChunkRef band : bands) {
    if (band->first_row != next || band->rows == 0 || band->rows > rows - next) {
      file.fail(*band, "it holds rows " + std::to_string(band->first_row) + " to " +
                           std::to_string(std::uint64_t{band->first_row} + band->rows) + ", expected are rows from " +
                           std::to_string(next) + " to at most " + std::to_string(rows));
    }
    next += band->rows;
    const std::uint64_t items = items_before(next) - items_before(band->first_row);
    if (band->content_size % bytes_an_item != 0 || band->content_size / bytes_an_item != items) {
      file.fail(*band, "it unfolds to " + std::to_string(band->content_size) + " bytes, its rows need " +
                           std::to_string(items) + " times " + std::to_string(bytes_an_item));
    }
  }
  if (next != rows) {
    file.fail("the chunks " + std::string(type.begin(), type.end()) + " hold " + std::to_string(next) + " of " +
              std::to_string(rows) + " rows; a chunk is missing");
  }
}

// Everything but the bands, which are only measured.
struct Opened {
  ChunkFile file;
  SortedChunks chunks;
  Summary summary;
  std::set<std::string> names;                         // of the layers
  std::vector<std::vector<std::uint64_t>> first_site;  // by layer: the first site of each row of tiles, and the total

  explicit Opened(const Source& source) : file(source), chunks(sort_chunks(file)) {
    Ecosystem& ecosystem = summary.ecosystem;
    summary.format_major = format_major;
    summary.format_minor = file.minor();
    summary.file_bytes = source.size();

    const Chunk& meta = need(file, chunks.meta, meta_type, "");
    std::uint32_t layers = 0;
    read_record(file, meta, [&](ByteReader& from) { layers = get_meta(from, ecosystem); });
    refuse(file, meta, problem_with_frame(ecosystem));
    if (layers == 0 || layers != chunks.layers.size()) {
      file.fail(meta, "it announces " + std::to_string(layers) + " layers, there are chunks of " +
                          std::to_string(chunks.layers.size()));
    }
    const Chunk& provenance = need(file, chunks.provenance, provenance_type, "");
    const std::vector<std::byte> text = file.content(provenance);
    ecosystem.provenance_json.assign(reinterpret_cast<const char*>(text.data()), text.size());
    refuse(file, provenance, problem_with_provenance(ecosystem.provenance_json));

    const Chunk& terrain = need(file, chunks.terrain, terrain_type, "");
    read_record(file, terrain, [&](ByteReader& from) { get_terrain(from, ecosystem.terrain); });
    refuse(file, terrain, problem_with_grid(ecosystem.terrain));
    const auto columns = static_cast<std::uint64_t>(ecosystem.terrain.columns);
    check_bands(file, chunks.heights, heights_type, static_cast<std::uint64_t>(ecosystem.terrain.rows), sizeof(float),
                [columns](std::uint64_t row) { return row * columns; });

    ecosystem.layers.resize(layers);
    summary.plants.resize(layers);
    first_site.resize(layers);
    for (std::size_t i = 0; i < layers; ++i) open_layer(i);
  }

  void open_layer(std::size_t i) {
    const LayerChunks& of = chunks.layers[i];
    Layer& layer = summary.ecosystem.layers[i];
    Summary::Plants& plants = summary.plants[i];
    const std::string name = " of layer " + std::to_string(i);

    LayerCounts counts;
    const Chunk& head = need(file, of.layer, layer_type, name);
    read_record(file, head, [&](ByteReader& from) { counts = get_layer(from, layer); });
    refuse(file, head, problem_with_head(layer));
    if (!names.insert(layer.name).second) file.fail(head, "two layers are named \"" + layer.name + "\"");

    const Chunk& species = need(file, of.species, species_type, name);
    read_record(file, species, [&](ByteReader& from) { get_species(from, layer.species, plants.by_species); });
    refuse(file, species, problem_with(layer.species));

    const Chunk& tile_set = need(file, of.tile_set, tile_set_type, name);
    read_record(file, tile_set, [&](ByteReader& from) { get_tile_set(from, layer.tile_set); });
    refuse(file, tile_set, problem_with(layer.tile_set));

    const Chunk& tiling = need(file, of.tiling, tiling_type, name);
    read_record(file, tiling, [&](ByteReader& from) { get_tiling(from, layer.tiling); });
    refuse(file, tiling, problem_with(layer.tiling, layer.tile_set));

    count_sites(layer, counts.sites, head, first_site[i]);
    const auto before = [&](std::uint64_t row) { return first_site[i][row]; };
    const auto rows = static_cast<std::uint64_t>(layer.tiling.rows);
    check_bands(file, of.plants, plants_type, rows, bytes_a_plant(layer.species.size()), before);
    if (counts.has_probabilities) {
      check_bands(file, of.probabilities, probabilities_type, rows, sizeof(std::uint16_t), before);
    } else if (!of.probabilities.empty()) {
      file.fail(*of.probabilities[0], "the layer says that it has no probabilities");
    }

    if (of.suitability != nullptr) {
      read_record(file, *of.suitability, [&](ByteReader& from) { get_suitability(from, layer.suitability); });
      refuse(file, *of.suitability, problem_with(layer.suitability, layer.species.size()));
    }

    plants.sites = counts.sites;
    plants.probabilities = counts.has_probabilities;
    for (const std::uint64_t count : plants.by_species) {
      if (count > plants.sites - plants.standing) file.fail(species, "it counts more plants than there are sites");
      plants.standing += count;
    }
  }

  // Stops at the first row that exceeds what the layer announces, so that nothing overflows.
  void count_sites(const Layer& layer, std::uint64_t announced, const Chunk& head,
                   std::vector<std::uint64_t>& first) const {
    first.assign(1, 0);
    std::uint64_t total = 0;
    for (int row = 0; row < layer.tiling.rows; ++row) {
      for (int column = 0; column < layer.tiling.columns; ++column) {
        const std::uint64_t sites = layer.tile_set.tiles[layer.tiling.at(column, row)].sites.size();
        if (sites > announced - total) {
          file.fail(head, "it announces " + std::to_string(announced) + " sites, the tiling has more");
        }
        total += sites;
      }
      first.push_back(total);
    }
    if (total != announced) {
      file.fail(head, "it announces " + std::to_string(announced) + " sites, the tiling has " + std::to_string(total));
    }
  }
};

void unpack_plants(const ChunkFile& file, const Chunk& band, std::size_t species, std::span<PlantId> plants) {
  const std::vector<std::byte> content = file.content(band);
  plants_from_bytes(content, species, plants);
  const auto wrong = [species](PlantId id) { return id >= species && id != no_plant; };
  std::size_t count = 0;
  for (const PlantId id : plants) count += wrong(id) ? 1 : 0;
  if (count == 0) return;
  const auto first = static_cast<std::size_t>(std::ranges::find_if(plants, wrong) - plants.begin());
  file.fail(band, "at byte " + std::to_string(first * bytes_a_plant(species)) + " of its content: species " +
                      std::to_string(plants[first]) + " of " + std::to_string(species));
}

Ecosystem read_all(const Source& source, const base::Progress& progress) {
  base::report(progress, "read", 0);
  Opened opened(source);
  const ChunkFile& file = opened.file;
  Ecosystem ecosystem = std::move(opened.summary.ecosystem);

  // The sizes agree by now, so make room.
  Terrain& terrain = ecosystem.terrain;
  terrain.heights_m.resize(static_cast<std::size_t>(terrain.columns) * static_cast<std::size_t>(terrain.rows));
  std::vector<std::pair<ChunkRef, Layer*>> bands;
  for (const ChunkRef band : opened.chunks.heights) bands.push_back({band, nullptr});
  for (std::size_t i = 0; i < ecosystem.layers.size(); ++i) {
    Layer& layer = ecosystem.layers[i];
    layer.plants.resize(opened.summary.plants[i].sites);
    if (opened.summary.plants[i].probabilities) layer.probabilities.resize(opened.summary.plants[i].sites);
    for (const ChunkRef band : opened.chunks.layers[i].plants) bands.push_back({band, &layer});
    for (const ChunkRef band : opened.chunks.layers[i].probabilities) bands.push_back({band, &layer});
  }
  for (const ChunkRef chunk : opened.chunks.skipped) bands.push_back({chunk, nullptr});

  base::report(progress, "read", 0.1);
  base::parallel_for(bands.size(), [&](std::size_t i) {
    const Chunk& band = *bands[i].first;
    if (band.type == heights_type) {
      const auto columns = static_cast<std::size_t>(terrain.columns);
      const auto heights = std::span(terrain.heights_m).subspan(band.first_row * columns, band.rows * columns);
      heights_from_bytes(file.content(band), columns, heights);
      return;
    }
    if (bands[i].second == nullptr) return file.check(band);
    Layer& layer = *bands[i].second;
    const std::vector<std::uint64_t>& first_site = opened.first_site[band.layer];
    const std::uint64_t begin = first_site[band.first_row], end = first_site[band.first_row + band.rows];
    if (band.type == plants_type) {
      unpack_plants(file, band, layer.species.size(), std::span(layer.plants).subspan(begin, end - begin));
    } else {
      u16_from_bytes(file.content(band), std::span(layer.probabilities).subspan(begin, end - begin));
    }
  });

  refuse(file, *opened.chunks.terrain, problem_with_heights(terrain.heights_m));
  for (std::size_t i = 0; i < ecosystem.layers.size(); ++i) {
    if (plants_by_species(ecosystem.layers[i]) != opened.summary.plants[i].by_species) {
      file.fail(*opened.chunks.layers[i].species, "its numbers of plants differ from the plants in the file");
    }
  }
  base::report(progress, "read", 1);
  return ecosystem;
}

// A file within the limits may still ask for more than this machine has.
template <typename Work>
auto with_memory_errors(const std::string& name, Work work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw base::Error(name + ": there is not enough memory to read it");
  }
}

}  // namespace

Ecosystem read(const std::filesystem::path& path, const base::Progress& progress) {
  return with_memory_errors(path.string(), [&] { return read_all(*source_from_file(path), progress); });
}

Summary read_summary(const std::filesystem::path& path) {
  return with_memory_errors(path.string(), [&] {
    const auto source = source_from_file(path);
    const Opened opened(*source);
    for (const Chunk& chunk : opened.file.chunks()) opened.file.check(chunk);
    return opened.summary;
  });
}

Ecosystem from_bytes(std::span<const std::byte> bytes, const std::string& name) {
  return with_memory_errors(name, [&] { return read_all(*source_from_memory(bytes, name), {}); });
}

}  // namespace silvasim::ecosystem
