// Points to text: CSV and GeoJSON.
#pragma once

#include "silvasim/fields/feature_writer.h"

namespace silvasim::fields {

// As write_points promises. Numbers are written with a point whatever the locale.
void write_csv(const std::filesystem::path& path, const PointLayer& layer,
               const std::function<std::optional<PointBlock>()>& next_block);
void write_geojson(const std::filesystem::path& path, const PointLayer& layer,
                   const std::function<std::optional<PointBlock>()>& next_block);

}  // namespace silvasim::fields
