#include "silvasim/fields/memory_raster.h"

#include <cpl_conv.h>
#include <gdal_priv.h>

#include <array>
#include <string>

#include "silvasim/base/error.h"
#include "silvasim/fields/gdal_log.h"

namespace silvasim::fields {

namespace {

Dataset over(void* cells, GDALDataType type, int columns, int rows) {
  GdalLog log;
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("MEM");
  Dataset dataset(driver ? driver->Create("", columns, rows, 0, type, nullptr) : nullptr);
  std::array<char, 64> address{};
  CPLPrintPointer(address.data(), cells, static_cast<int>(address.size()) - 1);
  const std::string option = std::string("DATAPOINTER=") + address.data();
  const std::array<const char*, 2> options = {option.c_str(), nullptr};
  if (!dataset || dataset->AddBand(type, const_cast<char**>(options.data())) != CE_None) {
    throw base::Error("GDAL cannot make a raster in memory: " + log.reason());
  }
  return dataset;
}

}  // namespace

Dataset memory_raster(std::span<float> cells, int columns, int rows) {
  return over(cells.data(), GDT_Float32, columns, rows);
}

Dataset memory_raster(std::span<std::uint8_t> cells, int columns, int rows) {
  return over(cells.data(), GDT_Byte, columns, rows);
}

}  // namespace silvasim::fields
