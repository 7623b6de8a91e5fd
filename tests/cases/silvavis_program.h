// Runs the built silvavis.
#pragma once

#include "tests/cases/program.h"

namespace silvasim::cases {

inline Outcome silvavis(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{std::string(SILVA_BINARY_DIR) + "/silvavis"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return program(command);
}

// With options that make small pictures of coarse plants, quietly.
inline Outcome quick(std::vector<std::string> arguments) {
  for (const char* option : {"--size", "64x36", "--triangles", "12000", "--variants", "1", "-q"})
    arguments.emplace_back(option);
  return silvavis(arguments);
}

// An example, grown once a program.
inline std::string grown(const std::string& example) {
  static Folder folder;
  const std::string file = folder / (example + ".silva");
  if (!std::filesystem::exists(file))
    silvasim({"run", source("configs/" + example + "/ecosystem.xml"), "-o", file, "-q"});
  return file;
}

}  // namespace silvasim::cases
