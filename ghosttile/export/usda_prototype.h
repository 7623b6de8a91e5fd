// A model as a prim of OpenUSD: its mesh, and its materials as UsdPreviewSurface, which all programs know.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "assets/model.h"
#include "ghosttile/export/side_files.h"
#include "ghosttile/export/writer.h"

namespace ghosttile::exports {

// "(1, 2.5, 3)"
inline void write_tuple(Writer& out, std::initializer_list<float> numbers) {
  char before = '(';
  for (const float number : numbers) {
    out << before;
    if (before == ',') out << ' ';
    out << number;
    before = ',';
  }
  out << ')';
}

// `prim`: its whole path, `name` the last part of it. `textures`: names of files, by the model's textures.
void write_prototype(Writer& out, const assets::Model& model, const std::string& name, const std::string& prim,
                     const std::vector<std::string>& textures);

}  // namespace ghosttile::exports
