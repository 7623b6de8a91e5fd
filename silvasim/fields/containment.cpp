#include "silvasim/fields/containment.h"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal.h>
#include <ogr_srs_api.h>
#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/progress.h"

namespace silvasim::fields {

namespace fs = std::filesystem;

namespace {

constexpr int steps_a_call = 1 << 20;
thread_local std::int64_t sqlite_calls_left = -1;  // -1: no budget
thread_local bool sqlite_stopped = false;

// Answers every question about files with "there is none".
class DenyingFileSystem : public VSIFilesystemHandler {
 public:
  VSIVirtualHandle* Open(const char* name, const char*, bool, CSLConstList) override {
    CPLError(CE_Failure, CPLE_OpenFailed, "%s is not read: files of this kind could reach archives or the network",
             name);
    errno = EACCES;
    return nullptr;
  }
  int Stat(const char*, VSIStatBufL*, int) override {
    errno = ENOENT;
    return -1;
  }
};

void deny_virtual_file_systems() {
  // The replaced handlers are kept in sight, since GDAL's manager forgets them without destroying them.
  static std::set<VSIFilesystemHandler*> replaced;
  static auto* const denying = new DenyingFileSystem;  // the manager destroys it
  char** const prefixes = VSIGetFileSystemsPrefixes();
  for (char** prefix = prefixes; prefix && *prefix; ++prefix) {
    if (std::strcmp(*prefix, "/vsimem/") == 0 || **prefix == '\0') continue;
    replaced.insert(VSIFileManager::GetHandler(*prefix));
    VSIFileManager::InstallHandler(*prefix, denying);
  }
  CSLDestroy(prefixes);
  // Prefixes that newer versions bring, in both spellings.
  for (const char* const prefix : {"/vsicurl",
                                   "/vsicurl_streaming",
                                   "/vsis3",
                                   "/vsis3_streaming",
                                   "/vsigs",
                                   "/vsigs_streaming",
                                   "/vsiaz",
                                   "/vsiaz_streaming",
                                   "/vsiadls",
                                   "/vsioss",
                                   "/vsioss_streaming",
                                   "/vsiswift",
                                   "/vsiswift_streaming",
                                   "/vsihdfs",
                                   "/vsiwebhdfs",
                                   "/vsizip",
                                   "/vsigzip",
                                   "/vsitar",
                                   "/vsi7z",
                                   "/vsirar",
                                   "/vsistdin",
                                   "/vsistdout",
                                   "/vsisubfile",
                                   "/vsisparse",
                                   "/vsicrypt",
                                   "/vsicached",
                                   "/vsipmtiles"}) {
    VSIFileManager::InstallHandler(std::string(prefix) + "/", denying);
    VSIFileManager::InstallHandler(std::string(prefix) + "?", denying);
  }
}

// The network layer of GDAL: fails at once. (A null result would mean "use the ordinary one".)
CPLHTTPResult* refuse_http(const char*, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*, void*) {
  auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("Silva does not use the network");
  return result;
}

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
                       word == "readfile" || word == "writefile" || word == "zeroblob" || word == "randomblob";
  return outward ? SQLITE_DENY : SQLITE_OK;
}

int guard_connection(sqlite3* connection, char**, const sqlite3_api_routines*) {
  sqlite3_progress_handler(connection, steps_a_call, count_sqlite_steps, nullptr);
  if (sqlite3_db_readonly(connection, "main") != 1) return SQLITE_OK;
  constexpr int longest_value = 256 << 20;
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, longest_value);
  sqlite3_db_config(connection, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_set_authorizer(connection, authorise_sqlite, nullptr);
  return SQLITE_OK;
}

}  // namespace

void contain_gdal() {
  deny_virtual_file_systems();
  CPLHTTPPushFetchCallback(refuse_http, nullptr);
  setenv("PROJ_NETWORK", "OFF", 1);  // for PROJ contexts that GDAL does not make
  OSRSetPROJEnableNetwork(0);

  constexpr GIntBig cache_bytes = GIntBig{256} << 20;
  GDALSetCacheMax64(cache_bytes);
  CPLSetConfigOption("GDAL_PAM_ENABLE_MARK_DIRTY", "NO");  // reading leaves no file behind
  CPLSetConfigOption("OGR_SQLITE_LOAD_EXTENSIONS", nullptr);

  sqlite3_auto_extension(reinterpret_cast<void (*)()>(guard_connection));
}

std::string contained_name(const fs::path& path) {
  const std::string& text = path.native();
  if (text.empty()) throw base::Error("no file is named");
  if (text.find('\0') != std::string::npos) throw base::Error("the file's name holds a NUL character");
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (status.type() == fs::file_type::not_found) throw base::Error("there is no file \"" + text + "\"");
  if (failure) throw base::Error("cannot read \"" + text + "\": " + failure.message());
  if (status.type() == fs::file_type::directory) throw base::Error("\"" + text + "\" is a folder, not a file");
  if (status.type() != fs::file_type::regular) throw base::Error("\"" + text + "\" is no regular file");
  const fs::path absolute = fs::absolute(path, failure);
  if (failure) throw base::Error("cannot read \"" + text + "\": " + failure.message());
  if (absolute.native().starts_with("/vsi"))
    throw base::Error("cannot read \"" + text + "\": names that begin with /vsi are GDAL's");
  return absolute.native();
}

SqliteBudget::SqliteBudget(std::uint64_t file_bytes) {
  // Reading takes about 2 to 4 steps a byte of the file; a small file gets half a second.
  sqlite_calls_left = static_cast<std::int64_t>((100'000'000 + 100 * file_bytes) / steps_a_call);
  sqlite_stopped = false;
}

SqliteBudget::~SqliteBudget() { sqlite_calls_left = -1; }

bool SqliteBudget::exhausted() const { return sqlite_stopped; }

}  // namespace silvasim::fields
