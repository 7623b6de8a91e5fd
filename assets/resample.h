// Pictures made smaller (or larger), row by row as they are read.
#pragma once

#include <cstddef>
#include <vector>

namespace assets {

// Filter: the cubic of Mitchell and Netravali (1988) with B = C = 1/3, widened by the factor of the reduction; at the
// borders cut off and normalised.
class Resampler {
 public:
  Resampler(int width, int height, int new_width, int new_height, int channels);

  void add_row(const std::vector<float>& row);  // width * channels, from the top

  // new_width * new_height * channels; complete after `height` rows.
  const std::vector<float>& pixels() const { return pixels_; }

 private:
  struct Taps {
    int first = 0;
    std::vector<float> weights;
  };
  static std::vector<Taps> taps(int size, int new_size);

  std::size_t channels_;
  std::vector<Taps> across_, down_;
  std::vector<float> row_, pixels_;
  int y_ = 0;
  std::size_t first_open_ = 0;  // rows of the result above are complete
};

// Moves alphas (0 to 1) so that exactly `share` of them, to the nearest texel, are at least `cutoff`, by scaling as
// Castano (2010) does for mipmaps; ties are told apart in a fixed scattered order.
void keep_coverage(std::vector<float>& alphas, float cutoff, double share);

}  // namespace assets
