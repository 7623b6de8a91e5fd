// Pictures written and read again, and files that are out to harm.
#include "silvavis/image/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvasim/base/random.h"
#include "silvavis/image/compare.h"
#include "silvavis/image/tone.h"

// OpenImageIO 2.4 loses 31 bytes where a PNG ends too early: libpng jumps over the string that it made.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:ImageInput::geterror\n"; }

namespace silvavis::image {
namespace {

namespace fs = std::filesystem;
using silvasim::base::Error;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

Frame made(int width, int height, bool everything) {
  Frame frame;
  frame.colour = Image(width, height, 3);
  silvasim::base::Stream stream(11, silvasim::base::Purpose::selection);
  // Neighbours alike, so that JPEG has something to do.
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float* p = frame.colour.at(x, y);
      p[0] = 0.5f + 0.4f * std::sin(0.1f * static_cast<float>(x));
      p[1] = 0.3f + 0.25f * std::cos(0.07f * static_cast<float>(y));
      p[2] = 0.2f + 0.01f * stream.next_float();
    }
  }
  if (!everything) return frame;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  frame.depth = Image(width, height, 1);
  frame.normal = Image(width, height, 3);
  for (std::size_t i = 0; i < pixels; ++i) {
    frame.depth.pixels[i] = i % 5 == 0 ? std::numeric_limits<float>::infinity() : 12345.678f + static_cast<float>(i);
    frame.normal.pixels[3 * i + i % 3] = 1;
    frame.species.push_back(static_cast<std::uint16_t>(i % 5 == 0 ? species_sky : i % 1000));
    frame.plants.push_back(i % 5 == 0 ? no_plant : 0x01000001u + static_cast<std::uint32_t>(i));  // no float holds them
  }
  return frame;
}

class ImageFileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("silva-image-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string bytes_of(const fs::path& path) { return silvasim::base::read_file(path, 1 << 28); }
  static void put(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(ImageFileTest, AnExrOfFloatsIsReadAsItWasWritten) {
  const Frame frame = made(67, 131, true);
  WriteOptions options;
  options.whole_floats = true;
  write(folder_ / "a.exr", frame, options);
  const Frame back = read_frame(folder_ / "a.exr");
  EXPECT_EQ(back.colour, frame.colour);
  EXPECT_EQ(back.depth, frame.depth);
  EXPECT_EQ(back.normal, frame.normal);
  EXPECT_EQ(back.species, frame.species);
  EXPECT_EQ(back.plants, frame.plants);
  EXPECT_EQ(read(folder_ / "a.exr"), frame.colour);
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ImageFileTest, AnExrOfHalvesKeepsElevenBitsAndWholeDepths) {
  Frame frame = made(67, 31, true);
  frame.colour.at(3, 3)[0] = 1e6f;  // the sun's disc must not become infinite
  write(folder_ / "a.exr", frame);
  const Frame back = read_frame(folder_ / "a.exr");
  for (std::size_t i = 0; i < frame.colour.pixels.size(); ++i) {
    const float truth = std::min(frame.colour.pixels[i], 65504.0f);
    EXPECT_NEAR(back.colour.pixels[i], truth, truth / 2048);
  }
  EXPECT_EQ(back.depth, frame.depth);
  EXPECT_EQ(back.normal, frame.normal);
  EXPECT_EQ(back.plants, frame.plants);
}

TEST_F(ImageFileTest, OtherFormatsHoldWhatTheEyeWouldSee) {
  const Frame frame = made(120, 80, false);
  WriteOptions options;
  options.exposure_stops = -0.5;
  options.jpeg_quality = 98;
  const Image shown = tone_mapped(frame.colour, -0.5);
  const auto error = [&](const char* name) {
    write(folder_ / name, frame, options);
    return compare(shown, read(folder_ / name));
  };
  EXPECT_LT(error("a.png").greatest, 0.0061);  // half a step of 8 bits, where the steps are widest
  EXPECT_LT(error("a.tif").greatest, 2e-5);
  EXPECT_LT(error("a.JPG").rmse, 0.02);
  EXPECT_GT(compare(read(folder_ / "a.png"), read(folder_ / "a.JPG")).greatest, 0);
  // Each is of its kind, whatever its name's case.
  EXPECT_EQ(bytes_of(folder_ / "a.png").substr(1, 3), "PNG");
  EXPECT_EQ(bytes_of(folder_ / "a.JPG").substr(0, 2), "\xFF\xD8");
}

TEST_F(ImageFileTest, AutomaticExposureIsTheDefault) {
  Frame frame = made(40, 40, false);
  for (float& value : frame.colour.pixels) value *= 64;
  write(folder_ / "a.png", frame);
  WriteOptions options;
  options.exposure_stops = automatic_exposure(frame.colour);
  write(folder_ / "b.png", frame, options);
  EXPECT_EQ(bytes_of(folder_ / "a.png"), bytes_of(folder_ / "b.png"));
  options.exposure_stops = 0;
  write(folder_ / "c.png", frame, options);
  EXPECT_NE(bytes_of(folder_ / "a.png"), bytes_of(folder_ / "c.png"));
}

TEST_F(ImageFileTest, WhatElseAFrameHoldsGoesBesideAPicture) {
  const Frame frame = made(40, 40, true);
  write(folder_ / "frame.0001.png", frame);
  EXPECT_EQ(entries(), 2u);
  EXPECT_EQ(files_beside(folder_ / "frame.0001.png", frame), std::vector<fs::path>{folder_ / "frame.0001.aov.exr"});
  EXPECT_EQ(read_frame(folder_ / "frame.0001.aov.exr").plants, frame.plants);
  EXPECT_TRUE(files_beside(folder_ / "a.exr", frame).empty());
  EXPECT_TRUE(files_beside(folder_ / "a.png", made(4, 4, false)).empty());
}

TEST_F(ImageFileTest, SameFrameSameBytesAtAnyTimeOnAnyThreadCount) {
  const Frame frame = made(150, 100, true);
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif"}) write(folder_ / name, frame);
  sleep(1);  // the libraries would write the time of day, in seconds
  const silvasim::base::ThreadLimit one(1);
  for (const char* extension : {"exr", "png", "jpg", "tif"}) {
    write(folder_ / (std::string("b.") + extension), frame);
    EXPECT_EQ(bytes_of(folder_ / (std::string("a.") + extension)), bytes_of(folder_ / (std::string("b.") + extension)))
        << extension;
  }
}

TEST_F(ImageFileTest, MetadataIsInTheFile) {
  WriteOptions options;
  options.metadata = {{"camera", "from the south"}, {"sun", "2026-06-21T10:00"}};
  const Frame frame = made(30, 30, false);
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif"}) {
    write(folder_ / name, frame, options);
    EXPECT_THAT(bytes_of(folder_ / name), HasSubstr("2026-06-21T10:00")) << name;
  }
}

TEST_F(ImageFileTest, RefusesWhatItCannotWriteAndSaysWhy) {
  const Frame frame = made(8, 8, false);
  const auto refusal = [&](const fs::path& path, const Frame& what, const WriteOptions& options = {}) {
    try {
      write(path, what, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(refusal(folder_ / "a.gif", frame), AllOf(HasSubstr("a.gif"), HasSubstr(".exr, .png, .jpg or .tif")));
  EXPECT_THAT(refusal(folder_ / "none" / "a.png", frame), HasSubstr("there is no folder"));
  EXPECT_THAT(refusal("/dev/full", frame), HasSubstr("/dev/full"));
  put(folder_ / "in.png", "input");
  WriteOptions options;
  options.inputs = {folder_ / "in.png"};
  EXPECT_THAT(refusal(folder_ / "in.png", frame, options), HasSubstr("also an input"));
  EXPECT_THAT([&] { check_writable(folder_ / "in.png", options); }, ThrowsMessage<Error>(HasSubstr("also an input")));
  EXPECT_EQ(bytes_of(folder_ / "in.png"), "input");
  EXPECT_THAT(refusal(folder_ / "a.png", Frame{}), HasSubstr("0 x 0"));
  Frame broken = frame;
  broken.plants.resize(63);
  EXPECT_THAT(refusal(folder_ / "a.exr", broken), HasSubstr("plants has 63 values for 64 pixels"));
  broken = frame;
  broken.colour.pixels.resize(5);
  EXPECT_THAT(refusal(folder_ / "a.exr", broken), HasSubstr("colour has 5 values"));
  options.jpeg_quality = 0;
  EXPECT_THAT(refusal(folder_ / "a.jpg", frame, options), HasSubstr("1 to 100"));
  check_writable(folder_ / "new.png");
  EXPECT_EQ(entries(), 1u);  // the input alone
}

TEST_F(ImageFileTest, AFullDiskIsAnErrorAndLeavesNothing) {
  const Frame frame = made(400, 300, true);
  signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif"}) {
    const rlimit little{1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
    EXPECT_THROW(write(folder_ / name, frame), Error) << name;
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(entries(), 0u) << name;
  }
}

TEST_F(ImageFileTest, RefusesFilesThatAreNone) {
  const auto refusal = [&](const fs::path& path) {
    try {
      read(path);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(refusal(folder_ / "none.png"), HasSubstr("none.png"));
  EXPECT_THAT(refusal(folder_), HasSubstr(folder_.string()));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("/dev/zero"));
  for (const char* name : {"empty.png", "empty.exr", "empty.jpg", "empty.tif"}) {
    put(folder_ / name, "");
    EXPECT_THAT(refusal(folder_ / name), AllOf(HasSubstr("cannot read"), HasSubstr(name)));
    put(folder_ / name, std::string(5000, 'x'));
    EXPECT_THAT(refusal(folder_ / name), AllOf(HasSubstr("cannot read"), HasSubstr(name)));
  }
  // A PNG by another name is not taken: the name says which reader may see the bytes.
  write(folder_ / "a.png", made(9, 9, false));
  fs::rename(folder_ / "a.png", folder_ / "a.exr");
  EXPECT_THAT(refusal(folder_ / "a.exr"), HasSubstr("cannot read"));
}

// A PNG header by hand: what it claims stands in bytes 16 to 23, under a checksum.
std::string png_that_claims(std::uint32_t width, std::uint32_t height, std::string bytes) {
  for (int i = 0; i < 4; ++i) {
    bytes[static_cast<std::size_t>(16 + i)] = static_cast<char>(width >> (24 - 8 * i));
    bytes[static_cast<std::size_t>(20 + i)] = static_cast<char>(height >> (24 - 8 * i));
  }
  std::uint32_t crc = 0xFFFFFFFFu;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= static_cast<unsigned char>(bytes[i]);
    for (int k = 0; k < 8; ++k) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  crc = ~crc;
  for (int i = 0; i < 4; ++i) bytes[static_cast<std::size_t>(29 + i)] = static_cast<char>(crc >> (24 - 8 * i));
  return bytes;
}

TEST_F(ImageFileTest, RefusesASmallFileThatClaimsManyPixels) {
  write(folder_ / "a.png", made(16, 16, false));
  const std::string small = bytes_of(folder_ / "a.png");
  ASSERT_EQ(png_that_claims(16, 16, small), small);
  read(folder_ / "a.png");  // the first reading loads the library
  const std::uint64_t before = silvasim::base::peak_rss_bytes();
  put(folder_ / "b.png", png_that_claims(60000, 60000, small));
  EXPECT_THAT([&] { read(folder_ / "b.png"); }, ThrowsMessage<Error>(HasSubstr("60000 x 60000")));
  put(folder_ / "b.png", png_that_claims(20000, 20000, small));
  EXPECT_THAT([&] { read(folder_ / "b.png"); }, ThrowsMessage<Error>(HasSubstr("which no file of")));
  EXPECT_LT(silvasim::base::peak_rss_bytes() - before, 100u << 20);
}

TEST_F(ImageFileTest, RefusesAnExrThatClaimsManyPixels) {
  write(folder_ / "a.exr", made(16, 16, false));
  std::string bytes = bytes_of(folder_ / "a.exr");
  read(folder_ / "a.exr");  // the first reading loads the library
  const std::uint64_t before = silvasim::base::peak_rss_bytes();
  // The data window: name, type, length, then least and greatest x and y.
  for (const std::int32_t most : {30000, 1 << 20, 0x3FFFFFFF, 0x7FFFFFFF}) {
    for (const char* window : {"dataWindow", "displayWindow"}) {
      const std::size_t at = bytes.find(window);
      ASSERT_NE(at, std::string::npos);
      const std::size_t values = at + std::strlen(window) + 1 + std::strlen("box2i") + 1 + 4;
      std::memcpy(bytes.data() + values + 8, &most, 4);
      std::memcpy(bytes.data() + values + 12, &most, 4);
    }
    put(folder_ / "b.exr", bytes);
    EXPECT_THROW(read(folder_ / "b.exr"), Error) << most;
  }
  EXPECT_LT(silvasim::base::peak_rss_bytes() - before, 200u << 20);
}

TEST_F(ImageFileTest, NoTruncationOrFlippedByteDoesHarm) {
  const Frame frame = made(13, 9, true);
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif"}) {
    write(folder_ / name, frame);
    const std::string whole = bytes_of(folder_ / name);
    int read_well = 0, refused = 0;
    const auto attempt = [&](const std::string& bytes) {
      put(folder_ / name, bytes);
      try {
        const Frame back = read_frame(folder_ / name);
        EXPECT_LE(back.colour.width, most_side_px);
        ++read_well;
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr(name));
        ++refused;
      }
    };
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 200);
    for (std::size_t cut = 0; cut < whole.size(); cut += step) attempt(whole.substr(0, cut));
    for (std::size_t i = 0; i < whole.size(); i += step) {
      std::string flipped = whole;
      flipped[i] = static_cast<char>(flipped[i] ^ (i % 2 ? 0x80 : 0x05));
      attempt(flipped);
    }
    EXPECT_GT(refused, 100) << name;
    attempt(whole);
    EXPECT_GT(read_well, 0) << name;
  }
}

TEST_F(ImageFileTest, ReadsRealPhotographs) {
  const fs::path textures = fs::path(SILVA_SHARED_DIR) / "data" / "models";
  if (!fs::exists(textures)) GTEST_SKIP() << "the shared data is not here: " << textures;
  int pictures = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(textures)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".png" && extension != ".jpg") continue;
    if (++pictures > 12) break;
    const Image image = read(entry.path());
    double sum = 0;
    for (const float value : image.pixels) {
      ASSERT_TRUE(value >= 0 && value <= 1) << entry.path();
      sum += static_cast<double>(value);
    }
    EXPECT_GT(sum, 0) << entry.path();
  }
  if (pictures == 0) GTEST_SKIP() << "no pictures in " << textures;
}

}  // namespace
}  // namespace silvavis::image
