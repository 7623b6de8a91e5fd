// Output appears under its final name only when it is complete; nothing else is harmed on the way.
#include "silvasim/base/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "silvasim/base/error.h"

namespace silvasim::base {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class FileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("silva-file-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static void put(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }
  static std::string text_of(const fs::path& path) { return read_file(path, 1 << 20); }
  static unsigned mode_of(const fs::path& path) { return static_cast<unsigned>(fs::status(path).permissions()); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static void write_whole(const fs::path& path, const std::string& text) {
    NewFile file(path);
    file.write(text);
    file.commit();
  }

  fs::path folder_;
};

TEST_F(FileTest, AppearsOnlyWhenCommitted) {
  const fs::path path = folder_ / "a.txt";
  {
    NewFile file(path);
    file.write("one ");
    file.write("two");
    EXPECT_FALSE(fs::exists(path));
    EXPECT_EQ(file.path().extension(), ".txt");
    EXPECT_EQ(file.path().parent_path(), folder_);
    file.commit();
  }
  EXPECT_EQ(text_of(path), "one two");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(FileTest, LeavesTheOldFileAndNoRestWithoutCommit) {
  const fs::path path = folder_ / "a.txt";
  put(path, "old");
  { NewFile(path).write("new"); }
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(FileTest, CommitsWhatALibraryPutUnderItsName) {
  const fs::path path = folder_ / "a.gpkg";
  NewFile file(path);
  fs::remove(file.path());
  put(file.path(), "by a library");
  file.commit();
  EXPECT_EQ(text_of(path), "by a library");
}

TEST_F(FileTest, NewFilesGetWhatTheUmaskLeaves) {
  const mode_t before = umask(027);
  write_whole(folder_ / "a", "x");
  umask(before);
  EXPECT_EQ(mode_of(folder_ / "a"), 0640u);
}

TEST_F(FileTest, ReplacedFilesKeepTheirPermissions) {
  const fs::path path = folder_ / "a";
  put(path, "secret");
  for (const unsigned mode : {0600u, 0664u, 0755u}) {
    fs::permissions(path, static_cast<fs::perms>(mode));
    write_whole(path, "new");
    EXPECT_EQ(mode_of(path), mode) << std::oct << mode;
  }
}

TEST_F(FileTest, FollowsLinks) {
  fs::create_directory(folder_ / "far");
  put(folder_ / "far" / "real", "old");
  fs::create_symlink("far/real", folder_ / "near");
  fs::create_symlink(folder_ / "near", folder_ / "nearer");
  write_whole(folder_ / "nearer", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "near"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "nearer"));
  EXPECT_FALSE(fs::is_symlink(folder_ / "far" / "real"));
  EXPECT_EQ(text_of(folder_ / "far" / "real"), "new");
}

TEST_F(FileTest, FollowsALinkToAFileYetToBe) {
  fs::create_directory(folder_ / "far");
  fs::create_symlink("far/real", folder_ / "near");
  write_whole(folder_ / "near", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "near"));
  EXPECT_EQ(text_of(folder_ / "far" / "real"), "new");
}

TEST_F(FileTest, RefusesLinksThatGoRound) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  EXPECT_THAT([&] { NewFile file(folder_ / "a"); }, ThrowsMessage<Error>(HasSubstr("cannot write")));
}

TEST_F(FileTest, RefusesWhatIsNoFile) {
  const auto opening = [](const fs::path& path) { return [path] { NewFile file(path); }; };
  EXPECT_THAT(opening(folder_), ThrowsMessage<Error>(AllOf(HasSubstr(folder_.string()), HasSubstr("folder"))));
  EXPECT_THAT(opening(folder_ / ""), ThrowsMessage<Error>(HasSubstr("names no file")));
  EXPECT_THAT(opening(""), ThrowsMessage<Error>(HasSubstr("names no file")));
  EXPECT_THAT(opening("/dev/full"), ThrowsMessage<Error>(HasSubstr("no regular file")));
  EXPECT_THAT(opening(folder_ / "none" / "a"), ThrowsMessage<Error>(HasSubstr("no folder")));
  put(folder_ / "file", "x");
  EXPECT_THAT(opening(folder_ / "file" / "a"), ThrowsMessage<Error>(HasSubstr("no folder")));
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(opening(folder_ / "pipe"), ThrowsMessage<Error>(HasSubstr("no regular file")));
  fs::create_directory_symlink(".", folder_ / "link");
  EXPECT_THAT(opening(folder_ / "link"), ThrowsMessage<Error>(HasSubstr("folder")));
}

TEST_F(FileTest, RefusesItsOwnInputUnderEveryName) {
  const fs::path input = folder_ / "in";
  put(input, "precious");
  fs::create_symlink("in", folder_ / "soft");
  fs::create_hard_link(input, folder_ / "hard");
  const std::vector<fs::path> inputs{folder_ / "missing", input};
  for (const fs::path& name : {input, folder_ / "soft", folder_ / "hard", folder_ / "." / "in"}) {
    EXPECT_THAT(([&] { NewFile file(name, inputs); }), ThrowsMessage<Error>(HasSubstr("also an input"))) << name;
  }
  NewFile(folder_ / "other", inputs).commit();
  EXPECT_EQ(text_of(input), "precious");
}

TEST_F(FileTest, TakesTheLongestNames) {
  const std::string name(255, 'n');
  write_whole(folder_ / name, "x");
  EXPECT_EQ(text_of(folder_ / name), "x");
}

// A run in a container often has the same process id as the killed run before it.
TEST_F(FileTest, IsNotStoppedByTheRestOfAKilledRun) {
  const fs::path path = folder_ / "a.txt";
  std::string name;
  {
    NewFile file(path);
    name = file.path().filename().string();
  }
  const std::size_t dash = name.rfind('-');
  const int serial = std::stoi(name.substr(dash + 1));
  for (int i = 1; i < 4; ++i) put(folder_ / (name.substr(0, dash + 1) + std::to_string(serial + i) + ".txt"), "rest");
  write_whole(path, "new");
  EXPECT_EQ(text_of(path), "new");
  EXPECT_EQ(entries(), 4u);
}

// Runs `work` in a child that may not write more than `most_bytes` to a file. Returns the child's exit code.
template <typename Work>
int run_with_little_space(std::size_t most_bytes, Work&& work) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{most_bytes, most_bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(FileTest, AFullDiskIsAnErrorAndLeavesNothing) {
  const fs::path path = folder_ / "a";
  put(path, "old");
  const int code = run_with_little_space(1 << 16, [&] {
    try {
      write_whole(path, std::string(1 << 20, 'x'));
    } catch (const Error& error) {
      return std::string(error.what()).find(path.string()) != std::string::npos ? 7 : 8;
    }
    return 0;
  });
  EXPECT_EQ(code, 7);
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(FileTest, KilledWhileWritingLeavesTheOldFile) {
  const fs::path path = folder_ / "a";
  put(path, "old");
  const pid_t child = fork();
  if (child == 0) {
    NewFile file(path);
    file.write("half");
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(text_of(path), "old");
}

TEST_F(FileTest, TheSignalHandlerRemovesWhatIsHalfWritten) {
  const fs::path path = folder_ / "a";
  NewFile first(path), second(folder_ / "b");
  first.write("half");
  ASSERT_EQ(entries(), 2u);
  remove_unfinished_files_from_signal_handler();
  EXPECT_EQ(entries(), 0u);
}

TEST_F(FileTest, ReadsWholeFiles) {
  const std::string text = std::string("a\0b\r\n", 5) + std::string(100000, 'z');
  put(folder_ / "a", text);
  EXPECT_EQ(read_file(folder_ / "a", text.size()), text);
  put(folder_ / "empty", "");
  EXPECT_EQ(read_file(folder_ / "empty", 0), "");
}

TEST_F(FileTest, ReadsFilesThatClaimNoSize) {
  if (!fs::exists("/proc/self/status")) GTEST_SKIP() << "this system has no /proc";
  EXPECT_THAT(read_file("/proc/self/status", 1 << 20), HasSubstr("Pid:"));
  EXPECT_THAT([] { read_file("/proc/self/status", 10); }, ThrowsMessage<Error>(HasSubstr("at most 10")));
}

TEST_F(FileTest, RefusesToReadWhatIsNoFileOrTooLarge) {
  const auto reading = [](const fs::path& path) { return [path] { read_file(path, 1000); }; };
  EXPECT_THAT(reading(folder_ / "none"), ThrowsMessage<Error>(AllOf(HasSubstr("none"), HasSubstr("No such file"))));
  EXPECT_THAT(reading(folder_), ThrowsMessage<Error>(HasSubstr("no regular file")));
  EXPECT_THAT(reading("/dev/zero"), ThrowsMessage<Error>(HasSubstr("no regular file")));
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(reading(folder_ / "pipe"), ThrowsMessage<Error>(HasSubstr("no regular file")));
  put(folder_ / "large", std::string(1001, 'x'));
  EXPECT_THAT(reading(folder_ / "large"), ThrowsMessage<Error>(AllOf(HasSubstr("1001"), HasSubstr("at most 1000"))));
  put(folder_ / "sparse", "");
  fs::resize_file(folder_ / "sparse", std::uintmax_t{1} << 42);
  EXPECT_THAT(reading(folder_ / "sparse"), ThrowsMessage<Error>(HasSubstr("at most 1000")));
}

}  // namespace
}  // namespace silvasim::base
