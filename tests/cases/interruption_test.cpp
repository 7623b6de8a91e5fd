// Ctrl-C and kill at any moment leave no half file: what has the final name is whole.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <iostream>

#include "tests/cases/program.h"

namespace silvasim::cases {
namespace {

// Runs the demo and sends it a signal after a while; returns its wait status.
int run_and_signal(const Folder& folder, int signal, int after_ms) {
  const pid_t child = fork();
  if (child == 0) {
    const std::string binary = std::string(SILVA_BINARY_DIR) + "/silvasim",
                      scenario = source("configs/demo/ecosystem.xml");
    const std::string out = folder / "e.silva", png = folder / "e.png";
    execl(binary.c_str(), "silvasim", "run", scenario.c_str(), "-o", out.c_str(), "--png", png.c_str(), "-q", nullptr);
    _exit(127);
  }
  usleep(static_cast<useconds_t>(after_ms) * 1000);
  kill(child, signal);
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(Interruption, LeavesNoHalfFile) {
  int interrupted = 0;
  for (const int after_ms : {30, 200, 500, 1000, 2000}) {
    const Folder folder;
    const int status = run_and_signal(folder, SIGINT, after_ms);
    const auto files = folder.files();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;  // it was faster
    ++interrupted;
    const bool by_code = WIFEXITED(status) && WEXITSTATUS(status) == 130;
    const bool before_the_handler = WIFSIGNALED(status) && WTERMSIG(status) == SIGINT;
    EXPECT_TRUE(by_code || before_the_handler) << status;
    for (const std::string& file : files) {
      // Only files that are whole may be there: the ecosystem is written before the picture.
      EXPECT_NE(file[0], '.') << file;
      if (file == "e.silva") {
        EXPECT_EQ(silvasim({"info", folder / file}).code, 0);
      }
    }
  }
  std::cout << interrupted << " of 5 runs were interrupted\n";
  EXPECT_GT(interrupted, 0);
}

TEST(Interruption, KillLeavesNothingUnderAFinalName) {
  const Folder folder;
  run_and_signal(folder, SIGKILL, 300);
  for (const std::string& file : folder.files()) {
    if (file == "e.silva") {
      EXPECT_EQ(silvasim({"info", folder / file}).code, 0);
    }
  }
}

}  // namespace
}  // namespace silvasim::cases
