#include "silvasim/fields/frame.h"

#include <fmt/format.h>

#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <optional>

#include "silvasim/base/error.h"
#include "silvasim/fields/open.h"

namespace silvasim::fields {

namespace {

constexpr double longest_side_m = 5e6;

// The raster that the scene takes its frame from, where the user does not say.
struct Reference {
  const config::FieldSettings* field = nullptr;
  Georeference grid;
};

std::optional<Reference> reference_raster(const std::vector<config::FieldSettings>& fields) {
  const auto placed = [](const config::FieldSettings& field) -> std::optional<Reference> {
    const Dataset dataset = open_raster(field);
    Georeference grid = georeference_of(*dataset, field);
    if (!grid.placed) return std::nullopt;
    return Reference{&field, std::move(grid)};
  };
  for (const auto& field : fields) {
    if (field.source == config::Source::raster && field.terrain) {
      if (auto reference = placed(field)) return reference;
    }
  }
  for (const auto& field : fields) {
    if (field.source != config::Source::raster || field.terrain) continue;
    if (auto reference = placed(field)) return reference;
  }
  return std::nullopt;
}

[[noreturn]] void fail(const config::SceneSettings& scene, const std::string& message) {
  throw base::ConfigError(scene.place, "scene: " + message);
}

// The metre frame around a place on the earth.
Crs utm_around(double latitude, double longitude) {
  const int zone = GeographicLib::UTMUPS::StandardZone(latitude, longitude);
  return crs_from_text("EPSG:" + std::to_string(GeographicLib::UTMUPS::EncodeEPSG(zone, latitude >= 0)));
}

base::Point middle(const base::Box& box) { return {(box.west + box.east) / 2, (box.south + box.north) / 2}; }

Crs metre_crs(const Crs& crs, const base::Box& box) {
  const base::Point centre = middle(box);
  const auto degrees = Transformation(crs, wgs84()).apply(centre);
  if (!degrees || !(std::abs(degrees->y) <= 90)) {
    throw base::Error("its middle (" + extent_text(nullptr, box) + ") has no place on the earth in " + name_of(crs));
  }
  return utm_around(degrees->y, degrees->x);
}

void check_extent(const config::SceneSettings& scene, const base::Box& box) {
  for (const double number : {box.west, box.south, box.east, box.north}) {
    if (!std::isfinite(number)) fail(scene, "its extent is not finite");
  }
  if (box.empty()) fail(scene, "its extent is empty or reversed: " + extent_text(nullptr, box));
  if (std::max(box.width(), box.height()) > longest_side_m) {
    fail(scene, fmt::format("its extent of {:.6g} x {:.6g} km is larger than 5000 km; is it in metres?",
                            box.width() / 1000, box.height() / 1000));
  }
}

}  // namespace

Frame frame_of(const Crs& crs, const base::Box& extent) { return {wkt_of(crs), name_of(crs), extent}; }

Crs crs_of(const Frame& frame) {
  if (frame.crs_wkt.empty()) return nullptr;
  thread_local std::string last_wkt;
  thread_local Crs last;
  if (frame.crs_wkt != last_wkt) {
    last = crs_from_text(frame.crs_wkt);
    last_wkt = frame.crs_wkt;
  }
  return last;
}

Crs crs_in_scene(const config::FieldSettings& field, const Crs& own, bool known, const Crs& scene_crs) {
  if (field.crs == "local") return scene_crs;
  if (scene_crs && !known) {
    fail_at(field, "\"" + field.path.string() +
                       "\" does not say its CRS; say it with crs=\"EPSG:...\", or crs=\"local\" if its "
                       "coordinates are the scene's");
  }
  if (!scene_crs && own) {
    fail_at(field, "\"" + field.path.string() + "\" is in " + name_of(own) +
                       ", but the scene is in local metres; give the scene a crs, or this field crs=\"local\" if its "
                       "coordinates are the scene's");
  }
  return own;
}

Frame settle_frame(const config::SceneSettings& scene, const std::vector<config::FieldSettings>& fields) {
  if (scene.extent && scene.extent_geographic) fail(scene, "it has two extents, one is enough");
  if (scene.width_m.has_value() != scene.height_m.has_value()) fail(scene, "a size needs both a width and a height");
  if (scene.width_m && !(*scene.width_m > 0 && *scene.height_m > 0))
    fail(scene, "its width and height must be positive");
  if (scene.extent) check_extent(scene, *scene.extent);
  if (scene.extent_geographic && scene.extent_geographic->empty())
    fail(scene, "its extent in degrees is empty or reversed");
  const bool has_extent = scene.extent || scene.extent_geographic;

  // Only a scene that says both its CRS and its place needs no file.
  std::optional<Reference> reference;
  if (scene.crs.empty() || !(has_extent || (scene.crs == "local" && scene.width_m)))
    reference = reference_raster(fields);

  // Settle the CRS.
  Crs crs;
  if (scene.crs == "local") {
    if (scene.extent_geographic)
      fail(scene, "local metres have no place on the earth, so the extent cannot be in degrees");
  } else if (!scene.crs.empty()) {
    try {
      crs = crs_from_text(scene.crs);
    } catch (const base::Error& error) {
      fail(scene, error.what());
    }
    if (!is_in_metres(crs)) {
      fail(scene,
           "its CRS, " + name_of(crs) + ", is not in metres; leave crs out for the UTM zone, or name a CRS in metres");
    }
  } else if (reference && reference->grid.crs) {
    crs = reference->grid.crs;
    if (!is_in_metres(crs)) {
      try {
        crs = scene.extent_geographic ? metre_crs(wgs84(), *scene.extent_geographic)
                                      : metre_crs(crs, own_extent(reference->grid));
      } catch (const base::Error& error) {
        fail_at(*reference->field, error.what());
      }
    }
  } else if (scene.extent_geographic) {
    crs = metre_crs(wgs84(), *scene.extent_geographic);
  }

  // Settle the extent.
  if (scene.extent) return frame_of(crs, *scene.extent);
  if (scene.extent_geographic) {
    const base::Box box = bounds(Transformation(wgs84(), crs), *scene.extent_geographic);
    if (box.empty()) {
      fail(scene, "its extent in degrees (" + extent_text(nullptr, *scene.extent_geographic) + ") has no place in " +
                      name_of(crs));
    }
    check_extent(scene, box);
    return frame_of(crs, box);
  }
  if (!reference) {
    if (scene.width_m && !crs) {
      const base::Box box{0, 0, *scene.width_m, *scene.height_m};
      check_extent(scene, box);
      return frame_of(crs, box);
    }
    fail(scene, crs ? "no georeferenced raster says where the scene lies; give an <extent>"
                    : "no georeferenced raster says how large the scene is; give a <size> or an <extent>");
  }
  const Georeference& grid = reference->grid;
  const Crs own = crs_in_scene(*reference->field, grid.crs, grid.crs_known, crs);
  base::Box box = bounds(Transformation(own, crs), own_extent(grid));
  if (box.empty()) {
    fail_at(*reference->field, "it lies nowhere in the scene's CRS, " + name_of(crs) + ": it reaches from " +
                                   extent_text(own, own_extent(grid)));
  }
  if (scene.width_m) {
    const base::Point centre = middle(box);
    box = {centre.x - *scene.width_m / 2, centre.y - *scene.height_m / 2, centre.x + *scene.width_m / 2,
           centre.y + *scene.height_m / 2};
  }
  check_extent(scene, box);
  return frame_of(crs, box);
}

}  // namespace silvasim::fields
