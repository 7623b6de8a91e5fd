// The contents of the chunks, each written and read side by side, so that the two cannot drift apart.
// docs/ecosystem-file.md, "The chunks".
//
// Errors: the get_ functions throw base::Error that names the chunk and the byte, through their ByteReader. They check
// lengths; values are checked by validity.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "silvasim/ecosystem/bytes.h"
#include "silvasim/ecosystem/chunks.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::ecosystem {

inline constexpr ChunkType meta_type{'M', 'E', 'T', 'A'};           // name, CRS, extent, number of layers
inline constexpr ChunkType provenance_type{'P', 'R', 'O', 'V'};     // JSON text
inline constexpr ChunkType terrain_type{'T', 'E', 'R', 'R'};        // the grid of heights
inline constexpr ChunkType heights_type{'H', 'G', 'T', 'S'};        // bands
inline constexpr ChunkType layer_type{'L', 'A', 'Y', 'R'};          // name, place and size of the tiling
inline constexpr ChunkType species_type{'S', 'P', 'E', 'C'};        // species table with plant counts
inline constexpr ChunkType tile_set_type{'T', 'S', 'E', 'T'};       // tiles and their sites
inline constexpr ChunkType tiling_type{'T', 'L', 'N', 'G'};         // tile indices
inline constexpr ChunkType plants_type{'P', 'L', 'N', 'T'};         // bands of plant ids
inline constexpr ChunkType probabilities_type{'P', 'R', 'O', 'B'};  // bands of probabilities
inline constexpr ChunkType suitability_type{'S', 'U', 'I', 'T'};    // map a species; optional
inline constexpr ChunkType filler_type{'F', 'I', 'L', 'L'};         // zeros; optional

void put_meta(ByteWriter& to, const Ecosystem& ecosystem);
std::uint32_t get_meta(ByteReader& from, Ecosystem& ecosystem);  // returns the number of layers

void put_terrain(ByteWriter& to, const Terrain& terrain);
void get_terrain(ByteReader& from, Terrain& terrain);

// What of a layer is neither species, tile nor band.
struct LayerCounts {
  std::uint64_t sites = 0;
  bool has_probabilities = false;
};
void put_layer(ByteWriter& to, const Layer& layer);
LayerCounts get_layer(ByteReader& from, Layer& layer);

// `plants`: how many of each species stand.
void put_species(ByteWriter& to, const std::vector<Species>& species, const std::vector<std::uint64_t>& plants);
void get_species(ByteReader& from, std::vector<Species>& species, std::vector<std::uint64_t>& plants);

void put_tile_set(ByteWriter& to, const tiles::TileSet& set);
void get_tile_set(ByteReader& from, tiles::TileSet& set);

void put_tiling(ByteWriter& to, const tiles::Tiling& tiling);
void get_tiling(ByteReader& from, tiles::Tiling& tiling);  // columns and rows known from the layer

void put_suitability(ByteWriter& to, const SuitabilityMap& map);
void get_suitability(ByteReader& from, SuitabilityMap& map);

// Plant ids take one byte where every species and "no plant" (all bits set) have a value of their own, else two.
inline std::size_t bytes_a_plant(std::size_t species) { return species < 0xFF ? 1 : 2; }

std::vector<std::byte> bytes_from_plants(std::span<const PlantId> plants, std::size_t species);
void plants_from_bytes(std::span<const std::byte> bytes, std::size_t species, std::span<PlantId> plants);

// Probabilities, tile indices.
std::vector<std::byte> bytes_from_u16(std::span<const std::uint16_t> numbers);
void u16_from_bytes(std::span<const std::byte> bytes, std::span<std::uint16_t> numbers);

}  // namespace silvasim::ecosystem
