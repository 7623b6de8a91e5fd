#include "assets/grown/skeleton.h"

#include <algorithm>

#include "assets/grown/reach.h"

namespace assets::grown {

namespace {

constexpr float golden_angle = 2.39996323f;
constexpr float least_twig_m = 0.0015f;

// How an axis is drawn through space.
struct Way {
  V3 from, direction;
  float length = 1;
  int steps = 4;
  float rise = 0, tip_rise = 0, crook = 0;
  float radius = 0.01f, tip_radius = 0.002f, taper = 1;
  bool bound = true;  // ends at the outline
};

class Grower {
 public:
  Grower(const Form& form, float height, float radius, std::uint64_t seed)
      : form_(form), height_(height), draws_(seed, 1), outline_(form, height, radius, draws_), radius_(radius) {}

  Skeleton grow() {
    for (int s = 0; s < std::max(1, form_.stems); ++s) grow_stem(s);
    fill_crown();
    return std::move(skeleton_);
  }

 private:
  // Stretches the wood to the asked size before leaves are measured.
  void fill_crown() {
    std::vector<V3> points;
    for (const Node& node : skeleton_.nodes) points.push_back(node.position);
    fit_points(points, height_, radius_);
    for (std::size_t i = 0; i < points.size(); ++i) skeleton_.nodes[i].position = points[i];
    for (Axis& axis : skeleton_.axes) {
      axis.length = 0;
      for (std::uint32_t i = axis.first + 1; i < axis.first + axis.count; ++i)
        axis.length += length_of(points[i] - points[i - 1]);
    }
  }

  // Walks a way step by step and adds it as an axis. Returns its index, or -1 where it had no room.
  int add_axis(const Way& way, int order) {
    V3 p = way.from, d = way.direction, kick(0, 0, 0);
    const float step = way.length / static_cast<float>(way.steps);
    const auto first = static_cast<std::uint32_t>(skeleton_.nodes.size());
    skeleton_.nodes.push_back({p, way.radius});
    for (int i = 1; i <= way.steps; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(way.steps);
      // The wandering has a memory, so that branches bend rather than tremble.
      const float wander = order == 0 ? mix(0.35f, 1.1f, s) : 1;  // boles are the straightest
      const V3 wind = V3(draws_.bell(), draws_.bell(), draws_.bell());
      kick = kick * 0.5f + wind * (wander * way.crook * 0.8f / std::sqrt(static_cast<float>(way.steps)));
      const float turn = 2 * (s <= 0.5f ? way.rise : way.tip_rise) / static_cast<float>(way.steps);
      d = unit(d + kick + V3(0, 0, turn), d);
      const V3 next = p + d * step;
      if (way.bound && i > 1 && !outline_.inside(next)) break;
      p = next;
      skeleton_.nodes.push_back({p, mix(way.radius, way.tip_radius, power(s, way.taper))});
    }
    const auto count = static_cast<std::uint32_t>(skeleton_.nodes.size()) - first;
    // A branch that met the outline early is not cut off but tapers to its end.
    for (std::uint32_t i = 0; i < count; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(count - 1);
      skeleton_.nodes[first + i].radius = mix(way.radius, way.tip_radius, power(s, way.taper));
    }
    Axis axis;
    axis.first = first;
    axis.count = count;
    axis.order = order;
    axis.length = step * static_cast<float>(count - 1);
    skeleton_.axes.push_back(axis);
    return static_cast<int>(skeleton_.axes.size()) - 1;
  }

  // Where the stem dissolves, its end is no higher than the limbs' ends.
  float top_share() const { return form_.leader < 0.9f ? 0.93f : 0.99f; }

  float leafed_from(int order) const {
    if (order >= form_.orders) return 1 - form_.leafed_share;
    if (order == 0) return 0.93f;
    return 1 - form_.inner_leaves;
  }

