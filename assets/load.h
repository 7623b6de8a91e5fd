// A plant model read from a file: Wavefront OBJ with its MTL, glTF 2.0 as .gltf or .glb, or PLY. By the file's extension.
//
// Units: as in the file, taken for metres; fit.h brings a model to its species' measures. z is up in the result.
// Promise: what model.h promises; triangles without an area are left out, nothing else is merged or simplified. The same
//   file gives the same model. Nothing outside the file's own folder is read, and nothing over a network.
// Fallbacks: a texture that is missing, damaged, too large, or lies outside the model's folder is a warning, and the
//   material keeps a plain colour. All of them are in docs/models.md.
// Errors: base::Error, one line with the file (and the line, in text files): damaged, empty, beyond a limit, or in need of
//   a glTF extension that is not known.
// Threads: may be called from several at once, with a report each.
// Source: OBJ by tinyobjloader, glTF by tinygltf; PLY by own code, because assimp's importer crashes on damaged files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "assets/model.h"

namespace assets {

enum class Up { automatic, y, z };  // automatic: y in OBJ and glTF, z in PLY

struct LoadOptions {
  Up up = Up::automatic;
  int most_texture_px = 1024;                     // longer sides of textures are resampled to this
  std::uint64_t most_file_bytes = 1'000'000'000;  // a file, and all that it names together
  std::size_t most_triangles = 20'000'000;        // before those without an area are dropped
};

struct LoadReport {
  std::vector<std::string> warnings;  // one line each, with the file; at most 100 of a file
};

Model load(const std::filesystem::path& file, const LoadOptions& options = {}, LoadReport* report = nullptr);

}  // namespace assets
