// What GDAL says, gathered instead of printed.
#pragma once

#include <string>

namespace silvasim::fields {

// While it lives, GDAL's messages of this thread end here. May be nested: the innermost hears.
class GdalLog {
 public:
  GdalLog();
  GdalLog(const GdalLog&) = delete;
  GdalLog& operator=(const GdalLog&) = delete;
  ~GdalLog();

  bool failed() const { return !failure_.empty(); }  // since it was made or cleared
  std::string reason() const;  // the first failure, else the first warning, else something general
  void clear();

  void hear(bool failure, const char* message);  // called by GDAL

 private:
  std::string failure_, warning_;
};

}  // namespace silvasim::fields