  void grow_stem(int number) {
    const bool many = form_.stems > 1;
    // Of many stems the middle one is the straightest and the highest.
    const float out = many ? std::sqrt((static_cast<float>(number) + 0.3f) / static_cast<float>(form_.stems)) : 0;
    const float azimuth = golden_angle * static_cast<float>(number) + draws_.around(0, 0.4f);
    const float lean = radians(form_.stem_lean_deg) * (many ? out * draws_.between(0.8f, 1.1f) : draws_.share());
    const SinCos a = sin_cos(azimuth), l = sin_cos(lean);
    const float foot =
        form_.stem_radius_share * height_ * (many ? mix(1.1f, 0.6f, out) * draws_.between(0.8f, 1.1f) : 1);
    Way way;
    way.direction = unit(V3(l.sin * a.cos, l.sin * a.sin, l.cos));
    way.from = V3(a.cos, a.sin, 0) * (many ? out * foot * 4 : 0);
    way.length =
        many ? std::min(outline_.room(way.from, way.direction, 2 * height_) * draws_.between(0.85f, 1.0f), height_)
             : height_ * top_share();
    way.steps = 24;
    way.crook = form_.stem_crook;
    way.rise = many ? 0.35f * lean : 0.0f;
    way.tip_rise = -form_.tip_droop * 0.2f;
    way.radius = foot;
    way.tip_radius = std::max(least_twig_m, foot * 0.03f);
    way.taper = 0.9f;
    way.bound = many;
    const int stem = add_axis(way, 0);
    if (!many) straighten(stem);
    Axis& axis = skeleton_.axes[static_cast<std::size_t>(stem)];
    axis.leafed_from = leafed_from(0);
    widen_foot(axis, foot);
    grow_limbs(stem);
  }

  // A single stem wanders around the plumb line but its top stands above its foot.
  void straighten(int stem) {
    const Axis& axis = skeleton_.axes[static_cast<std::size_t>(stem)];
    const V3 top = skeleton_.nodes[axis.first + axis.count - 1].position;
    const float stretch = height_ * top_share() / std::max(top.z, 0.1f * height_);
    // In a stand most stems are nearly straight, some are not.
    const float crooked = mix(0.2f, 0.8f, draws_.share() * draws_.share());
    for (std::uint32_t i = 0; i < axis.count; ++i) {
      V3& p = skeleton_.nodes[axis.first + i].position;
      const float s = p.z / std::max(top.z, 0.1f * height_);
      p = V3(crooked * (p.x - 0.8f * top.x * s), crooked * (p.y - 0.8f * top.y * s), p.z * stretch);
    }
    if (form_.tip_droop > 0) {
      // The leader hangs over: the last nodes go sideways and down.
      const SinCos a = sin_cos(draws_.between(0, 2 * pi));
      const std::uint32_t last = axis.first + axis.count - 1;
      skeleton_.nodes[last].position += V3(a.cos, a.sin, -0.5f) * (0.02f * height_ * form_.tip_droop);
    }
  }

  void widen_foot(const Axis& axis, float foot) {
    for (std::uint32_t i = 0; i < axis.count; ++i) {
      Node& node = skeleton_.nodes[axis.first + i];
      const float away = node.position.z / (foot * 3);
      node.radius *= 1 + form_.flare * silvasim::base::exp(-away);
    }
  }

