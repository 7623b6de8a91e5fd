// The same seed gives the same bytes: with any number of threads, from any folder, run after run.
#include <gtest/gtest.h>

#include "silvasim/base/hash.h"
#include "tests/cases/program.h"

namespace silvasim::cases {
namespace {

TEST(Repeatability, SameBytesWithOneTwoThreeAndEightThreads) {
  for (const char* example :
       {"configs/06-layers/ecosystem.xml", "configs/04-groups/ecosystem.xml", "configs/demo/ecosystem.xml"}) {
    const Folder folder;
    std::string first;
    for (const char* threads : {"1", "2", "3", "8"}) {
      const std::string file = folder / (std::string(threads) + ".silva");
      const Outcome outcome =
          silvasim({"run", source(example), "-o", file, "--probabilities", "--threads", threads, "-q"});
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const std::string hash = base::sha256_of_file(file);
      if (first.empty()) first = hash;
      EXPECT_EQ(hash, first) << example << " with " << threads << " threads";
    }
  }
}

TEST(Repeatability, SameBytesFromAnotherFolder) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "copy");
  for (const char* part : {"configs", "data"}) {
    std::filesystem::copy(source(part), folder.path() / "copy" / part, std::filesystem::copy_options::recursive);
  }
  const std::string example = "configs/03-soils-and-classes/ecosystem.xml";
  ASSERT_EQ(silvasim({"run", source(example), "-o", folder / "a.silva", "-q"}).code, 0);
  ASSERT_EQ(silvasim({"run", folder / ("copy/" + example), "-o", folder / "b.silva", "-q"}).code, 0);
  EXPECT_EQ(base::sha256_of_file(folder / "a.silva"), base::sha256_of_file(folder / "b.silva"));
}

}  // namespace
}  // namespace silvasim::cases
