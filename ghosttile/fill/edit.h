// Edits of a file of details: what changed is filled anew, and what stood there is kept to be put back.
//
// Promise: tiles that were not touched keep their bytes; undo() gives back what was there before the last edit, byte for byte.
// Source: Guérin et al. 2016, section 6.1.
#pragma once

#include "ghosttile/fill/file.h"
#include "ghosttile/fill/fill.h"

namespace ghosttile::fill {

// `plan`: with the edit in it. `touched`: all tiles where it may differ from the plan before.
void edit(const Plan& plan, DetailsFile& file, const TileBox& touched, const std::string& strokes_xml,
          const silvasim::base::Progress& progress = {});
void undo(DetailsFile& file);  // one edit at least

}  // namespace ghosttile::fill
