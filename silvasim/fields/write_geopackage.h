// Points to a GeoPackage, through GDAL's driver.
#pragma once

#include "silvasim/fields/feature_writer.h"

namespace silvasim::fields {

// As write_points promises. One transaction; the time stamps that the format wants are fixed, so that bytes repeat.
void write_geopackage(const std::filesystem::path& path, const PointLayer& layer,
                      const std::function<std::optional<PointBlock>()>& next_block);

}  // namespace silvasim::fields
