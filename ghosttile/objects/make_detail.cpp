#include "ghosttile/objects/make_detail.h"

#include <fmt/format.h>

#include <cmath>

#include "silvasim/base/error.h"

namespace ghosttile::objects {

Detail make_detail(const std::string& name, assets::Model model, const SphereFitOptions& fit,
                   const AnchorOptions& anchors, std::vector<Sphere> given) {
  Detail detail;
  detail.name = name;
  model.name = name;
  if (given.size() > static_cast<std::size_t>(most_spheres)) {
    throw silvasim::base::Error(
        fmt::format("detail \"{}\": has {} spheres; {} are possible", name, given.size(), most_spheres));
  }
  for (const Sphere& s : given) {
    if (!std::isfinite(s.centre.x) || !std::isfinite(s.centre.y) || !std::isfinite(s.centre.z) || !(s.radius_m > 0) ||
        !std::isfinite(s.radius_m)) {
      throw silvasim::base::Error(
          fmt::format("detail \"{}\": has a sphere that is not finite or whose radius is not above 0", name));
    }
  }
  if (given.empty()) {
    SphereFit fitted = fit_spheres(model, fit);
    detail.spheres = std::move(fitted.spheres);
    detail.error = fitted.error;
  } else {
    detail.error = error_of(model, given, fit.seed);
    detail.spheres = std::move(given);
  }
  detail.anchors = anchors_of(model, anchors);
  detail.model = std::move(model);
  return detail;
}

}  // namespace ghosttile::objects
