// What land sends back, measured once, against pictures of it.
#include <gtest/gtest.h>

#include <cmath>

#include "grown_wood.h"
#include "silvavis/accel/nested.h"
#include "silvavis/shade/overhead.h"

namespace silvavis::testing {

namespace {

shade::Overhead over(const scene::Scene& scene, const accel::Tracer& tracer, const shade::Land& land) {
  return {scene, tracer, land,
          static_cast<double>(scene.land.pyramid.origin_m + 65535 * scene.land.pyramid.step_m) + 10};
}

}  // namespace

TEST(SentBack, OfAWoodIsWhatItsPictureShows) {
  const scene::Scene scene = grown_wood(10, 8000);
  const auto tracer = accel::make_nested(scene);
  shade::SkyOptions sky;
  sky.sun_direction = V3(0.55f, -0.45f, 0.7f).normalized();
  Light light{sky};
  const shade::Land land;
  const Rgb albedo(0.05f, 0.05f, 0.05f);
  const shade::SentBack sent = shade::sent_back(over(scene, *tracer, land), light.over_land, albedo);
  light.among = sent.among;
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(sent.among[c], 0);
    EXPECT_LT(sent.among[c], luminance(light.over_land.sun_irradiance()) * 0.1f);
  }
  const shade::Sky& on = light.over_land;
  const Rgb level = albedo * (on.sun_irradiance() * on.sun_direction().z + on.sky_irradiance()) / shade::pi;
  double greatest = 0, least = 1e9;
  for (const std::size_t number : {24u, 27u, 30u, 33u, 36u}) {
    // Through a long lens at the middle of the wood.
    const V3 towards = shade::Views::direction(number);
    RenderOptions options;
    options.camera.look_at = {0, 0, scene::ground_at(scene.ground, 0, 0).height_m};
    options.camera.eye = options.camera.look_at + V3d(towards) * 3000;
    options.camera.fov_deg = 2 * std::atan(0.25 * scene.extent.width() / 3000) * 180 / 3.14159265;
    options.camera.width = options.camera.height = 48;
    options.samples = 16;
    options.error = 0;
    shade::HazeOptions none;
    none.share = 0;
    none.clear_m = 1e5f;
    Light clear{sky, none};
    clear.among = sent.among;
    const image::Frame frame = render(scene, *tracer, clear, land, options);
    double sum = 0;
    for (std::size_t i = 0; i < frame.colour.pixels.size(); i += 3)
      sum += static_cast<double>(
          luminance(Rgb(frame.colour.pixels[i], frame.colour.pixels[i + 1], frame.colour.pixels[i + 2])));
    const double shown = sum / (48 * 48), told = static_cast<double>(luminance(sent.views.shares[number] * level));
    EXPECT_NEAR(told, shown, 0.12 * shown) << number;
    greatest = std::max(greatest, shown);
    least = std::min(least, shown);
  }
  EXPECT_GT(greatest, 1.2 * least);  // sides differ
}

TEST(SentBack, OfBareFlatGroundIsItsOwnReflectance) {
  silvasim::ecosystem::Ecosystem e;
  e.extent = {0, 0, 400, 400};
  const scene::Scene scene = scene::make_scene(std::move(e), {});
  const auto tracer = accel::make_nested(scene);
  shade::Land land;
  land.drape = image::Image(1, 1, 3);
  const Rgb colour(0.2f, 0.1f, 0.3f);
  std::copy_n(&colour.x, 3, land.drape.at(0, 0));
  land.drape_box = {-1000, -1000, 1000, 1000};
  shade::SkyOptions sky;
  sky.sun_direction = V3(0.55f, -0.45f, 0.7f).normalized();
  const shade::SentBack sent = shade::sent_back(over(scene, *tracer, land), Light{sky}.over_land, colour);
  EXPECT_EQ(sent.among, Rgb(0, 0, 0));
  for (const Rgb& share : sent.views.shares)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(share[c], 1, 0.03f);
}

}  // namespace silvavis::testing
