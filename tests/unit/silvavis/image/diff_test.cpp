// What `silvavis diff` tells.
#include "silvavis/commands/diff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvavis/image/file.h"

namespace silvavis::commands {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

class DiffTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("silva-diff-" + std::to_string(getpid()) + "-" + test->name());
    fs::create_directories(folder_);
    image::Frame frame;
    frame.colour = image::Image(20, 20, 3);
    frame.depth = image::Image(20, 20, 1);
    frame.plants.assign(400, 7);
    options_.a = folder_ / "a.exr";
    options_.b = folder_ / "b.exr";
    image::write(options_.a, frame);
    for (float& value : frame.colour.pixels) value += 0.5f;
    for (std::size_t i = 0; i < 4; ++i) frame.plants[i] = 8;
    image::write(options_.b, frame);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
  DiffOptions options_;
};

TEST_F(DiffTest, TellsEveryMetricAsJson) {
  options_.json = true;
  const auto json = nlohmann::json::parse(diff_text(options_));
  EXPECT_EQ(json.at("pixels"), 400);
  EXPECT_DOUBLE_EQ(json.at("rmse"), 0.5);
  EXPECT_EQ(json.at("share_different"), 1);
  EXPECT_EQ(json.at("depth_rmse"), 0);
  EXPECT_EQ(json.at("plant_different"), 4);
  EXPECT_DOUBLE_EQ(json.at("plant_share_different"), 0.01);
  EXPECT_FALSE(json.contains("species_different"));
  options_.b = options_.a;
  EXPECT_TRUE(nlohmann::json::parse(diff_text(options_)).at("psnr_db").is_null());
}

TEST_F(DiffTest, TellsOnlyWhatWasAskedForAndSuggests) {
  options_.metrics = {"rmse"};
  EXPECT_EQ(diff_text(options_), "rmse                    0.5\n");
  options_.metrics = {"rmes"};
  EXPECT_THAT([&] { diff_text(options_); }, ThrowsMessage<silvasim::base::Error>(HasSubstr("did you mean \"rmse\"?")));
}

TEST_F(DiffTest, FailsWhereALimitIsExceeded) {
  options_.metrics = {"rmse"};
  options_.at_most = 0.6;
  EXPECT_NO_THROW(diff(options_));
  options_.at_most = 0.4;
  EXPECT_THAT([&] { diff(options_); }, ThrowsMessage<silvasim::base::Error>(HasSubstr("rmse is 0.5, more than 0.4")));
  options_.metrics = {"ssim"};
  options_.at_most = 0.9;
  EXPECT_THAT([&] { diff(options_); }, ThrowsMessage<silvasim::base::Error>(HasSubstr("less than 0.9")));
}

}  // namespace
}  // namespace silvavis::commands
