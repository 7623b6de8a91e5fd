// From a scene to a picture.
//
// Each pixel's samples are keyed by (seed, pixel, sample) alone: the same seed gives the same picture on any number of
// threads. A sample is one ray from the eye, one towards the sun and `sky_rays` to the sky. With `error` above zero a pixel
// ends early once the standard error of its tone is below it.
// Errors: base::Error for a camera that sees nothing; base::Cancelled from the progress.
// Threads: parallel inside, by blocks of 16 x 16 pixels. Cost: docs/performance.md.
#pragma once

#include <algorithm>
#include <cstdint>

#include "silvasim/base/progress.h"
#include "silvavis/accel/tracer.h"
#include "silvavis/image/image.h"
#include "silvavis/shade/camera.h"
#include "silvavis/shade/haze.h"
#include "silvavis/shade/land.h"
#include "silvavis/shade/sky.h"
#include "silvavis/shade/sky_rays.h"

namespace silvavis {

// The sky twice: as the eye sees it, and as it shines on the land, which may lie kilometres below the eye and half the air with it.
struct Light {
  shade::Sky sky;
  shade::Haze haze;
  shade::Sky over_land;
  shade::SkyRays sky_rays;
  Rgb among;  // radiance of what bars the sky from leaves and ground: they see each other

  explicit Light(const shade::SkyOptions& options, const shade::HazeOptions& haze_options = {})
      : sky(options), haze(sky, haze_options), over_land(shade::at_land(options)), sky_rays(over_land) {
    // What a mean wood shows; shade::sent_back() measures it in the scene itself.
    const Rgb lit =
        over_land.sun_irradiance() * std::max(over_land.sun_direction().z, 0.0f) + over_land.sky_irradiance();
    among = lit * Rgb(0.045f, 0.070f, 0.025f) * (0.35f / shade::pi);
  }
};

struct RenderOptions {
  shade::Camera camera;  // world space
  int samples = 16;      // the most a pixel gets
  double error = 0.02;  // a pixel ends below this standard error of its square-rooted luminance; 0: all get all samples
  double brightening = 1;  // by which that will be multiplied when the picture is shown: 2^(stops / 2)
  int sky_rays = 1;        // 0: the sky without shadows of its own
  bool sun_shadows = true;
  bool lod = true;    // simpler models where a pixel is wider than their leaves
  bool aovs = false;  // depth, normal, species, plant
  std::uint64_t seed = 1;
};

struct RenderStatistics {
  std::uint64_t eye_rays = 0, shadow_rays = 0;
};

image::Frame render(const scene::Scene& scene, const accel::Tracer& tracer, const Light& light, const shade::Land& land,
                    const RenderOptions& options, const silvasim::base::Progress& progress = {},
                    RenderStatistics* statistics = nullptr);

}  // namespace silvavis
