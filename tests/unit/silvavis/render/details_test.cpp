// Ground detail in pictures: what is too small to see leaves the land as bright as it was with it.
#include <gtest/gtest.h>

#include <cmath>

#include "../accel/made_forest.h"
#include "ghosttile/objects/made/made.h"
#include "ghosttile/tile/frames.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"
#include "silvavis/ground_details.h"
#include "silvavis/render.h"

namespace silvavis::testing {

namespace {

assets::Model made_form(const char* form) {
  ghosttile::objects::made::MadeOptions options;
  options.form = form;
  return ghosttile::objects::made::make(options);
}

// Leaves of two kinds that lie on flat, bare land within some centimetres.
ghosttile::tile::GhostTile leaves() {
  ghosttile::tile::GhostTile tile;
  ghosttile::tile::Spread spread;
  spread.tilts = {{0, 30, 1}};
  for (const char* form : {"maple-leaf", "beech-leaf"}) {
    ghosttile::objects::Detail detail;
    detail.name = form;
    detail.model = made_form(form);
    tile.objects.push_back(std::move(detail));
  }
  for (std::uint32_t c = 0; c < 600; ++c) {
    tile.candidates.push_back(
        ghosttile::tile::random_frame(7, static_cast<std::uint16_t>(c % 2), c, spread, tile.side_m));
    tile.candidates.back().at.z = 0.02f + 0.1f * tile.candidates.back().at.z;
  }
  return tile;
}

struct Land {
  scene::Scene scene;

  explicit Land(bool fades, double share = 0.06) {
    MadeForest forest;
    forest.hills_m = 0;
    silvasim::ecosystem::Ecosystem e = made_ecosystem(forest);
    e.layers.clear();
    scene = scene::make_scene(std::move(e), {});
    const auto tile = leaves();
    DetailOptions options;
    options.fades = fades;
    const scene::DetailKind kind = add_detail_kind(scene, tile, options);
    silvasim::base::Stream random(3, silvasim::base::Purpose::rotation, 5);
    ghosttile::fill::Details details;
    details.first.push_back(0);
    const auto west = static_cast<int>(scene.origin.x / 0.5), south = static_cast<int>(scene.origin.y / 0.5);
    for (int y = south - 50; y < south + 50; ++y) {
      for (int x = west - 50; x < west + 50; ++x) {
        details.tiles.push_back({x, y, 0});
        std::uint16_t instances = 0;
        for (std::uint16_t c = 0; c < tile.candidates.size(); ++c) {
          if (random.next_double() >= share) continue;
          details.chosen.push_back(c);
          ++instances;
        }
        details.instances.push_back(instances);
        details.first.push_back(static_cast<std::uint32_t>(details.chosen.size()));
      }
    }
    scene.details.push_back(detail_layer(scene, kind, details, "made", options));
  }
};

Rgb mean_seen(const scene::Scene& scene, const V3d& from, double width_m, bool lod) {
  const auto tracer = accel::make_nested(scene);
  shade::SkyOptions sky;
  sky.sun_direction = V3(0.3f, -0.5f, 0.8f).normalized();
  const Light light(sky);
  RenderOptions options;
  options.camera.eye = from;
  options.camera.look_at = {0, 0, 0};
  options.camera.width = options.camera.height = 48;
  // So that the picture is about as wide as that.
  options.camera.fov_deg = 2 * std::atan(0.5 * width_m / from.length()) * 180 / 3.14159265;
  options.samples = 16;
  options.error = 0;
  options.lod = lod;
  const image::Frame frame = render(scene, *tracer, light, shade::Land{}, options);
  Rgb sum(0, 0, 0);
  for (std::size_t i = 0; i < frame.colour.pixels.size(); i += 3)
    sum += Rgb(frame.colour.pixels[i], frame.colour.pixels[i + 1], frame.colour.pixels[i + 2]);
  return sum * (3.0f / static_cast<float>(frame.colour.pixels.size()));
}

}  // namespace

TEST(DetailPictures, TheLandIsAsBrightWithoutDetailsThatAreTooSmall) {
  const Land fading(true), full(false), bare(true, 0);
  // From above, and aslant from four sides; a pixel is 0.4 m wide: all are left out.
  float part_sum = 0, full_sum = 0, bare_sum = 0, red = 0, bare_red = 0;
  for (const V3d& from : {V3d(1, 2, 400), V3d(300, 0, 260), V3d(-300, 0, 260), V3d(0, 300, 260), V3d(0, -300, 260)}) {
    const Rgb without = mean_seen(fading.scene, from, 18, true), with = mean_seen(full.scene, from, 18, true),
              nothing = mean_seen(bare.scene, from, 18, true);
    part_sum += luminance(without);
    full_sum += luminance(with);
    bare_sum += luminance(nothing);
    // Leaves that lie aslant are not equally bright from all sides.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(without[c] / with[c], 1, 0.2) << "from " << from << ", channel " << c;
    red += without.x / without.y - with.x / with.y;
    bare_red += nothing.x / nothing.y - with.x / with.y;
  }
  EXPECT_NEAR(part_sum / full_sum, 1, 0.08);
  EXPECT_LT(std::abs(red), std::abs(bare_red) / 4) << "the colour is the leaves', not the land's";
  RecordProperty("brightness", std::to_string(part_sum / full_sum));
  RecordProperty("bare", std::to_string(bare_sum / full_sum));
}

// Between all and none: no step in brightness on the way.
TEST(DetailPictures, FadingDoesNotShowInTheMean) {
  const Land land(true);
  const V3d from(100, 60, 230);
  for (const double width : {2.0, 4.0, 6.0, 8.0, 11.0, 16.0}) {
    const Rgb all = mean_seen(land.scene, from, width, false), some = mean_seen(land.scene, from, width, true);
    EXPECT_NEAR(luminance(some) / luminance(all), 1, 0.15) << width;
  }
}

}  // namespace silvavis::testing
