// A GDAL dataset over our own memory, for GDAL's algorithms.
#pragma once

#include <cstdint>
#include <span>

#include "silvasim/fields/open.h"

namespace silvasim::fields {

// One band of columns x rows cells, which stay the caller's and must outlive the dataset.
Dataset memory_raster(std::span<float> cells, int columns, int rows);
Dataset memory_raster(std::span<std::uint8_t> cells, int columns, int rows);

}  // namespace silvasim::fields
