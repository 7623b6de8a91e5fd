// A picture that is there at once and gets better: for a window or a browser, while someone flies through the scene.
//
// look() says where from. The first refine() after it makes a coarse picture, one sample for a square of pixels, as wide as the
// time allows; the next ones halve the squares, then give each pixel its samples one after another, blocks of pixels in an
// order that is spread over the picture. A coarse ray is as wide as its square, so it meets simpler models, and all rays towards sun and
// sky are as in the end: coarse and final picture are equally bright.
//
// Promise: once finished() the picture has the same bytes as render()'s colours for the same options. Every pixel has a colour from the
//   first refine() on. refine() ends about 1 ms after its time is up, the first one after look() as well as it foresees.
// Errors: base::Error for a camera that sees nothing, by look().
// Threads: parallel inside; one caller at a time. Memory: 60 bytes a pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "silvavis/render.h"
#include "silvavis/sampler.h"

namespace silvavis {

class Progressive {
 public:
  // All of them, and `light` below, must outlive it.
  Progressive(const scene::Scene& scene, const accel::Tracer& tracer, const shade::Land& land);
  Progressive(const scene::Scene&, const accel::Tracer&, shade::Land&&) = delete;

  // Begins anew. Channels are not made (RenderOptions::aovs).
  void look(const Light& light, const RenderOptions& options);

  void refine(double seconds);  // works for about that long

  // As it now is. Valid until the next call of look() or refine().
  const image::Image& picture();
  // The same as it was sampled while coarseness_px() is above 1, a pixel a square: quicker to tone and to send, for whoever
  // enlarges it. The last squares may reach beyond the picture's right and lower edges.
  const image::Image& squares() const { return squares_; }

  bool finished() const { return finished_; }
  // Side of a sample's square in what is shown, that is of squares(); 0 before refine(), 1: the pixels themselves.
  int coarseness_px() const { return stride_ > 1 ? shown_stride_ : stride_; }
  double samples_a_pixel() const;                                     // below 1 while squares are sampled
  const RenderStatistics& statistics() const { return statistics_; }  // since look()

 private:
  using Seconds = double;

  int first_stride(Seconds budget) const;
  Seconds foreseen(int stride) const;
  void begin(int stride);
  void begin_pass();
  bool is_through() const { return done_ == order_.size(); }
  void work(Seconds until);
  void fill_squares(Sampler& sampler, std::size_t block);
  std::size_t fill_pixels(Sampler& sampler, std::size_t block);  // how many samples that took

  const scene::Scene& scene_;
  const accel::Tracer& tracer_;
  const shade::Land& land_;
  const Light* light_ = nullptr;
  RenderOptions options_, square_options_;
  shade::Lens lens_{};

  int stride_ = 0;                        // of what is being sampled; 0: nothing yet
  int shown_stride_ = 0;                  // of squares_
  int usual_stride_ = 0;                  // of first pictures
  Seconds seconds_a_sample_ = 0;          // of first pictures, all threads together; 0: not known
  image::Image squares_, finer_squares_;  // a pixel a square; the second while it is not through
  bool enlarged_ = true;                  // the picture holds what the squares do
  image::Image picture_;
  std::vector<std::vector<Pixel>> blocks_;
  std::vector<std::size_t> order_;  // blocks of this pass
  std::size_t done_ = 0;            // of them
  std::uint64_t samples_ = 0;       // of the pixels, not of squares
  bool finished_ = true;
  RenderStatistics statistics_;
};

}  // namespace silvavis
