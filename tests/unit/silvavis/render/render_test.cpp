#include "silvavis/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../accel/made_forest.h"
#include "grown_wood.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/accel/pack.h"
#include "silvavis/image/compare.h"
#include "silvavis/impostor_of.h"

namespace silvavis::testing {

TEST(Render, IsTheSameOnAnyNumberOfThreads) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const Light light{shade::SkyOptions{}};
  RenderOptions options = small_picture(scene, 250);
  options.samples = 32;
  options.error = 0.03;
  options.aovs = true;
  std::vector<image::Frame> frames;
  for (const int threads : {1, 2, 5}) {
    const silvasim::base::ThreadLimit limit(threads);
    frames.push_back(render(scene, *tracer, light, {}, options));
  }
  for (const image::Frame& frame : frames) {
    EXPECT_EQ(frame.colour, frames[0].colour);
    EXPECT_EQ(frame.depth, frames[0].depth);
    EXPECT_EQ(frame.plants, frames[0].plants);
  }
  for (const float value : frames[0].colour.pixels) {
    ASSERT_TRUE(std::isfinite(value));
    ASSERT_GE(value, 0);
  }
}

TEST(Render, BothBackendsShowTheSamePlantInEveryPixel) {
  const scene::Scene scene = grown_wood(8, 8000);
  const Light light{shade::SkyOptions{}};
  RenderOptions options = small_picture(scene, 400);
  options.camera.width = 640;
  options.camera.height = 360;
  options.samples = 1;
  options.aovs = true;
  options.lod = false;
  const image::Frame nested = render(scene, *accel::make_nested(scene), light, {}, options);
  const image::Frame exact = render(scene, *accel::make_embree(scene, accel::Flat::exact), light, {}, options);
  std::size_t plants = 0, other = 0, deeper = 0;
  for (std::size_t i = 0; i < nested.plants.size(); ++i) {
    plants += nested.plants[i] != image::no_plant;
    if (nested.plants[i] != exact.plants[i] || nested.species[i] != exact.species[i]) {
      ++other;
    } else if (std::isfinite(nested.depth.pixels[i]) &&
               std::abs(nested.depth.pixels[i] - exact.depth.pixels[i]) > 0.01f) {
      ++deeper;
    }
  }
  EXPECT_GT(plants, nested.plants.size() / 4);
  // At most one pixel in 100,000: of 230,400.
  EXPECT_LE(other, 2u);
  EXPECT_LE(deeper, 2u);
}

// Under suns from aside, before, behind the eye and low: own shadow is in tables of directions, and errs where those are coarse.
TEST(Render, LevelsAreAsBrightAsFullModels) {
  const scene::Scene scene = grown_wood(10, 20000);
  const auto tracer = accel::make_nested(scene);
  struct Sun {
    V3 towards;
    double most;  // error
  };
  for (const auto& [towards, most] :
       {Sun{{0.5f, -0.4f, 0.75f}, 0.01}, Sun{{-0.5f, 0.6f, 0.4f}, 0.015}, Sun{{0, -0.8f, 0.5f}, 0.02}}) {
    shade::SkyOptions sky;
    sky.sun_direction = towards.normalized();
    const Light light{sky};
    // At 1 km a pixel of this picture is some metres wide, at 4 km wider than a crown.
    for (const double away : {300.0, 1000.0, 4000.0}) {
      RenderOptions options = small_picture(scene, away);
      options.samples = 16;
      options.lod = false;
      const image::Frame full = render(scene, *tracer, light, {}, options);
      options.lod = true;
      const image::Frame levels = render(scene, *tracer, light, {}, options);
      const auto difference = image::compare(levels.colour, full.colour);
      EXPECT_NEAR(difference.brightness_ratio, 1, most)
          << "at " << away << " m, sun from " << towards.x << ", " << towards.y << ", " << towards.z;
      EXPECT_NE(levels.colour, full.colour) << "no simpler level was used at " << away << " m";
    }
  }
}

// The same wood through a longer lens. What distance adds to where shadow rays begin must not carry them past the leaves beside.
TEST(Render, ADistantWoodUnderALowSunIsNoLighter) {
  const scene::Scene scene = grown_wood(10, 20000);
  const auto tracer = accel::make_nested(scene);
  shade::SkyOptions sky;
  sky.sun_direction = V3(-0.5f, 0.6f, 0.25f).normalized();
  const Light light{sky, {.share = 0, .clear_m = 1e6f}};  // without air
  const auto brightness = [&](double away) {
    RenderOptions options = small_picture(scene, 2000);
    shade::Camera& camera = options.camera;
    const V3d back = (camera.eye - camera.look_at) * (away / 2000 - 1);
    camera.eye = camera.eye + back;
    // Half the wood, and nothing around it.
    camera.fov_deg =
        std::atan(0.5 * std::tan(camera.fov_deg * std::numbers::pi / 360) * 2000 / away) * 360 / std::numbers::pi;
    options.samples = 16;
    options.lod = false;
    options.sky_rays = 0;
    double sum = 0;
    for (const float value : render(scene, *tracer, light, {}, options).colour.pixels)
      sum += static_cast<double>(value);
    return sum;
  };
  EXPECT_NEAR(brightness(100e3) / brightness(2e3), 1, 0.01);
}

TEST(Render, ASampleMoreChangesLittleAndErrorsEndPixelsEarly) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const Light light{shade::SkyOptions{}};
  RenderOptions options = small_picture(scene, 250);
  options.samples = 64;
  RenderStatistics all, adaptive;
  const image::Frame reference = render(scene, *tracer, light, {}, options, {}, &all);
  options.error = 0.05;
  const image::Frame early = render(scene, *tracer, light, {}, options, {}, &adaptive);
  EXPECT_LT(adaptive.eye_rays, all.eye_rays * 3 / 4);
  EXPECT_NEAR(image::compare(early.colour, reference.colour).brightness_ratio, 1, 0.01);
}

// What dusk is brightened by, its errors are too.
TEST(Render, ErrorsCountAsThePictureShowsThem) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const Light light{shade::SkyOptions{}};
  RenderOptions options = small_picture(scene, 250);
  options.samples = 64;
  options.error = 0.05;
  RenderStatistics plain, brightened, finer;
  render(scene, *tracer, light, {}, options, {}, &plain);
  options.brightening = 2;
  render(scene, *tracer, light, {}, options, {}, &brightened);
  options.brightening = 1;
  options.error = 0.025;
  render(scene, *tracer, light, {}, options, {}, &finer);
  EXPECT_GT(brightened.eye_rays, plain.eye_rays * 11 / 10);
  EXPECT_EQ(brightened.eye_rays, finer.eye_rays);
}

// A mat of moss or a lawn: three hundred times as wide as high.
TEST(Impostor, OfAFlatPlantTakesNoMoreThanSomeMegabytes) {
  assets::Model model = leaf_ball(100, 9, 4.5, false, 1);
  for (V3& p : model.positions) p.z /= 300;
  const scene::Impostor flat = impostor_of(accel::pack(model));
  EXPECT_LT(flat.bytes(), std::size_t{5} << 20);
  EXPECT_GE(flat.columns, 50u);
}

TEST(Render, StopsWhenAsked) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const Light light{shade::SkyOptions{}};
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(render(scene, *tracer, light, {}, small_picture(scene, 250), stop), silvasim::base::Cancelled);
}

}  // namespace silvavis::testing
