#include "silvasim/fields/drivers.h"

#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <mutex>

#include "silvasim/fields/containment.h"

namespace silvasim::fields {

namespace {

void register_drivers() {
  GDALRegister_GTiff();
  GDALRegister_PNG();
  GDALRegister_JPEG();
  GDALRegister_BMP();
  GDALRegister_AAIGrid();
  GDALRegister_HFA();
  GDALRegister_EHdr();
  GDALRegister_SRTMHGT();
  GDALRegister_DTED();
  RegisterOGRShape();
  RegisterOGRGeoJSON();
  RegisterOGRGeoJSONSeq();
  RegisterOGRGeoPackage();
  RegisterOGRFlatGeobuf();
  RegisterOGRCSV();

  // Rasters in memory are made, never opened: a name like MEM:::DATAPOINTER=... would read any address.
  GDALRegister_MEM();
  if (GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM")) {
    memory->pfnOpen = nullptr;
    memory->pfnIdentify = nullptr;
  }
}

}  // namespace

void prepare_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    contain_gdal();
    register_drivers();
  });
}

const char* const* raster_driver_names() {
  static const char* const names[] = {"GTiff", "PNG",  "JPEG",    "BMP",  "AAIGrid",
                                      "HFA",   "EHdr", "SRTMHGT", "DTED", nullptr};
  return names;
}

const char* const* vector_driver_names() {
  static const char* const names[] = {"ESRI Shapefile", "GeoJSON", "GeoJSONSeq", "GPKG", "FlatGeobuf", "CSV", nullptr};
  return names;
}

std::string readable_rasters() {
  return "Silva reads GeoTIFF, PNG, JPEG, BMP, ASCII grid, ERDAS Imagine, EHdr, SRTM and DTED; convert others, also "
         "VRT, "
         "with gdal_translate";
}

std::string readable_vectors() {
  return "Silva reads Shapefile, GeoJSON, GeoPackage, FlatGeobuf and CSV; convert others with ogr2ogr";
}

}  // namespace silvasim::fields
