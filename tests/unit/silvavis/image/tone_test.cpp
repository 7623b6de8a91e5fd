// From light to what a screen shows.
#include "silvavis/image/tone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "silvasim/base/parallel.h"
#include "silvasim/base/random.h"

namespace silvavis::image {
namespace {

Image even(float value, int width = 32, int height = 16) {
  Image image(width, height, 3);
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return image;
}

// Light over 24 stops, all colours.
Image noise(std::uint32_t seed) {
  Image image(97, 61, 3);
  silvasim::base::Stream stream(seed, silvasim::base::Purpose::selection);
  for (float& value : image.pixels) value = std::exp2(stream.next_float() * 24 - 14);
  return image;
}

TEST(Tone, EncodesAndDecodesSrgbAsTheStandardDoes) {
  for (int i = 0; i <= 4096; ++i) {
    const double linear = i / 4096.0;
    const double truth = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    EXPECT_NEAR(srgb_encoded(static_cast<float>(linear)), truth, 4e-7) << linear;
    EXPECT_NEAR(srgb_decoded(static_cast<float>(truth)), linear, 4e-7) << linear;
  }
  EXPECT_EQ(srgb_encoded(-1), 0);
  EXPECT_EQ(srgb_encoded(7), 1);
  EXPECT_EQ(srgb_encoded(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(srgb_encoded(1), 1);
}

TEST(Tone, EveryByteSurvivesDecodingAndEncoding) {
  Image bytes(256, 1, 1);
  for (int i = 0; i < 256; ++i) bytes.at(i, 0)[0] = srgb_decoded(static_cast<float>(i) / 255);
  const std::vector<std::uint8_t> back = srgb_bytes(bytes);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(back[i], i);
  Image words(65536, 1, 1);
  for (int i = 0; i < 65536; ++i) words.at(i, 0)[0] = srgb_decoded(static_cast<float>(i) / 65535);
  const std::vector<std::uint16_t> words_back = srgb_words(words);
  for (std::size_t i = 0; i < 65536; ++i) EXPECT_NEAR(words_back[i], static_cast<double>(i), 1);
}

TEST(Tone, GreyStaysGreyAndBrighterLightIsShownBrighter) {
  float before = -1;
  for (float stops = -11; stops < 4; stops += 0.125f) {
    const float light = std::exp2(stops);
    const Rgb shown = tone_mapped(Rgb(light, light, light), 1);
    EXPECT_NEAR(shown.x, shown.y, 0.003f) << stops;
    EXPECT_NEAR(shown.z, shown.y, 0.003f) << stops;
    EXPECT_GT(shown.y, before) << stops;
    before = shown.y;
  }
  EXPECT_GT(before, 0.98f);
  // A grey card stays about what it is, a white sheet is light but has room above it.
  EXPECT_NEAR(tone_mapped(Rgb(0.18f, 0.18f, 0.18f), 1).y, 0.18f, 0.04f);
  const float white = srgb_encoded(tone_mapped(Rgb(1, 1, 1), 1).y);
  EXPECT_GT(white, 0.65f);
  EXPECT_LT(white, 0.9f);
}

TEST(Tone, GrassStaysGreenAndHighlightsRunToWhiteNotToAPrimary) {
  for (float stops = -4; stops <= 2; ++stops) {
    const Rgb grass = tone_mapped(Rgb(0.07f, 0.13f, 0.03f), std::exp2(stops));
    EXPECT_GT(grass.y, 1.2f * grass.x) << stops;
    EXPECT_GT(grass.x, grass.z) << stops;
  }
  // Strong orange light: clipping would show yellow, with red = green and no blue.
  const Rgb orange = tone_mapped(Rgb(16, 5, 0.5f), 1);
  EXPECT_GT(orange.x, orange.y);
  EXPECT_GT(orange.z, 0.2f);
  // Strong blue light of the sky: clipping would show cyan, with green = blue and no red.
  const Rgb blue = tone_mapped(Rgb(3, 6, 14), 1);
  EXPECT_GT(blue.x, 0.4f);
  EXPECT_GT(blue.z, blue.y);
}

TEST(Tone, ShowsNothingOutsideOfTheScreenWhateverComes) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const float r : {-1.0f, 0.0f, 1e-30f, 0.5f, 1e30f, inf, -inf, nan}) {
    for (const float g : {0.0f, 3.0f, inf, nan}) {
      const Rgb shown = tone_mapped(Rgb(r, g, 0.2f), 1);
      for (const float value : {shown.x, shown.y, shown.z}) EXPECT_TRUE(value >= 0 && value <= 1) << r << " " << g;
    }
  }
  EXPECT_LT(tone_mapped(Rgb(nan, nan, nan), 1).y, 1e-3f);
}

TEST(Tone, APictureIsItsPixelsOneByOneOnAnyThreadCount) {
  const Image light = noise(3);
  const Image shown = tone_mapped(light, 1.5);
  const float scale = std::exp2(1.5f);
  for (int y = 0; y < light.height; y += 7) {
    for (int x = 0; x < light.width; ++x) {
      const float* p = light.at(x, y);
      const Rgb one = tone_mapped(Rgb(p[0], p[1], p[2]), scale);
      EXPECT_FLOAT_EQ(one.x, shown.at(x, y)[0]);
      EXPECT_FLOAT_EQ(one.z, shown.at(x, y)[2]);
    }
  }
  const silvasim::base::ThreadLimit one_thread(1);
  EXPECT_EQ(tone_mapped(light, 1.5), shown);
}

TEST(Tone, ExposureBringsTheMiddleToAQuarterAndFollowsTheLight) {
  EXPECT_NEAR(automatic_exposure(even(0.25f)), 0, 0.05);
  EXPECT_NEAR(automatic_exposure(even(0.25f * 8)), -3, 0.05);      // too bright: all the way back
  EXPECT_NEAR(automatic_exposure(even(0.25f / 8)), 3 * 0.8, 0.1);  // dark woods by day: most of the way
  // By less light eyes get used to it in part: Krawczyk et al. 2005, equation 11, against the 2000 cd/m2 of land by day.
  for (const double cd_m2 : {300.0, 10.0, 1.0, 0.1}) {
    const auto key = [](double l) { return 1.03 - 2 / (2 + std::log10(l + 1)); };
    const double shown = 0.25 * key(cd_m2) / key(2000), is = cd_m2 / cd_m2_per_unit;
    EXPECT_NEAR(automatic_exposure(even(static_cast<float>(is))), std::min(14.0, std::log2(shown / is) - 0.6), 0.1)
        << cd_m2;
  }
  EXPECT_EQ(automatic_exposure(even(0)), 0);
  EXPECT_EQ(automatic_exposure(Image{}), 0);
  EXPECT_LE(automatic_exposure(even(1e-9f)), 14);  // night stays night
}

TEST(Tone, ExposureForgetsAFewVeryBrightOrBrokenPixels) {
  Image image = even(0.18f, 100, 100);
  const double plain = automatic_exposure(image);
  for (int i = 0; i < 300; ++i) image.at(i % 100, i / 100)[1] = 50000;
  EXPECT_NEAR(automatic_exposure(image), plain, 0.05);
  for (int i = 0; i < 100; ++i) image.at(i, 50)[0] = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 100; ++i) image.at(i, 51)[0] = std::numeric_limits<float>::infinity();
  EXPECT_NEAR(automatic_exposure(image), plain, 0.05);
}

TEST(Tone, ExposesByTheLandWhereThereIsSome) {
  Frame frame;
  frame.colour = even(0.1f, 100, 10);
  frame.depth = Image(100, 10, 1);
  std::fill(frame.depth.pixels.begin(), frame.depth.pixels.end(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(land_of(frame), frame.colour);  // nothing but sky
  for (std::size_t i = 0; i < 300; ++i) {
    frame.depth.pixels[i] = 100;
    for (std::size_t c = 0; c < 3; ++c) frame.colour.pixels[3 * i + c] = 0.02f;
  }
  EXPECT_EQ(automatic_exposure(land_of(frame)), automatic_exposure(even(0.02f)));
  frame.depth = {};
  EXPECT_EQ(land_of(frame), frame.colour);
}

TEST(Tone, OneExposureForAFlightLiesBetweenItsFrames) {
  const std::vector<Image> frames = {even(0.5f), even(2.0f)};
  const double both = automatic_exposure(frames);
  EXPECT_LT(both, automatic_exposure(frames[0]));
  EXPECT_GT(both, automatic_exposure(frames[1]));
}

}  // namespace
}  // namespace silvavis::image
