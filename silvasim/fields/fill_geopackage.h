// The rows of a GeoPackage's point layer and its spatial index, ten times as fast as through GDAL.
#pragma once

#include "silvasim/fields/feature_writer.h"

namespace silvasim::fields {

// Fills the empty layer that GDAL made at `path`: rows, R-tree, extent and count. Feature ids are 1, 2, 3, ...
// Errors: base::Error naming the file.
void fill_geopackage(const std::filesystem::path& path, const PointLayer& layer,
                     const std::function<std::optional<PointBlock>()>& next_block);

}  // namespace silvasim::fields
