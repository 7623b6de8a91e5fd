#include "silvasim/fields/sqlite_file.h"

#include <sqlite3.h>

#include "silvasim/base/error.h"

namespace silvasim::fields {

SqliteFile::SqliteFile(const std::filesystem::path& path) : path_(path) {
  if (sqlite3_open_v2(path.c_str(), &connection_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr) != SQLITE_OK) {
    const std::string reason = connection_ ? sqlite3_errmsg(connection_) : "no memory";
    sqlite3_close_v2(connection_);
    throw base::Error("cannot write \"" + path.string() + "\": " + reason);
  }
  try {
    sqlite3_db_config(connection_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    run("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA locking_mode = EXCLUSIVE; PRAGMA cache_size = "
        "-65536");
    run("BEGIN");
  } catch (...) {
    sqlite3_close_v2(connection_);
    throw;
  }
}

SqliteFile::~SqliteFile() { sqlite3_close_v2(connection_); }

void SqliteFile::fail() const {
  throw base::Error("cannot write \"" + path_.string() + "\": " + sqlite3_errmsg(connection_));
}

void SqliteFile::run(const std::string& sql) {
  if (sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

std::int64_t SqliteFile::number(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  const bool good = sqlite3_prepare_v2(connection_, sql.c_str(), -1, &statement, nullptr) == SQLITE_OK &&
                    sqlite3_step(statement) == SQLITE_ROW;
  const std::int64_t value = good ? sqlite3_column_int64(statement, 0) : 0;
  if (!good) {
    sqlite3_finalize(statement);
    fail();
  }
  sqlite3_finalize(statement);
  return value;
}

void SqliteFile::close() {
  run("COMMIT");
  sqlite3* const connection = connection_;
  connection_ = nullptr;
  if (sqlite3_close(connection) != SQLITE_OK) {
    sqlite3_close_v2(connection);
    throw base::Error("cannot write \"" + path_.string() + "\": it cannot be closed");
  }
}

SqliteRow::SqliteRow(SqliteFile& file, const std::string& sql) : file_(file) {
  if (sqlite3_prepare_v2(file.handle(), sql.c_str(), -1, &statement_, nullptr) != SQLITE_OK) file_.fail();
}

SqliteRow::~SqliteRow() { sqlite3_finalize(statement_); }

void SqliteRow::set(int place, std::int64_t value) { sqlite3_bind_int64(statement_, place, value); }

void SqliteRow::set(int place, double value) { sqlite3_bind_double(statement_, place, value); }

void SqliteRow::set(int place, std::string_view text) {
  sqlite3_bind_text(statement_, place, text.data(), static_cast<int>(text.size()), SQLITE_STATIC);
}

void SqliteRow::set_bytes(int place, const void* data, std::size_t size) {
  sqlite3_bind_blob64(statement_, place, data, size, SQLITE_STATIC);
}

void SqliteRow::set_null(int place) { sqlite3_bind_null(statement_, place); }

void SqliteRow::step() {
  if (sqlite3_step(statement_) != SQLITE_DONE) file_.fail();
  sqlite3_reset(statement_);
}

std::string sql_quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace silvasim::fields
