// A SQLite file of our own that is being filled, without GDAL's overhead a row.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace silvasim::fields {

// Open for writing, without journal and triggers: for a file that nobody else sees yet and that is thrown away if
// something fails. One transaction, from opening to close().
// Errors: base::Error naming the file.
class SqliteFile {
 public:
  explicit SqliteFile(const std::filesystem::path& path);
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;
  ~SqliteFile();

  void run(const std::string& sql);
  std::int64_t number(const std::string& sql);  // of the first column of the first row
  void close();                                 // commits

  sqlite3* handle() const { return connection_; }
  [[noreturn]] void fail() const;

 private:
  std::filesystem::path path_;
  sqlite3* connection_ = nullptr;
};

// A prepared statement that is run once a row. Places count from 1.
class SqliteRow {
 public:
  SqliteRow(SqliteFile& file, const std::string& sql);
  SqliteRow(const SqliteRow&) = delete;
  SqliteRow& operator=(const SqliteRow&) = delete;
  ~SqliteRow();

  void set(int place, std::int64_t value);
  void set(int place, double value);
  void set(int place, std::string_view text);  // stays the caller's until step()
  void set_bytes(int place, const void* data, std::size_t size);
  void set_null(int place);
  void step();

 private:
  SqliteFile& file_;
  sqlite3_stmt* statement_ = nullptr;
};

std::string sql_quoted(const std::string& name);  // "a ""b"""

}  // namespace silvasim::fields
