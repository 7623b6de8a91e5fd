#include "silvavis/progressive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../accel/made_forest.h"
#include "grown_wood.h"
#include "silvasim/base/parallel.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/image/compare.h"

namespace silvavis::testing {

namespace {

const shade::Land plain;

// A size that no square divides.
RenderOptions odd_picture(const scene::Scene& scene, double away_m) {
  RenderOptions options = small_picture(scene, away_m);
  options.camera.width = 93;
  options.camera.height = 53;
  return options;
}

const image::Image& finish(Progressive& progressive, double seconds) {
  for (int frames = 0; !progressive.finished(); ++frames) {
    if (frames > 100'000) {
      ADD_FAILURE() << "the picture is never finished";
      break;
    }
    progressive.refine(seconds);
  }
  return progressive.picture();
}

double mean_luminance(const image::Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3)
    sum += static_cast<double>(luminance(Rgb(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2])));
  return sum / (static_cast<double>(image.pixels.size()) / 3);
}

// Mean squared difference where the second is shifted.
double difference(const image::Image& a, const image::Image& b, int right, int down) {
  double sum = 0;
  constexpr int rim = 16;
  for (int y = rim; y < a.height - rim; ++y)
    for (int x = rim; x < a.width - rim; ++x) {
      const double d = static_cast<double>(a.at(x, y)[1] - b.at(x + right, y + down)[1]);
      sum += d * d;
    }
  return sum / ((a.width - 2.0 * rim) * (a.height - 2.0 * rim));
}

}  // namespace

TEST(Progressive, IsInTheEndWhatRenderGives) {
  const scene::Scene scene = made_forest({});
  const Light light{shade::SkyOptions{}};
  for (const bool nested : {true, false}) {
    const auto tracer = nested ? accel::make_nested(scene) : accel::make_embree(scene);
    Progressive progressive(scene, *tracer, plain);
    for (const int samples : {1, 2, 7, 40}) {
      RenderOptions options = odd_picture(scene, 250);
      options.samples = samples;
      options.error = samples == 40 ? 0.04 : 0;
      RenderStatistics statistics;
      const image::Frame whole = render(scene, *tracer, light, {}, options, {}, &statistics);
      for (const int threads : {1, 3}) {
        const silvasim::base::ThreadLimit limit(threads);
        for (const double seconds : {0.0, 0.002, 1000.0}) {
          progressive.look(light, options);
          EXPECT_EQ(finish(progressive, seconds), whole.colour)
              << samples << " samples, " << threads << " threads, " << seconds << " s, nested " << nested;
        }
      }
      EXPECT_GE(progressive.statistics().eye_rays, statistics.eye_rays);
      if (samples == 40) {
        EXPECT_LT(progressive.samples_a_pixel(), 38) << "no pixel had enough before the others";
      }
    }
  }
}

TEST(Progressive, EveryPixelHasAColourFromTheFirstPictureOn) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const Light light{shade::SkyOptions{}};
  Progressive progressive(scene, *tracer, plain);
  EXPECT_TRUE(progressive.finished());
  EXPECT_TRUE(progressive.picture().empty());
  // Also where the picture is smaller than one square.
  for (const auto& [width, height] : {std::pair{93, 53}, {320, 9}, {5, 3}, {1, 1}}) {
    RenderOptions options = small_picture(scene, 250);
    options.camera.width = width;
    options.camera.height = height;
    progressive.look(light, options);
    EXPECT_EQ(progressive.coarseness_px(), 0);
    double before = 0;
    int coarseness = 1000;
    for (int frame = 0; !progressive.finished() && frame < 100'000; ++frame) {
      progressive.refine(0);
      const image::Image& picture = progressive.picture();
      ASSERT_EQ(picture.width, width);
      ASSERT_EQ(picture.height, height);
      for (const float value : picture.pixels) ASSERT_TRUE(std::isfinite(value) && value > 0) << "in frame " << frame;
      EXPECT_LE(progressive.coarseness_px(), coarseness);
      if (progressive.coarseness_px() == coarseness) {
        EXPECT_GE(progressive.samples_a_pixel(), before);
      }
      coarseness = progressive.coarseness_px();
      before = progressive.samples_a_pixel();
    }
    EXPECT_EQ(progressive.samples_a_pixel(), options.samples);
  }
}

