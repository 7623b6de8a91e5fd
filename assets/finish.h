// The last steps that all formats share: from a draft to a model that keeps the promises of model.h.
#pragma once

#include "assets/draft.h"

namespace assets {

// Reads the textures, decides what leaves let through, folds the colours of vertices into materials, drops triangles without
// an area or that nothing shows, makes the normals that are missing, and drops vertices that no triangle uses.
// Errors: base::Error through `reading`: an index out of range, a number that is not finite or beyond 10^7 m, nothing left.
Model finished(Draft draft, Reading& reading);

}  // namespace assets
