// The wood of a plant as lines: stems and branches with their radii, and the crown's outline that they fill.
#pragma once

#include <cstdint>
#include <vector>

#include "assets/grown/draws.h"
#include "assets/grown/form.h"

namespace assets::grown {

struct Node {
  V3 position;
  float radius = 0;
};

struct Axis {
  std::uint32_t first = 0;  // its nodes
  std::uint32_t count = 0;  // two at least
  int order = 0;            // 0: stem
  int parent = -1;          // the axis that it stands on, none for stems
  float parent_share = 0;   // and where there
  float length = 0;
  float leafed_from = 2;  // share of its length from which it bears leaves; above 1: none
};

struct Skeleton {
  std::vector<Node> nodes;
  std::vector<Axis> axes;  // a parent before its children, a limb's children together: neighbours in space
};

// A place on an axis.
struct Spot {
  V3 position, direction;
  float radius = 0;
};
Spot spot_at(const Skeleton& skeleton, const Axis& axis, float share);

// The radius that the crown may have at a height and azimuth. Below the crown's base it narrows to the stem.
class Outline {
 public:
  Outline(const Form& form, float height_m, float radius_m, Draws& draws);
  float radius_at(float z, float azimuth_cos, float azimuth_sin) const;
  bool inside(const V3& p) const;
  // How far a straight way from `from` stays inside, at most `most`.
  float room(const V3& from, const V3& direction, float most) const;

 private:
  const Form& form_;
  float height_, radius_;
  std::array<float, 4> phases_;
};

Skeleton grow_skeleton(const Form& form, float height_m, float radius_m, std::uint64_t seed);

}  // namespace assets::grown
