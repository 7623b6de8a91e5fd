#include "silvasim/fields/containment.h"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <set>
#include <system_error>
#include <vector>

#include "silvasim/base/error.h"

namespace silvasim::fields {

namespace fs = std::filesystem;

namespace {

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
  // GDAL's manager forgets the replaced handlers without destroying them; kept in sight, they are no leak.
  static auto* const replaced = new std::set<VSIFilesystemHandler*>;
  static auto* const denying = new DenyingFileSystem;  // the manager destroys it
  char** const prefixes = VSIGetFileSystemsPrefixes();
  for (char** prefix = prefixes; prefix && *prefix; ++prefix) {
    if (std::strcmp(*prefix, "/vsimem/") == 0 || **prefix == '\0') continue;
    replaced->insert(VSIFileManager::GetHandler(*prefix));
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
}

namespace {

// The ASCII character that JSON's \u0050 or XML's &#80; and &#x50; stand for at the start of the text, and how long that
// is; {0, 0} where there is none.
std::pair<char, std::size_t> escaped(std::string_view text) {
  const auto number = [&](std::size_t from, std::size_t digits, int base, std::size_t length) {
    unsigned value = 0;
    const char* const end = text.data() + from + digits;
    const auto result = std::from_chars(text.data() + from, end, value, base);
    const bool whole = digits > 0 && result.ec == std::errc() && result.ptr == end && value > 0 && value < 128;
    return whole ? std::pair{static_cast<char>(value), length} : std::pair{'\0', std::size_t{0}};
  };
  if (text.starts_with("\\u") && text.size() >= 6) return number(2, 4, 16, 6);
  if (text.starts_with("\\n") || text.starts_with("\\t") || text.starts_with("\\r")) return {' ', 2};
  if (!text.starts_with("&#")) return {'\0', 0};
  const std::size_t end = text.substr(0, 16).find(';');
  if (end == std::string_view::npos) return {'\0', 0};
  const bool hex = text[2] == 'x' || text[2] == 'X';
  return hex ? number(3, end - 3, 16, end + 1) : number(2, end - 2, 10, end + 1);
}

// In lower case, with what JSON and XML write by escapes written out.
std::string plain_lower(std::string_view text) {
  std::string plain(text.size(), '\0');
  std::size_t size = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '\\' || c == '&') {
      const auto [meant, length] = escaped(text.substr(i));
      if (length > 0) {
        c = meant;
        i += length - 1;
      }
    }
    plain[size++] = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  }
  plain.resize(size);
  return plain;
}

}  // namespace

bool holds_parameter_file(std::string_view text) {
  static const std::string word = "parameterfile";
  static const std::boyer_moore_horspool_searcher searcher(word.begin(), word.end());
  const std::string lower = plain_lower(text);
  for (auto at = lower.begin(); (at = std::search(at, lower.end(), searcher)) != lower.end();) {
    at += static_cast<std::ptrdiff_t>(word.size());
    const auto next = std::find_if(at, lower.end(), [](char c) { return !std::strchr(" \t\n\v\f\r", c) || c == '\0'; });
    if (next != lower.end() && (*next == '[' || *next == '(')) return true;
  }
  return false;
}

void refuse_parameter_files(const fs::path& path) {
  std::vector<fs::path> files{path, fs::path(path) += ".aux.xml"};
  for (const char* const extension : {".prj", ".PRJ", ".qpj", ".aux.xml"}) {
    files.push_back(fs::path(path).replace_extension(extension));
  }
  for (const fs::path& file : files) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) continue;
    std::ifstream in(file, std::ios::binary);
    // Pieces overlap by more than the word and some blanks, so that it cannot hide between two.
    constexpr std::size_t piece = 1 << 20, overlap = 256;
    std::string text;
    while (in) {
      const std::size_t kept = std::min(overlap, text.size());
      text.erase(0, text.size() - kept);
      text.resize(kept + piece);
      in.read(text.data() + kept, piece);
      text.resize(kept + static_cast<std::size_t>(in.gcount()));
      if (holds_parameter_file(text)) {
        throw base::Error("\"" + file.string() + "\" holds a CRS that names a file (PARAMETERFILE); a CRS may not");
      }
    }
  }
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
  refuse_parameter_files(absolute);
  return absolute.native();
}

}  // namespace silvasim::fields
