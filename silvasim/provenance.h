// Where an ecosystem comes from, as JSON: version, seed, configuration with its hash, fields with theirs.
//
// Holds no time of day and no path but those the user wrote, so that the same run gives the same bytes anywhere.
#pragma once

#include <string>

#include "silvasim/config/scenario.h"
#include "silvasim/fields/field_set.h"

namespace silvasim {

inline constexpr const char* version = SILVA_VERSION;

std::string provenance(const config::Scenario& scenario, const fields::FieldSet& fields);

}  // namespace silvasim
