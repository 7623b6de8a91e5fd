// A whole detail from its model: spheres, their error, anchors.
#pragma once

#include <string>

#include "ghosttile/objects/anchors.h"
#include "ghosttile/objects/sphere_fit.h"

namespace ghosttile::objects {

// `given`: the user's own spheres; empty: fitted. Errors: base::Error naming the detail; those of both makers, and a given
// sphere that is not finite or has no radius.
Detail make_detail(const std::string& name, assets::Model model, const SphereFitOptions& fit,
                   const AnchorOptions& anchors, std::vector<Sphere> given = {});

}  // namespace ghosttile::objects
