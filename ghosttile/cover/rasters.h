// Rasters as sources: data fields, and the measures of the ground's shape.
//
// Units: the field's own. No data: by the field's policy: "exclude" and "ignore" give NaN (a rule then answers 0 or 1), "fill" its value.
// Cost: 10 ns a point.
#pragma once

#include <memory>

#include "ghosttile/cover/source.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/fields/field_set.h"

namespace ghosttile::cover {

// Keeps the set alive.
std::shared_ptr<const Source> field_source(std::shared_ptr<const silvasim::fields::FieldSet> fields, std::size_t field);

enum class GroundMeasure {
  elevation,  // metres
  slope,      // degrees (Horn 1981)
  northness,  // cos(aspect) * sin(slope): 1 steep and facing north
  eastness,   // sin(aspect) * sin(slope)
};

// Flat land at height 0 where the ecosystem has no terrain.
std::shared_ptr<const Source> ground_source(const silvasim::ecosystem::Terrain& terrain, GroundMeasure measure);

// The same everywhere.
std::shared_ptr<const Source> constant_source(float value);

}  // namespace ghosttile::cover
