// Straws: stalks of cut grass or grain.
#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

Model make_straw(const MadeOptions& options) {
  Draws draws(options.seed, 0);
  Model model;
  const Rgb colour = options.colour.value_or(mix(Rgb(0.44f, 0.33f, 0.135f), Rgb(0.33f, 0.235f, 0.10f), draws.share()));
  constexpr int width = 32, height = 128;
  assets::grown::Canvas canvas(width, height);
  const auto salt = static_cast<std::uint32_t>(options.seed * 53 + 7);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / width, v = (static_cast<float>(y) + 0.5f) / height;
      const float line = assets::grown::tiling_noise(u * 8, v * 2, 8, 2, salt), patch = rough(u, v, 2, 5, salt + 3);
      // A node at each end of the texture, which repeats along the stalk.
      const float node = smooth(0.035f, 0.0f, std::min(v, 1 - v));
      canvas.at(x, y).colour = mix(colour * (1 + 0.16f * line + 0.16f * patch), colour * 0.45f, 0.8f * node);
    }
  }
  const int texture = add_texture(model, std::move(canvas), "straw", false);
  Tube tube;
  tube.sides = 5;
  tube.material = tube.cap_material = add_material(model, "straw", Rgb(1, 1, 1), texture);
  tube.v_per_m = draws.between(2.2f, 3.2f);
  const float bow = draws.around(0, 0.07f), kink = draws.share() < 0.3f ? draws.around(0, 0.12f) : 0;
  std::vector<Joint> joints;
  for (int i = 0; i < 6; ++i) {
    const float s = static_cast<float>(i) / 5;
    joints.push_back({V3(s, bow * 4 * s * (1 - s) + (s > 0.6f ? kink * (s - 0.6f) : 0), draws.around(0, 0.006f)),
                      mix(0.0055f, 0.0042f, s)});
  }
  add_tube(model, joints, tube);
  return model;
}

}  // namespace ghosttile::objects::made
