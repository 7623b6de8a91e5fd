// Walls around SQLite, which runs whatever a GeoPackage's views say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>

struct sqlite3;

namespace silvasim::fields {

// To be held while a GeoPackage is opened or closed. Read-only connections that are opened under it have a budget (see
// below), no functions that reach outwards, and may not attach files. GDAL drops such guards for connections to come
// whenever it closes a GeoPackage, hence one at a time.
class SqliteGate {
 public:
  SqliteGate();
  bool guarded() const;         // a connection of this thread was guarded since
  sqlite3* connection() const;  // that one, while GDAL keeps it open

 private:
  std::unique_lock<std::mutex> lock_;
  long before_ = 0;
};

// What SQLite says of the last thing that was asked of it: "no such column: clas".
std::string last_error(sqlite3* connection);

// The CRSs that a GeoPackage defines, asked before GDAL sees them; "" where the file is none. To be called under a gate
// and a budget.
std::string crs_definitions(const std::filesystem::path& path);

bool is_sqlite(const std::filesystem::path& path);  // by its first bytes

// While it lives, SQLite statements of this thread stop with an error after so many steps of its virtual machine,
// because a view inside a GeoPackage can loop for ever. One step takes 10 to 200 ns. No value may be longer than the file
// (1 MiB at least, 256 MiB at most).
class SqliteBudget {
 public:
  explicit SqliteBudget(std::uint64_t file_bytes);
  SqliteBudget(const SqliteBudget&) = delete;
  SqliteBudget& operator=(const SqliteBudget&) = delete;
  ~SqliteBudget();

  bool exhausted() const;
};

}  // namespace silvasim::fields
