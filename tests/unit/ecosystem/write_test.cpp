// Where an ecosystem file may be written, and what remains when that ends badly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "random_ecosystem.h"
#include "silvasim/base/error.h"
#include "silvasim/ecosystem/file.h"

namespace silvasim::ecosystem {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class WriteTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("silva-write-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
  Ecosystem ecosystem_ = small_ecosystem();
};

TEST_F(WriteTest, PlacesThatCannotBeWrittenAreNamed) {
  const auto writing = [&](const fs::path& path) { return [this, path] { write(ecosystem_, path); }; };
  EXPECT_THAT(writing(folder_), ThrowsMessage<base::Error>(AllOf(HasSubstr(folder_.string()), HasSubstr("folder"))));
  EXPECT_THAT(writing("/dev/full"), ThrowsMessage<base::Error>(HasSubstr("/dev/full")));
  EXPECT_THAT(writing(folder_ / "none" / "a.silva"), ThrowsMessage<base::Error>(HasSubstr("no folder")));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(WriteTest, ALinkStaysALink) {
  std::ofstream(folder_ / "real.silva") << "old";
  fs::create_symlink("real.silva", folder_ / "link.silva");
  write(ecosystem_, folder_ / "link.silva");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.silva"));
  EXPECT_TRUE(read(folder_ / "real.silva") == ecosystem_);
}

TEST_F(WriteTest, ItsOwnInputIsNotOverwritten) {
  const fs::path path = folder_ / "ecosystem.xml";
  std::ofstream(path) << "<ecosystem/>";
  const std::vector<fs::path> inputs{path};
  EXPECT_THAT([&] { write(ecosystem_, path, inputs); }, ThrowsMessage<base::Error>(HasSubstr("also an input")));
  EXPECT_EQ(fs::file_size(path), 12u);
}

TEST_F(WriteTest, AnInvalidEcosystemLeavesTheOldFile) {
  const fs::path path = folder_ / "a.silva";
  write(ecosystem_, path);
  Ecosystem broken = ecosystem_;
  broken.layers[0].plants.pop_back();
  EXPECT_THROW(write(broken, path), base::Error);
  EXPECT_TRUE(read(path) == ecosystem_);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(WriteTest, WhatIsNoFileIsNotRead) {
  EXPECT_THAT([&] { read(folder_); }, ThrowsMessage<base::Error>(HasSubstr("no regular file")));
  EXPECT_THAT([&] { read(folder_ / "none"); }, ThrowsMessage<base::Error>(HasSubstr("No such file")));
  EXPECT_THAT([&] { read("/dev/zero"); }, ThrowsMessage<base::Error>(HasSubstr("no regular file")));
  std::ofstream(folder_ / "empty");
  EXPECT_THAT([&] { read(folder_ / "empty"); }, ThrowsMessage<base::Error>(HasSubstr("no file of Silva")));
  // A terabyte that takes no room on the disk.
  std::ofstream(folder_ / "sparse");
  fs::resize_file(folder_ / "sparse", std::uintmax_t{1} << 40);
  EXPECT_THAT([&] { read(folder_ / "sparse"); }, ThrowsMessage<base::Error>(HasSubstr("no file of Silva")));
}

// A sparse terabyte with a healthy header: only its two ends are looked at.
TEST_F(WriteTest, AHugeFileWithAHealthyHeaderIsRefusedCheaply) {
  const fs::path path = folder_ / "sparse.silva";
  write(ecosystem_, path);
  fs::resize_file(path, std::uintmax_t{1} << 40);
  EXPECT_THAT([&] { read(path); }, ThrowsMessage<base::Error>(HasSubstr("SILVAEND")));
}

// Kills a writer again and again, each time a little later. The final name holds the old file or the new one.
Ecosystem large_ecosystem() {
  Random random(9);
  Ecosystem large = small_ecosystem();
  large.terrain = random_terrain(random, 500, 500);
  return large;
}

constexpr int refused_and_named = 7, refused_otherwise = 8;

// Writes the large ecosystem in a process of its own, which no thread of this one is missing in: this program again, with
// nothing to run but the test below.
pid_t start_writer(const fs::path& path, rlim_t most_bytes) {
  const pid_t child = fork();
  if (child != 0) return child;
  signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{most_bytes, most_bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
  setenv("SILVA_WRITE_TO", path.c_str(), 1);
  execl("/proc/self/exe", "writer", "--gtest_filter=Writer.DISABLED_Writes", "--gtest_also_run_disabled_tests",
        "--gtest_brief=1", nullptr);
  _exit(127);
}

TEST(Writer, DISABLED_Writes) {
  const char* const path = std::getenv("SILVA_WRITE_TO");
  ASSERT_NE(path, nullptr) << "run by the tests below only";
  try {
    write(large_ecosystem(), path);
  } catch (const base::Error& error) {
    _exit(std::string(error.what()).find(path) != std::string::npos ? refused_and_named : refused_otherwise);
  }
  _exit(0);
}

TEST_F(WriteTest, KilledWhileWritingLeavesAWholeFileOrNone) {
  const Ecosystem large = large_ecosystem();
  int killed = 0, finished = 0, absent = 0;
  for (int round = 0; round < 30; ++round) {
    const fs::path path = folder_ / "a.silva";
    const bool had_old = round % 2 == 0;
    fs::remove(path);
    if (had_old) write(ecosystem_, path);
    const pid_t child = start_writer(path, RLIM_INFINITY);
    std::this_thread::sleep_for(std::chrono::milliseconds(2 * round));
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    (WIFSIGNALED(status) ? killed : finished) += 1;
    if (!fs::exists(path)) {
      ASSERT_FALSE(had_old);
      ++absent;
      continue;
    }
    const Ecosystem found = read(path);
    ASSERT_TRUE(found == large || (had_old && found == ecosystem_)) << "round " << round;
  }
  EXPECT_GT(killed, 0);
  EXPECT_GT(absent, 0);
}

// A disk that is full after 16 KiB.
TEST_F(WriteTest, AFullDiskIsAnErrorAndLeavesNothing) {
  const pid_t child = start_writer(folder_ / "a.silva", 1 << 14);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), refused_and_named);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace silvasim::ecosystem
