// A file of details as files for other programs: one format a file, one table.
//
// Units: metres. Coordinates: csv holds the scene's own; the others hold distances from an origin that they name (survey.h),
//   because most programs place things by floats. Up is z in usda and ply, y in obj and gltf, as their readers take it.
// Shape: csv a row an instance; usda and gltf each model once and a place an instance; obj and ply all triangles expanded.
//   Instances come in the order of the file of details. Only objects that stand somewhere are written.
// Promise: same details, same bytes; nothing appears under its final name, textures and materials beside the file neither,
//   before all is written. No instances: a file without any, which is valid.
// Errors: base::ConfigError for an unknown format; base::Error where a format is no good for so many instances (naming one
//   that is), where a file cannot be written or is also an input; base::Cancelled.
// Threads: one. Memory: that of models and textures, whatever the number of instances (gltf: 0.6 kB an instance more).
// Cost: csv 1 and usda 2 microseconds an instance; obj 0.6 and ply 0.2 microseconds a triangle.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ghosttile/fill/file.h"
#include "silvasim/base/progress.h"

namespace ghosttile::exports {

struct WriteOptions {
  std::span<const std::filesystem::path> inputs;  // files that must not be overwritten
  std::string crs_wkt;                            // of the scene's coordinates; empty: unknown
  silvasim::base::Progress progress;
};

struct Format {
  std::string name;
  std::vector<std::string> extensions;  // with the dot, the usual one first
  std::string help;                     // one line
  void (*write)(const fill::DetailsFile&, const std::filesystem::path&, const WriteOptions&);
};

const std::vector<Format>& formats();

// `name` empty: by the path's extension.
const Format& format_for(const std::string& name, const std::filesystem::path& path);

// csv: RFC 4180 with "\n" and a header line; numbers in full, so that they read back the same. Columns: object (its name),
// x, y, z, qw, qx, qy, qz (rotation from object to scene), scale, tile_x, tile_y, tile_z, candidate.
void write_csv(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options);

// usda: OpenUSD's text form: a PointInstancer below an Xform that holds the origin in doubles. An instance's id tells its
// tile and candidate, and so stays through edits. Textures: <name>-<texture>.png beside it.
void write_usda(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options);

// gltf: 2.0, all in one file, binary unless the extension is .gltf. A node an instance; nodes share meshes.
inline constexpr std::uint64_t most_gltf_instances = 200'000;
void write_gltf(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options);

// obj: with <name>.mtl and <name>-<texture>.png beside it; an `o` an instance.
// ply: binary little endian; vertices have their texture's colours, and leaves are not cut out.
inline constexpr std::uint64_t most_triangles = 50'000'000;
void write_obj(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options);
void write_ply(const fill::DetailsFile& file, const std::filesystem::path& path, const WriteOptions& options);

}  // namespace ghosttile::exports
