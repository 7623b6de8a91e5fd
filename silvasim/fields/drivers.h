// The formats that Silva reads and writes. GDAL knows many more; hostile input can reach none that is not registered.
#pragma once

#include <string>

namespace silvasim::fields {

// Makes GDAL ready, once a process: registers the drivers below and no other, and contains them (containment.h). Every
// function of the room that uses GDAL calls it first.
//
// Rasters: GeoTIFF, PNG, JPEG, BMP, Arc/Info ASCII grid, ERDAS Imagine, EHdr (.bil, .flt), SRTM .hgt, DTED.
// Vectors: ESRI Shapefile, GeoJSON (and line by line), GeoPackage, FlatGeobuf, CSV.
// Not, and why: VRT, WMS and the like name other files and addresses; GML and KML fetch schemas and links; databases.
// Threads: any.
void prepare_gdal();

const char* const* raster_driver_names();  // as GDALOpenEx takes them, ends with null
const char* const* vector_driver_names();

// What to tell somebody whose file no driver opens: "Silva reads GeoTIFF, ...".
std::string readable_rasters();
std::string readable_vectors();

}  // namespace silvasim::fields
