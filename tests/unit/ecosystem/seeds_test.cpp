// What the fuzzer starts from and what it once found, replayed in every test run.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "fuzz/ecosystem_file.h"
#include "silvasim/base/file.h"

namespace silvasim::ecosystem {
namespace {

TEST(Seeds, OfTheFuzzerDoNoHarm) {
  std::vector<std::filesystem::path> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(SILVA_SOURCE_DIR "/tests/fuzz/seeds/ecosystem_file")) {
    seeds.push_back(entry.path());
  }
  std::sort(seeds.begin(), seeds.end());
  ASSERT_GE(seeds.size(), 3u);
  int read = 0;
  for (const auto& seed : seeds) {
    SCOPED_TRACE(seed.filename());
    const std::string text = base::read_file(seed, 1 << 24);
    read += try_file(std::as_bytes(std::span(text))) ? 1 : 0;
  }
  EXPECT_GT(read, 0) << "no seed is a healthy file";
}

}  // namespace
}  // namespace silvasim::ecosystem
