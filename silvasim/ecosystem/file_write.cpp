// ecosystem::write(): plans the chunks, packs them in parallel, puts them one after another.
#include <algorithm>
#include <functional>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/base/parallel.h"
#include "silvasim/ecosystem/bytes.h"
#include "silvasim/ecosystem/chunks.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/ecosystem/heights.h"
#include "silvasim/ecosystem/records.h"
#include "silvasim/ecosystem/validity.h"

namespace silvasim::ecosystem {

namespace {

// A band holds about this many sites or heights: enough for zstd to learn from, few enough to share among threads.
constexpr std::uint64_t band_size = 1 << 18;

struct Job {
  Chunk chunk;
  std::function<std::vector<std::byte>()> content;
};

std::uint32_t rows_a_band(std::uint64_t total, std::uint64_t rows) {
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(band_size * rows / std::max<std::uint64_t>(total, 1), 1, rows));
}

template <typename Put>
Job record(ChunkType type, std::uint32_t layer, Put put) {
  return {{.type = type, .layer = layer}, [put] {
            ByteWriter to;
            put(to);
            return to.take();
          }};
}

// One job a band of rows; `content(first, rows)` gives its bytes.
template <typename Content>
void add_bands(std::vector<Job>& jobs, ChunkType type, std::uint32_t layer, std::uint64_t total, int rows,
               Content content) {
  if (rows <= 0) return;
  const auto all = static_cast<std::uint32_t>(rows), step = rows_a_band(total, all);
  for (std::uint32_t first = 0; first < all; first += step) {
    const std::uint32_t count = std::min(step, all - first);
    jobs.push_back({{.type = type, .layer = layer, .first_row = first, .rows = count},
                    [content, first, count] { return content(first, count); }});
  }
}

void add_layer(std::vector<Job>& jobs, const Layer& layer, std::uint32_t number) {
  jobs.push_back(record(layer_type, number, [&layer](ByteWriter& to) { put_layer(to, layer); }));
  jobs.push_back(record(species_type, number,
                        [&layer](ByteWriter& to) { put_species(to, layer.species, plants_by_species(layer)); }));
  jobs.push_back(record(tile_set_type, number, [&layer](ByteWriter& to) { put_tile_set(to, layer.tile_set); }));
  jobs.push_back(record(tiling_type, number, [&layer](ByteWriter& to) { put_tiling(to, layer.tiling); }));

  // The first site of each row of tiles.
  std::vector<std::uint64_t> first_site{0};
  for (int row = 0; row < layer.tiling.rows; ++row) {
    std::uint64_t sites = 0;
    for (int column = 0; column < layer.tiling.columns; ++column) {
      sites += layer.tile_set.tiles[layer.tiling.at(column, row)].sites.size();
    }
    first_site.push_back(first_site.back() + sites);
  }
  const std::uint64_t total = first_site.back();
  add_bands(jobs, plants_type, number, total, layer.tiling.rows,
            [&layer, first_site](std::uint32_t first, std::uint32_t rows) {
              const std::uint64_t begin = first_site[first], end = first_site[first + rows];
              return bytes_from_plants(std::span(layer.plants).subspan(begin, end - begin), layer.species.size());
            });
  if (!layer.suitability.empty()) {
    jobs.push_back(
        record(suitability_type, number, [&layer](ByteWriter& to) { put_suitability(to, layer.suitability); }));
    jobs.back().chunk.flags = flag_optional;
  }
  if (layer.probabilities.empty()) return;
  add_bands(jobs, probabilities_type, number, total, layer.tiling.rows,
            [&layer, first_site](std::uint32_t first, std::uint32_t rows) {
              const std::uint64_t begin = first_site[first], end = first_site[first + rows];
              return bytes_from_u16(std::span(layer.probabilities).subspan(begin, end - begin));
            });
}

std::vector<Job> plan(const Ecosystem& ecosystem) {
  std::vector<Job> jobs;
  jobs.push_back(record(meta_type, no_layer, [&ecosystem](ByteWriter& to) { put_meta(to, ecosystem); }));
  jobs.push_back(record(provenance_type, no_layer, [&ecosystem](ByteWriter& to) {
    to.put_raw(std::as_bytes(std::span(ecosystem.provenance_json)));
  }));
  const Terrain& terrain = ecosystem.terrain;
  jobs.push_back(record(terrain_type, no_layer, [&terrain](ByteWriter& to) { put_terrain(to, terrain); }));
  add_bands(jobs, heights_type, no_layer, terrain.heights_m.size(), terrain.rows,
            [&terrain](std::uint32_t first, std::uint32_t rows) {
              const auto columns = static_cast<std::size_t>(terrain.columns);
              return bytes_from_heights(std::span(terrain.heights_m).subspan(first * columns, rows * columns), columns);
            });
  for (std::size_t i = 0; i < ecosystem.layers.size(); ++i) {
    add_layer(jobs, ecosystem.layers[i], static_cast<std::uint32_t>(i));
  }
  return jobs;
}

// The file in pieces: header, chunks, table and footer.
std::vector<std::vector<std::byte>> pieces_of(const Ecosystem& ecosystem) {
  if (const std::string problem = problem_with(ecosystem); !problem.empty()) {
    throw base::Error("cannot write the ecosystem: " + problem);
  }
  std::vector<Job> jobs = plan(ecosystem);
  std::vector<std::vector<std::byte>> pieces(jobs.size() + 1);
  pieces[0] = header_bytes();
  base::parallel_for(jobs.size(), [&](std::size_t i) { pieces[i + 1] = pack(jobs[i].chunk, jobs[i].content()); });

  std::vector<Chunk> chunks;
  std::uint64_t content = 0;
  for (const Job& job : jobs) {
    chunks.push_back(job.chunk);
    content += job.chunk.content_size;
  }
  // A land that is all alike unfolds to more than readers believe of so small a file: then make the file larger.
  if (content > most_content(file_size_of(chunks))) {
    Chunk filler{.type = filler_type, .flags = flag_optional, .codec = Codec::raw};
    const std::uint64_t size = (content - most_content(file_size_of(chunks))) / 1023 + 1;
    pieces.push_back(pack(filler, std::vector<std::byte>(size)));
    chunks.push_back(filler);
  }
  pieces.push_back(table_and_footer_bytes(chunks));
  return pieces;
}

}  // namespace

void write(const Ecosystem& ecosystem, const std::filesystem::path& path, std::span<const std::filesystem::path> inputs,
           const base::Progress& progress) {
  base::report(progress, "write", 0);
  base::NewFile file(path, inputs);
  const auto pieces = pieces_of(ecosystem);
  base::report(progress, "write", 0.8);
  for (const auto& piece : pieces) file.write(piece);
  file.commit();
  base::report(progress, "write", 1);
}

std::vector<std::byte> to_bytes(const Ecosystem& ecosystem) {
  std::vector<std::byte> bytes;
  for (const auto& piece : pieces_of(ecosystem)) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return bytes;
}

}  // namespace silvasim::ecosystem
