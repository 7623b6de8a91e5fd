#include "silvasim/fields/sqlite_guard.h"

#include <sqlite3.h>

#include <algorithm>
#include <fstream>
#include <string_view>

#include "silvasim/base/progress.h"

namespace silvasim::fields {

namespace {

constexpr int steps_a_call = 1 << 16;
thread_local std::int64_t sqlite_calls_left = -1;  // -1: no budget
thread_local bool sqlite_stopped = false;
thread_local int longest_value = 1 << 20;  // bytes
thread_local long guarded_connections = 0;
thread_local sqlite3* last_guarded = nullptr;
std::mutex sqlite_gate;

int count_sqlite_steps(void*) {
  if (base::interrupted()) return 1;
  if (sqlite_calls_left < 0) return 0;
  if (sqlite_calls_left == 0)
    sqlite_stopped = true;
  else
    --sqlite_calls_left;
  return sqlite_stopped ? 1 : 0;
}

// GDAL gives SQL functions that open files, send requests and change its settings; a view or trigger may call them.
int authorise_sqlite(void*, int action, const char*, const char* name, const char*, const char*) {
  if (action == SQLITE_ATTACH || action == SQLITE_DETACH) return SQLITE_DENY;
  if (action != SQLITE_FUNCTION || !name) return SQLITE_OK;
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  const std::string_view word = lower;
  const bool outward = word.starts_with("ogr_") || word.starts_with("gdal_") || word == "load_extension" ||
                       word == "readfile" || word == "writefile";
  // A few bytes that become many: these make room of any size in one step.
  const bool swelling = word == "zeroblob" || word == "randomblob" || word == "printf" || word == "format";
  return outward || swelling ? SQLITE_DENY : SQLITE_OK;
}

int guard_connection(sqlite3* connection, char**, const sqlite3_api_routines*) {
  sqlite3_progress_handler(connection, steps_a_call, count_sqlite_steps, nullptr);
  if (sqlite3_db_readonly(connection, "main") != 1) return SQLITE_OK;
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, longest_value);
  sqlite3_db_config(connection, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_set_authorizer(connection, authorise_sqlite, nullptr);
  ++guarded_connections;
  last_guarded = connection;
  return SQLITE_OK;
}

}  // namespace

SqliteGate::SqliteGate() : lock_(sqlite_gate), before_(guarded_connections) {
  sqlite3_auto_extension(reinterpret_cast<void (*)()>(guard_connection));
}

bool SqliteGate::guarded() const { return guarded_connections > before_; }

sqlite3* SqliteGate::connection() const { return last_guarded; }

std::string last_error(sqlite3* connection) { return sqlite3_errmsg(connection); }

std::string crs_definitions(const std::filesystem::path& path) {
  sqlite3* connection = nullptr;
  std::string all;
  if (sqlite3_open_v2(path.c_str(), &connection, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(connection, "SELECT * FROM gpkg_spatial_ref_sys", -1, &statement, nullptr) == SQLITE_OK) {
      while (sqlite3_step(statement) == SQLITE_ROW) {
        for (int column = 0; column < sqlite3_column_count(statement); ++column) {
          const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
          all += text ? text : "";
          all += '\n';
        }
      }
    }
    sqlite3_finalize(statement);
  }
  sqlite3_close(connection);
  return all;
}

bool is_sqlite(const std::filesystem::path& path) {
  constexpr std::string_view magic = "SQLite format 3";
  std::string head(magic.size(), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == magic;
}

SqliteBudget::SqliteBudget(std::uint64_t file_bytes) {
  // Reading takes about 2 to 4 steps a byte of the file; a small file gets some seconds.
  sqlite_calls_left = static_cast<std::int64_t>((20'000'000 + 50 * file_bytes) / steps_a_call);
  sqlite_stopped = false;
  // No value of a table is longer than its file; replace(), hex() and || must not make much longer ones.
  constexpr std::uint64_t least = 1 << 20, most = 256 << 20;
  longest_value = static_cast<int>(std::clamp(file_bytes, least, most));
}

SqliteBudget::~SqliteBudget() { sqlite_calls_left = -1; }

bool SqliteBudget::exhausted() const { return sqlite_stopped; }

}  // namespace silvasim::fields