  // Branches of the first order: by height, as the crown needs them.
  void grow_limbs(int stem) {
    const Branches& rule = form_.branches[0];
    const Axis parent = skeleton_.axes[static_cast<std::size_t>(stem)];
    const bool many = form_.stems > 1;
    const float low = form_.crown_base * height_, high = 0.985f * top_share() * height_;
    const int groups = std::max(1, rule.count / std::max(1, rule.whorl));
    float azimuth = draws_.between(0, 2 * pi);
    for (int g = 0; g < groups; ++g) {
      // Whorls come closer towards the top, where the years' shoots are shorter.
      float t = (static_cast<float>(g) + draws_.between(0.2f, 0.8f)) / static_cast<float>(groups);
      t = mix(t, 1 - (1 - t) * (1 - t), rule.whorl > 1 ? 0.3f : 0.0f);
      azimuth += rule.whorl > 1 ? draws_.between(0.5f, 1.5f) : golden_angle + draws_.around(0, 0.5f);
      for (int w = 0; w < std::max(1, rule.whorl); ++w) {
        if (rule.whorl > 1 && draws_.share() < 0.12f) continue;  // whorls miss a branch here and there
        const float turn = azimuth + 2 * pi * static_cast<float>(w) / static_cast<float>(std::max(1, rule.whorl)) +
                           (rule.whorl > 1 ? draws_.around(0, 0.35f) : 0);
        const float z =
            mix(low, high, clamp01(t + (rule.whorl > 1 ? draws_.around(0, 0.6f) / static_cast<float>(groups) : 0)));
        float share = (z - skeleton_.nodes[parent.first].position.z) /
                      std::max(1e-3f, skeleton_.nodes[parent.first + parent.count - 1].position.z);
        if (many) share = mix(form_.crown_base, 0.95f, t);
        if (share >= 0.995f) continue;
        const Spot spot = spot_at(skeleton_, parent, share);
        const float angle = radians(mix(rule.angle_low_deg, rule.angle_high_deg, t) + draws_.around(0, 8));
        const SinCos b = sin_cos(angle), a = sin_cos(turn);
        const V3 side = beside(V3(a.cos, a.sin, 0), spot.direction);
        const V3 direction = unit(spot.direction * b.cos + side * b.sin);
        const float room = outline_.room(spot.position, direction, height_);
        float length = room * mix(rule.length_low, rule.length_high, t) * (1 - rule.vary * draws_.share());
        if (t < 0.75f && length < 0.004f * height_) continue;
        // The top is no spike: the last branches may leave the outline a little.
        length = std::max(length, t < 0.75f ? 0.0f : 0.025f * height_);
        // Above the leader's end the stem is but one of the branches: they are as thick as it.
        const float thick = t > form_.leader ? 0.9f : rule.thick;
        grow_branch({stem, share}, spot, direction, length, 1, std::min(spot.radius * thick, limb_radius(length)),
                    rule);
      }
    }
  }

  // A branch of so much length is about so thick.
  float limb_radius(float length) const { return 0.006f + 0.016f * length; }

  struct Attachment {
    int parent;
    float share;
  };

  void grow_branch(const Attachment& at, const Spot& spot, const V3& direction, float length, int order, float radius,
                   const Branches& rule) {
    Way way;
    way.from = spot.position;
    way.direction = direction;
    way.length = length;
    way.steps = order == 1 ? 12 : order == 2 ? 6 : 3;
    way.rise = rule.rise;
    way.tip_rise = rule.tip_rise;
    way.crook = rule.crook;
    way.radius = std::max(radius, least_twig_m);
    way.tip_radius = std::max(least_twig_m, radius * 0.15f);
    const int index = add_axis(way, order);
    Axis& grown = skeleton_.axes[static_cast<std::size_t>(index)];
    grown.leafed_from = leafed_from(order);
    grown.parent = at.parent;
    grown.parent_share = at.share;
    if (order >= form_.orders) return;
    grow_children(index, order + 1, radius);
  }

  void grow_children(int parent_index, int order, float parent_radius) {
    const Branches& rule = form_.branches[static_cast<std::size_t>(order) - 1];
    const Axis parent = skeleton_.axes[static_cast<std::size_t>(parent_index)];
    // The longest parent has `count` of them; the shorter, the fewer.
    const float longest = order == 2 ? radius_ : radius_ * 0.5f;
    const float wanted = static_cast<float>(rule.count) * power(std::min(1.3f, parent.length / longest), 0.75f);
    const int count = std::max(order == 2 ? 3 : 2, static_cast<int>(wanted + draws_.share()));
    float roll = draws_.between(0, 2 * pi);
    int left = draws_.share() < 0.5f ? 1 : -1;
    for (int i = 0; i < count; ++i) {
      const float t = (static_cast<float>(i) + draws_.between(0.15f, 0.85f)) / static_cast<float>(count);
      const float share = mix(rule.bare_share, 0.98f, t);
      const Spot spot = spot_at(skeleton_, parent, share);
      roll += golden_angle;
      left = -left;
      // Left and right of the parent in its flat plane, or anywhere around it.
      const V3 flat = beside(V3(0, 0, 1).cross(spot.direction), spot.direction) * static_cast<float>(left);
      const SinCos a = sin_cos(roll);
      const V3 u = across(spot.direction), v = spot.direction.cross(u);
      const V3 round = u * a.cos + v * a.sin;
      const V3 side = beside(mix(round, flat, rule.planar), spot.direction);
      const float angle = radians(mix(rule.angle_low_deg, rule.angle_high_deg, t) + draws_.around(0, 10));
      const SinCos b = sin_cos(angle);
      const V3 direction = unit(spot.direction * b.cos + side * b.sin);
      float length = parent.length * mix(rule.length_low, rule.length_high, t) * (1 - rule.vary * draws_.share());
      length = std::min(length, std::max(0.25f * length, outline_.room(spot.position, direction, length)));
      grow_branch({parent_index, share}, spot, direction, length, order,
                  std::min({spot.radius * rule.thick, parent_radius, limb_radius(length)}), rule);
    }
  }

