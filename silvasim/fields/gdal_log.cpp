#include "silvasim/fields/gdal_log.h"

#include <cpl_error.h>

namespace silvasim::fields {

namespace {

void CPL_STDCALL hear_gdal(CPLErr level, CPLErrorNum, const char* message) {
  if (level < CE_Warning) return;
  static_cast<GdalLog*>(CPLGetErrorHandlerUserData())->hear(level >= CE_Failure, message);
}

// One line without control characters, and not endless: a damaged file may put anything into a message.
std::string tidied(const char* message) {
  constexpr std::size_t longest = 300;
  std::string text;
  for (const char* c = message; *c && text.size() < longest; ++c) {
    text += static_cast<unsigned char>(*c) < 0x20 || *c == 0x7f ? ' ' : *c;
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

}  // namespace

GdalLog::GdalLog() {
  CPLPushErrorHandlerEx(hear_gdal, this);
  CPLErrorReset();
}

GdalLog::~GdalLog() {
  CPLPopErrorHandler();
  CPLErrorReset();
}

std::string GdalLog::reason() const {
  return !failure_.empty() ? failure_ : !warning_.empty() ? warning_ : "the file is damaged or of another kind";
}

void GdalLog::clear() {
  failure_.clear();
  warning_.clear();
}

void GdalLog::hear(bool failure, const char* message) {
  std::string& first = failure ? failure_ : warning_;
  if (first.empty()) first = tidied(message ? message : "");
  if (failure && failure_.empty()) failure_ = "an error without words";
}

}  // namespace silvasim::fields
