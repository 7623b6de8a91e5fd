// Twigs, branches and sticks: bent, tapered tubes of bark with forks.
#include <algorithm>

#include "assets/grown/paint.h"
#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

namespace {

struct Wood {
  float radius;  // at the foot; the length is 1
  float taper;   // radius at the tip, as a share
  float crook;   // radians by which it turns at a joint
  int joints, sides;
  int forks_least, forks_most;
  float fork_length;
  bool cut;
  assets::grown::Bark bark;
  Rgb colour;
};

Wood wood_of(const std::string& form) {
  using assets::grown::Bark;
  if (form == "branch")
    return {0.026f, 0.45f, 0.20f, 7, 7, 2, 3, 0.22f, false, Bark::fissured, Rgb(0.115f, 0.092f, 0.072f)};
  if (form == "stick")
    return {0.022f, 0.75f, 0.07f, 7, 6, 0, 1, 0.08f, true, Bark::smooth, Rgb(0.135f, 0.105f, 0.078f)};
  return {0.0125f, 0.35f, 0.30f, 7, 6, 2, 3, 0.38f, false, Bark::smooth, Rgb(0.105f, 0.075f, 0.055f)};
}

}  // namespace

Model make_twig(const MadeOptions& options) {
  const Wood wood = wood_of(options.form);
  Draws draws(options.seed, 0);
  Model model;
  const Rgb colour = options.colour.value_or(wood.colour * draws.between(0.8f, 1.25f));
  model.textures.push_back(assets::grown::paint_bark(wood.bark, colour, options.seed));
  Tube tube;
  tube.sides = wood.sides;
  tube.material = add_material(model, "bark", Rgb(1, 1, 1), 0);
  tube.cap_material = tube.material;
  tube.cut_ends = wood.cut;
  tube.v_per_m = 4;
  if (wood.cut) tube.cap_material = add_material(model, "cut wood", Rgb(0.52f, 0.40f, 0.25f), assets::no_texture);

  // The main way, mostly in the plane that it lies in.
  std::vector<Joint> joints;
  V3 at(0, 0, 0), way(1, draws.around(0, 0.1f), 0);
  const float step = 1 / static_cast<float>(wood.joints - 1);
  for (int i = 0; i < wood.joints; ++i) {
    const float share = static_cast<float>(i) * step;
    joints.push_back({at, wood.radius * mix(1, wood.taper, share) * draws.between(0.9f, 1.1f)});
    at += way * step;
    way = assets::grown::unit(way + V3(0, draws.bell(), 0.45f * draws.bell()) * wood.crook);
    way = assets::grown::unit(mix(way, V3(1, 0, 0), 0.15f));
  }
  add_tube(model, joints, tube);

  // A cut end is peeled for a hand's breadth: a sleeve of bare wood over the bark.
  if (wood.cut) {
    Tube peeled = tube;
    peeled.material = tube.cap_material;
    for (const bool tip : {false, true}) {
      const std::size_t end = tip ? joints.size() - 1 : 0, next = tip ? end - 1 : 1;
      const float r = joints[end].radius * 1.2f;
      const V3 inward = assets::grown::unit(joints[next].at - joints[end].at);
      // Pointed, as teeth leave it.
      const std::vector<Joint> sleeve{{joints[end].at - inward * (2.2f * r), 0.25f * r},
                                      {joints[end].at, r},
                                      {joints[end].at + inward * draws.between(0.02f, 0.07f), r}};
      add_tube(model, sleeve, peeled);
    }
  }

  // Forks leave to alternate sides and bend toward the tip.
  const int forks =
      wood.forks_least + static_cast<int>(draws.share() * static_cast<float>(wood.forks_most - wood.forks_least + 1));
  float side = draws.sign();
  for (int f = 0; f < forks; ++f, side = -side) {
    const float place = (static_cast<float>(f) + draws.between(0.55f, 1.1f)) / (static_cast<float>(forks) + 0.5f);
    const auto joint = std::clamp(static_cast<std::size_t>(place * static_cast<float>(wood.joints)), std::size_t{1},
                                  joints.size() - 2);
    const V3 along = assets::grown::unit(joints[joint + 1].at - joints[joint].at);
    V3 out = assets::grown::unit(along * draws.between(0.7f, 1.2f) + V3(0, side, draws.around(0, 0.5f)));
    const float length = wood.fork_length * draws.between(0.6f, 1.1f) * (1.15f - place);
    const float radius = joints[joint].radius * draws.between(0.5f, 0.7f);
    std::vector<Joint> fork;
    V3 p = joints[joint].at;
    for (int i = 0; i < 4; ++i) {
      const float share = static_cast<float>(i) / 3;
      fork.push_back({p, radius * mix(1, 0.4f, share)});
      p += out * (length / 3);
      out = assets::grown::unit(out + along * 0.2f + V3(0, draws.bell(), draws.bell()) * (0.6f * wood.crook));
    }
    Tube thin = tube;
    thin.sides = 4;
    thin.cap_material = tube.material;
    thin.cut_ends = false;
    add_tube(model, fork, thin);
  }
  return model;
}

}  // namespace ghosttile::objects::made
