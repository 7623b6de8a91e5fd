// Walls around GDAL and PROJ: no file that Silva reads may make it read another file by surprise, reach the
// network or work for ever. docs/fields.md, "Containment", says why each one stands.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace silvasim::fields {

// Called once, by prepare_gdal(): denies every virtual file system of GDAL but /vsimem/, every HTTP request and PROJ's
// network; bounds GDAL's cache.
void contain_gdal();

// The name under which GDAL may open a user's file: absolute, so that no prefix ("PG:", "MEM:::", "http://") can mean
// anything else; a regular file, links followed, that holds no parameter file (below). Errors: base::Error without a place,
// for the caller to put one. Cost: reads the file once.
std::string contained_name(const std::filesystem::path& path);

// GDAL opens what a PARAMETERFILE["...", "/a/file"] names while it imports the CRS that holds it, so such a CRS must not
// come to GDAL: in the file itself as plain text, or in what GDAL reads beside it (.prj, .qpj, .aux.xml).
// Errors: base::Error that names the file.
void refuse_parameter_files(const std::filesystem::path& path);

// The same for one text.
bool holds_parameter_file(std::string_view text);

}  // namespace silvasim::fields
