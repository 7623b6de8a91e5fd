// How much two pictures differ. `silvavis diff` prints it, and tests of pictures stand on it.
//
// Light is compared as it is (linear), channel by channel; SSIM compares what the eye would see.
// No data: a value that is infinite or NaN in both pictures is equal and leaves the means; in one alone it counts as a
//   difference in `share_different` and `not_finite`, and leaves the means too.
// Errors: base::Error where the sizes differ.
// Threads: any; sums run in the order of the pixels. Cost: 2 million pixels in about 0.2 s, most of it SSIM.
#pragma once

#include <cstdint>
#include <span>

#include "silvavis/image/image.h"

namespace silvavis::image {

struct CompareOptions {
  float threshold = 0.01f;    // a pixel differs where a channel does by more
  double exposure_stops = 0;  // for SSIM
  bool ssim = true;           // the slow part
};

struct Difference {
  std::uint64_t pixels = 0;
  double mean_absolute = 0;
  double rmse = 0;
  double psnr_db = 0;  // against a peak of 1; infinity where the pictures are equal
  double greatest = 0;
  double brightness_ratio = 1;   // mean luminance of b over that of a; 1 where both are black
  double ssim = 1;               // -1 to 1; NaN where it was not asked for or a side is below 11 pixels
  double share_different = 0;    // of the pixels
  std::uint64_t not_finite = 0;  // values that are finite in one picture alone
};

Difference compare(const Image& a, const Image& b, const CompareOptions& options = {});

// Names of things, which are equal or not.
struct IdDifference {
  std::uint64_t pixels = 0;
  std::uint64_t different = 0;
  double share_different = 0;
};
IdDifference compare_ids(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b);
IdDifference compare_ids(std::span<const std::uint16_t> a, std::span<const std::uint16_t> b);

// Structural similarity of luminance, in sRGB's encoding: Gaussian windows of 11 x 11 pixels with sigma 1.5, wholly
// inside the picture, K1 = 0.01, K2 = 0.03.
// Source: Wang, Bovik, Sheikh and Simoncelli, Image Quality Assessment: From Error Visibility to Structural Similarity,
//   IEEE Trans. Image Processing 13 (4), 2004, equation 13.
double ssim(const Image& a, const Image& b, double exposure_stops = 0);

}  // namespace silvavis::image
