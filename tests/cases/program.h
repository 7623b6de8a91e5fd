// Runs the built silvasim and keeps what it said.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace silvasim::cases {

struct Outcome {
  int code = -1;  // exit code, or 128 + signal
  std::string out, err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

Outcome silvasim(const std::vector<std::string>& arguments);
Outcome program(const std::vector<std::string>& command);

// A folder of the test's own, gone with it.
class Folder {
 public:
  Folder();
  ~Folder();
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }
  std::vector<std::string> files() const;  // sorted names, hidden ones too

 private:
  std::filesystem::path path_;
};

std::string source(const std::string& path);    // a path inside the project
std::vector<std::filesystem::path> examples();  // configs/*/ecosystem.xml
void write(const std::string& path, const std::string& text);
std::string read(const std::string& path);

}  // namespace silvasim::cases