TEST(Progressive, CoarsePicturesAreAsBrightAsTheFinishedOne) {
  const scene::Scene scene = grown_wood(10, 20000);
  const auto tracer = accel::make_nested(scene);
  shade::SkyOptions sky;
  sky.sun_direction = V3(0.5f, -0.4f, 0.75f).normalized();
  const Light light{sky};
  for (const double away : {120.0, 400.0, 1500.0}) {
    RenderOptions options = small_picture(scene, away);
    // So many squares that chance is well below what is asserted.
    options.camera.width = 1600;
    options.camera.height = 900;
    options.samples = 2;
    Progressive progressive(scene, *tracer, plain);
    progressive.look(light, options);
    progressive.refine(0);
    // The last picture of each coarseness.
    std::map<int, double> coarse;
    for (int frame = 0; progressive.coarseness_px() > 1 && frame < 1000; ++frame) {
      coarse[progressive.coarseness_px()] = mean_luminance(progressive.picture());
      progressive.refine(0.02);
    }
    finish(progressive, 100);
    const double finished = mean_luminance(progressive.picture());
    ASSERT_GE(coarse.size(), 1u);
    for (const auto& [stride, brightness] : coarse) {
      EXPECT_NEAR(brightness / finished, 1, 0.02) << stride << " pixels wide, at " << away << " m";
    }
  }
}

TEST(Progressive, CoarsePicturesShowEverythingInItsPlace) {
  const scene::Scene scene = grown_wood(10, 8000);
  const auto tracer = accel::make_nested(scene);
  const Light light{shade::SkyOptions{}};
  RenderOptions options = small_picture(scene, 200);
  options.camera.width = 640;
  options.camera.height = 360;
  const image::Image finished = render(scene, *tracer, light, {}, options).colour;
  Progressive progressive(scene, *tracer, plain);
  progressive.look(light, options);
  progressive.refine(0);
  for (int coarseness = 1000; progressive.coarseness_px() > 1; progressive.refine(0)) {
    if (progressive.coarseness_px() == coarseness) continue;
    coarseness = progressive.coarseness_px();
    const image::Image& coarse = progressive.picture();
    const double in_place = difference(coarse, finished, 0, 0);
    const int shift = (coarseness + 1) / 2 + 1;
    for (const auto& [right, down] : {std::pair{shift, 0}, {-shift, 0}, {0, shift}, {0, -shift}})
      EXPECT_GT(difference(coarse, finished, right, down), in_place) << coarseness << ": " << right << ", " << down;
  }
}

// Whoever enlarges the squares gets the width of those that there are, not of those that are being made.
TEST(Progressive, SquaresAreAsWideAsItTells) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const Light light{shade::SkyOptions{}};
  RenderOptions options = small_picture(scene, 250);
  options.camera.width = 641;
  options.camera.height = 363;
  Progressive progressive(scene, *tracer, plain);
  progressive.look(light, options);
  int frames = 0;
  for (progressive.refine(0); progressive.coarseness_px() > 1; progressive.refine(0), ++frames) {
    const int side = progressive.coarseness_px();
    ASSERT_EQ(progressive.squares().width, (641 + side - 1) / side) << "in frame " << frames;
    ASSERT_EQ(progressive.squares().height, (363 + side - 1) / side) << "in frame " << frames;
    ASSERT_EQ(progressive.samples_a_pixel(), 1.0 / (side * side));
  }
  EXPECT_GT(frames, 10) << "squares were never half made";
}

TEST(Progressive, LooksAnewInTheMiddleOfAPicture) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const Light noon{shade::SkyOptions{}};
  shade::SkyOptions low;
  low.sun_direction = V3(0.9f, 0.3f, 0.1f).normalized();
  const Light evening{low};
  const RenderOptions first = odd_picture(scene, 250);
  RenderOptions second = odd_picture(scene, 90);
  second.camera.width = 201;
  second.lod = false;
  Progressive progressive(scene, *tracer, plain);
  progressive.look(noon, first);
  while (progressive.samples_a_pixel() < 1.5) progressive.refine(0.001);
  progressive.look(evening, second);
  progressive.refine(0);
  EXPECT_GT(progressive.coarseness_px(), 1);
  EXPECT_EQ(progressive.picture().width, 201);
  EXPECT_EQ(finish(progressive, 0.01), render(scene, *tracer, evening, {}, second).colour);
  EXPECT_EQ(progressive.coarseness_px(), 1);

  RenderOptions blind = first;
  blind.camera.look_at = blind.camera.eye;
  EXPECT_ANY_THROW(progressive.look(noon, blind));
}

}  // namespace silvavis::testing
