// How much two pictures differ.
#include "silvavis/image/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/random.h"
#include "silvavis/image/tone.h"

namespace silvavis::image {
namespace {

Image noise(std::uint32_t seed, int width = 40, int height = 30) {
  Image image(width, height, 3);
  silvasim::base::Stream stream(seed, silvasim::base::Purpose::selection);
  for (float& value : image.pixels) value = stream.next_float();
  return image;
}

TEST(Compare, EqualPicturesDoNotDiffer) {
  const Image a = noise(1);
  const Difference d = compare(a, a);
  EXPECT_EQ(d.pixels, 1200u);
  EXPECT_EQ(d.mean_absolute, 0);
  EXPECT_EQ(d.rmse, 0);
  EXPECT_TRUE(std::isinf(d.psnr_db));
  EXPECT_EQ(d.brightness_ratio, 1);
  EXPECT_NEAR(d.ssim, 1, 1e-12);
  EXPECT_EQ(d.share_different, 0);
}

TEST(Compare, MeasuresAnOffsetAndABrightening) {
  const Image a = noise(1);
  Image b = a;
  for (float& value : b.pixels) value += 0.125f;
  const Difference d = compare(a, b);
  EXPECT_NEAR(d.mean_absolute, 0.125, 1e-6);
  EXPECT_NEAR(d.rmse, 0.125, 1e-6);
  EXPECT_NEAR(d.psnr_db, 20 * std::log10(8.0), 1e-4);
  EXPECT_NEAR(d.greatest, 0.125, 1e-6);
  EXPECT_EQ(d.share_different, 1);
  for (std::size_t i = 0; i < b.pixels.size(); ++i) b.pixels[i] = a.pixels[i] * 1.5f;
  EXPECT_NEAR(compare(a, b).brightness_ratio, 1.5, 1e-6);
}

TEST(Compare, CountsPixelsAboveTheThresholdOncePerPixel) {
  const Image a = noise(2);
  Image b = a;
  for (int i = 0; i < 6; ++i) {
    for (int c = 0; c < 3; ++c) b.at(i, 3)[c] += 0.5f;
  }
  b.at(20, 20)[1] += 0.009f;  // below
  EXPECT_NEAR(compare(a, b).share_different, 6.0 / 1200, 1e-12);
}

TEST(Compare, TellsValuesThatAreNotFinite) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Image a = noise(3), b = a;
  a.at(0, 0)[0] = b.at(0, 0)[0] = inf;  // the same sky in both
  a.at(1, 0)[0] = b.at(1, 0)[0] = nan;
  EXPECT_EQ(compare(a, b).share_different, 0);
  EXPECT_EQ(compare(a, b).rmse, 0);
  b.at(2, 0)[1] = nan;
  a.at(3, 0)[1] = inf;
  a.at(4, 0)[0] = inf;
  b.at(4, 0)[0] = -inf;
  const Difference d = compare(a, b);
  EXPECT_EQ(d.not_finite, 2u);
  EXPECT_NEAR(d.share_different, 3.0 / 1200, 1e-12);
  EXPECT_TRUE(std::isfinite(d.rmse));
  EXPECT_TRUE(std::isfinite(d.brightness_ratio));
}

TEST(Compare, RefusesPicturesOfDifferentSize) {
  EXPECT_THAT([] { compare(noise(1, 40, 30), noise(1, 30, 40)); },
              testing::ThrowsMessage<silvasim::base::Error>(testing::HasSubstr("40 x 30")));
}

// The definition, window by window, without any trick.
double ssim_by_definition(const Image& a, const Image& b) {
  const auto light = [](const Image& image, int x, int y) {
    const float* p = image.at(x, y);
    return static_cast<double>(srgb_encoded(luminance(Rgb(p[0], p[1], p[2]))));
  };
  double total = 0, windows = 0;
  for (int y = 5; y < a.height - 5; ++y) {
    for (int x = 5; x < a.width - 5; ++x) {
      double w = 0, ma = 0, mb = 0, va = 0, vb = 0, ab = 0;
      for (int pass = 0; pass < 2; ++pass) {
        for (int j = -5; j <= 5; ++j) {
          for (int i = -5; i <= 5; ++i) {
            const double g = std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5));
            const double p = light(a, x + i, y + j), q = light(b, x + i, y + j);
            if (pass == 0) {
              w += g;
              ma += g * p;
              mb += g * q;
            } else {
              va += g / w * (p - ma) * (p - ma);
              vb += g / w * (q - mb) * (q - mb);
              ab += g / w * (p - ma) * (q - mb);
            }
          }
        }
        if (pass == 0) {
          ma /= w;
          mb /= w;
        }
      }
      total += (2 * ma * mb + 1e-4) * (2 * ab + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
      ++windows;
    }
  }
  return total / windows;
}

TEST(Compare, SsimIsWhatItsDefinitionSays) {
  const Image a = noise(5, 37, 23);
  Image b = a;
  silvasim::base::Stream stream(6, silvasim::base::Purpose::selection);
  for (float& value : b.pixels) value += 0.2f * stream.next_float();
  EXPECT_NEAR(ssim(a, b), ssim_by_definition(a, b), 1e-9);
  EXPECT_NEAR(ssim(a, b), ssim(b, a), 1e-12);
  EXPECT_LT(ssim(a, noise(7, 37, 23)), 0.3);
  EXPECT_TRUE(std::isnan(ssim(noise(1, 10, 30), noise(1, 10, 30))));
}

TEST(Compare, CountsIdsThatDiffer) {
  std::vector<std::uint32_t> a(1000, 5), b = a;
  b[3] = 6;
  b[999] = no_plant;
  EXPECT_EQ(compare_ids(a, b).different, 2u);
  EXPECT_NEAR(compare_ids(a, b).share_different, 0.002, 1e-12);
  b.pop_back();
  EXPECT_THROW(compare_ids(a, b), silvasim::base::Error);
}

}  // namespace
}  // namespace silvavis::image
