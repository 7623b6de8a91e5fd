// Colours of vertices, which a Model does not have, as materials of several shades.
#pragma once

#include <vector>

#include "assets/draft.h"

namespace assets {

// Each triangle's colour is the mean of its corners'. Triangles of one material with alike colours share a material whose
// reflectance and transmittance are the old one's times their mean colour; as many shades as fit, at most 64 a material,
// so that bark stays brown and leaves stay green in a model that tells them by vertex colours alone.
// A textured material whose vertex colours are all grey keeps its look: they are baked occlusion or weights for wind, and
// a ray tracer finds the occlusion itself.
// `materials`: of the draft's triangles; those that are split are replaced in place by their first shade.
void fold_colours(Draft& draft, std::vector<Material>& materials);

}  // namespace assets
