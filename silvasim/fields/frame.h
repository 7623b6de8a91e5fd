// Which frame the scene stands on, from what the user says and from what the files say.
#pragma once

#include <vector>

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/crs.h"
#include "silvasim/fields/field_set.h"

namespace silvasim::fields {

// The rules, in this order:
//   CRS: the scene's; else the terrain's (without a terrain: the first georeferenced raster's); if that is in degrees
//     or feet, or if only an extent in degrees is given, the UTM zone (near the poles UPS) of the scene's middle; else
//     local metres.
//   Extent: the scene's; else the box around its extent in degrees; else width x height about that raster's middle, or
//     from (0, 0); else that raster's box.
//
// Errors: base::ConfigError at the scene's place, or at the field's if a file is to blame.
Frame settle_frame(const config::SceneSettings& scene, const std::vector<config::FieldSettings>& fields);

Frame frame_of(const Crs& crs, const base::Box& extent);
Crs crs_of(const Frame& frame);  // empty for local metres; the last one of a thread is remembered

// The CRS in which a layer is to be read in this scene: its own, or the scene's where the user says "local".
// Errors: base::ConfigError at the field's place if the layer has no CRS and the scene has one, or the other way round.
Crs crs_in_scene(const config::FieldSettings& field, const Crs& own, bool known, const Crs& scene_crs);

}  // namespace silvasim::fields
