// Samples of pixels, from the eye's ray to the light that comes back: what render() and Progressive share.
//
// A sample is one ray from the eye, one towards the sun and RenderOptions::sky_rays to the sky, keyed by (seed, pixel, number of
// the sample): a pixel's sum is the same bits however its samples are spread over calls and threads, as long as each pixel's
// are taken in order.
// Threads: a Sampler serves one; several may fill one frame's channels, each pixel by one. Cost: 1 µs a sample on two cores.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "silvavis/pixel_sequence.h"
#include "silvavis/render.h"
#include "silvavis/shade/surface.h"

namespace silvavis {

inline constexpr int block_px = 16;       // side of the blocks of pixels that a thread takes
inline constexpr int samples_a_pass = 4;  // after each such number render() asks whether a pixel has enough

struct Pixel {
  int x = 0, y = 0;
  Rgb sum{0, 0, 0};
  double tone = 0, tone_squared = 0;  // of the samples' square-rooted luminance
  int samples = 0;
  float nearest_offset = std::numeric_limits<float>::max();

  Rgb mean() const { return sum / static_cast<float>(samples); }
};

// The pixels of a square of the picture. Neighbours follow each other (Morton 1966), since their rays are traced together.
std::vector<Pixel> square_of(int left, int top, int side_px, int width, int height);

// Whether render() takes no more samples. Asked elsewhere than after a pass it says no until all are taken.
bool has_enough(const Pixel& pixel, const RenderOptions& options);

class Sampler {
 public:
  // Keeps references to all but `lens`. `channels`: the frame whose depth, normals, species and plants it fills where the options
  // ask for them; none: they are left out.
  Sampler(const scene::Scene& scene, const accel::Tracer& tracer, const Light& light, const shade::Land& land,
          const RenderOptions& options, const shade::Lens& lens, image::Frame* channels = nullptr);

  // Adds up to `count` samples to each of the pixels that `open` names, at most as many as the options allow.
  void add(std::span<Pixel> pixels, std::span<const std::size_t> open, int count);

  RenderStatistics statistics;

 private:
  // One sample on its way.
  struct Sample {
    std::size_t pixel = 0;
    float offset = 0;  // from the pixel's centre, squared
    accel::Ray ray;
    accel::Hit hit;
    shade::SurfacePoint point;
    bool lit = false;       // something is seen that light falls on: of the scene, or of the land around
    bool in_shade = false;  // it may be: of the land around only what is near
    double distance_m = 0;
    Rgb light{0, 0, 0};
    float draws[4] = {};
  };

  Sample sample_of(const Pixel& pixel, int number) const;
  float width_at(const Sample& sample) const;
  void meet(Sample& sample, const accel::Hit& hit) const;
  void mirror_water();
  void add_sun();
  void add_sky();
  void finish(const Sample& sample, Pixel& pixel);
  void keep_channels(const Pixel& pixel, const Sample& sample);

  const scene::Scene& scene_;
  const accel::Tracer& tracer_;
  const Light& light_;
  const shade::Land& land_;
  const RenderOptions& options_;
  const shade::Lens lens_;
  image::Frame* const channels_;
  PixelSequence sequence_;
  float eye_height_ = 0, horizon_m_ = 0;
  std::vector<Sample> samples_;
  std::vector<accel::Ray> rays_;
  std::vector<accel::Hit> hits_;
  std::vector<std::size_t> askers_;
  std::vector<Rgb> shares_;
  std::vector<std::uint8_t> shaded_;
};

}  // namespace silvavis
