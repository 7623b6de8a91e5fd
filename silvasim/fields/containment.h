// Walls around GDAL, PROJ and SQLite: no file that Silva reads may make it read another file by surprise, reach the
// network or work for ever. docs/fields.md, "Containment", says why each one stands.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace silvasim::fields {

// Called once, by prepare_gdal(): denies every virtual file system of GDAL but /vsimem/, every HTTP request and PROJ's
// network; bounds GDAL's cache; guards every SQLite connection that is opened read-only from now on.
void contain_gdal();

// The name under which GDAL may open a user's file: absolute, so that no prefix ("PG:", "MEM:::", "http://") can mean
// anything else; a regular file, links followed. Errors: base::Error without a place, for the caller to put one.
std::string contained_name(const std::filesystem::path& path);

// While it lives, SQLite statements of this thread stop with an error after so many steps of its virtual machine,
// because a view inside a GeoPackage can loop for ever. One step is about 10 ns.
class SqliteBudget {
 public:
  explicit SqliteBudget(std::uint64_t file_bytes);
  SqliteBudget(const SqliteBudget&) = delete;
  SqliteBudget& operator=(const SqliteBudget&) = delete;
  ~SqliteBudget();

  bool exhausted() const;
};

}  // namespace silvasim::fields
