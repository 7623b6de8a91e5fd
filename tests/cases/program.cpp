#include "tests/cases/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace silvasim::cases {

namespace fs = std::filesystem;

Outcome program(const std::vector<std::string>& command) {
  const Folder folder;
  const std::string out = folder / "out", err = folder / "err";
  const pid_t child = fork();
  if (child == 0) {
    dup2(open("/dev/null", O_RDONLY), 0);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read(out), read(err)};
}

Outcome silvasim(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{std::string(SILVA_BINARY_DIR) + "/silvasim"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return program(command);
}

Folder::Folder() {
  static int serial = 0;
  path_ = fs::temp_directory_path() / ("silva-case-" + std::to_string(getpid()) + "-" + std::to_string(serial++));
  fs::create_directories(path_);
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string source(const std::string& path) { return std::string(SILVA_SOURCE_DIR) + "/" + path; }

std::vector<fs::path> examples() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(source("configs"))) {
    if (fs::exists(entry.path() / "ecosystem.xml")) paths.push_back(entry.path() / "ecosystem.xml");
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void write(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace silvasim::cases
