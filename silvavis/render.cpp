#include "silvavis/render.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "silvasim/base/parallel.h"
#include "silvavis/sampler.h"

namespace silvavis {

namespace {

// All samples of a block of pixels.
void fill(Sampler& sampler, const RenderOptions& options, int left, int top, image::Image& colour) {
  std::vector<Pixel> pixels = square_of(left, top, block_px, options.camera.width, options.camera.height);
  std::vector<std::size_t> open(pixels.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
  while (!open.empty()) {
    sampler.add(pixels, open, samples_a_pass);
    std::erase_if(open, [&](std::size_t i) { return has_enough(pixels[i], options); });
  }
  for (const Pixel& pixel : pixels) {
    const Rgb mean = pixel.mean();
    std::copy_n(&mean.x, 3, colour.at(pixel.x, pixel.y));
  }
}

image::Frame empty_frame(const RenderOptions& options) {
  const int width = options.camera.width, height = options.camera.height;
  image::Frame frame;
  frame.colour = image::Image(width, height, 3);
  if (options.aovs) {
    frame.depth = image::Image(width, height, 1);
    frame.normal = image::Image(width, height, 3);
    frame.species.resize(frame.depth.pixels.size());
    frame.plants.resize(frame.depth.pixels.size());
  }
  return frame;
}

}  // namespace

image::Frame render(const scene::Scene& scene, const accel::Tracer& tracer, const Light& light, const shade::Land& land,
                    const RenderOptions& options, const silvasim::base::Progress& progress,
                    RenderStatistics* statistics) {
  const shade::Lens lens = shade::lens_of(options.camera);
  image::Frame frame = empty_frame(options);
  const int across = (options.camera.width + block_px - 1) / block_px,
            down = (options.camera.height + block_px - 1) / block_px;
  const std::size_t count = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  std::atomic<std::size_t> done = 0;
  std::atomic<std::uint64_t> eye_rays = 0, shadow_rays = 0;
  silvasim::base::parallel_for(count, [&](std::size_t i) {
    Sampler sampler(scene, tracer, light, land, options, lens, &frame);
    fill(sampler, options, static_cast<int>(i) % across * block_px, static_cast<int>(i) / across * block_px,
         frame.colour);
    eye_rays += sampler.statistics.eye_rays;
    shadow_rays += sampler.statistics.shadow_rays;
    silvasim::base::report(progress, "render", static_cast<double>(++done) / static_cast<double>(count));
  });
  if (statistics) *statistics = {eye_rays, shadow_rays};
  return frame;
}

}  // namespace silvavis
