// Writes small XML files into a folder of the test's own and loads them.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "silvasim/config/load.h"
#include "silvasim/evaluators/evaluator.h"
#include "silvasim/evaluators/network.h"

namespace silvasim::config {

class Files {
 public:
  Files() {
    static int serial = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("silva-config-" + std::to_string(getpid()) + "-" + std::to_string(serial++));
    std::filesystem::create_directories(folder_);
    add("water.png", "");  // only its being there is checked before the fields are loaded
  }
  ~Files() { std::filesystem::remove_all(folder_); }

  Files& add(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return *this;
  }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  Scenario load() const { return load_scenario(folder_ / "ecosystem.xml", std::nullopt, evaluators::dialect()); }

  // Every finding, one a line, without the folder: "ecosystem.xml:3:5: error: ...".
  std::string errors() const {
    std::string text;
    try {
      const Scenario scenario = load();
      for (const auto& d : evaluators::check(scenario)) text += to_string(d) + "\n";
    } catch (const base::ConfigError& error) {
      text = std::string(error.what()) + "\n";
    }
    const std::string prefix = folder_.string() + "/";
    for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
    return text;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace silvasim::config