  const Form& form_;
  float height_;
  Draws draws_;
  Outline outline_;
  float radius_;
  Skeleton skeleton_;
};

}  // namespace

Spot spot_at(const Skeleton& skeleton, const Axis& axis, float share) {
  const float at = clamp01(share) * static_cast<float>(axis.count - 1);
  const auto i = std::min(static_cast<std::uint32_t>(at), axis.count - 2);
  const Node &a = skeleton.nodes[axis.first + i], &b = skeleton.nodes[axis.first + i + 1];
  const float t = at - static_cast<float>(i);
  return {mix(a.position, b.position, t), unit(b.position - a.position), mix(a.radius, b.radius, t)};
}

Outline::Outline(const Form& form, float height_m, float radius_m, Draws& draws)
    : form_(form), height_(height_m), radius_(radius_m) {
  for (float& phase : phases_) phase = draws.between(0, 2 * pi);
}

float Outline::radius_at(float z, float azimuth_cos, float azimuth_sin) const {
  const float base = form_.crown_base * height_;
  const float t = (z - base) / (height_ - base);
  if (t >= 1 || z < 0) return 0;
  float share = form_.outline[0];
  if (t > 0) {
    const float at = t * static_cast<float>(form_.outline.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), form_.outline.size() - 2);
    share = mix(form_.outline[i], form_.outline[i + 1], at - static_cast<float>(i));
  }
  // Lobes: twice and three times around, turning with the height.
  const float c2 = azimuth_cos * azimuth_cos - azimuth_sin * azimuth_sin, s2 = 2 * azimuth_cos * azimuth_sin;
  const float c3 = c2 * azimuth_cos - s2 * azimuth_sin, s3 = s2 * azimuth_cos + c2 * azimuth_sin;
  const SinCos p = sin_cos(phases_[0] + 3 * t), q = sin_cos(phases_[1] - 5 * t), r = sin_cos(phases_[2] + 2 * t);
  const float lobes = (azimuth_cos * r.cos + azimuth_sin * r.sin) * 0.6f + (c2 * p.cos + s2 * p.sin) * 0.7f +
                      (c3 * q.cos + s3 * q.sin) * 0.7f;
  return radius_ * share * (1 + form_.ragged * (lobes - 0.6f));
}

bool Outline::inside(const V3& p) const {
  const float r = std::sqrt(p.x * p.x + p.y * p.y);
  const float c = r > 1e-6f ? p.x / r : 1, s = r > 1e-6f ? p.y / r : 0;
  return r <= radius_at(p.z, c, s);
}

float Outline::room(const V3& from, const V3& direction, float most) const {
  constexpr int steps = 40;
  const float end = std::min(most, 2 * radius_ + height_);
  float last = 0;
  bool been_inside = false;
  for (int i = 1; i <= steps; ++i) {
    // Steps grow, so that short ways near the outline are found as well as long ones.
    const float s = end * static_cast<float>(i * i) / static_cast<float>(steps * steps);
    const bool is_inside = inside(from + direction * s);
    if (!is_inside && (been_inside || i > 3)) return last;
    been_inside = been_inside || is_inside;
    last = s;
  }
  return end;
}

Skeleton grow_skeleton(const Form& form, float height_m, float radius_m, std::uint64_t seed) {
  return Grower(form, height_m, radius_m, seed).grow();
}

}  // namespace assets::grown
