#include "silvasim/tiles/region.h"

#include <algorithm>

namespace silvasim::tiles {

void Region::add(const base::Box& box) {
  if (box.empty()) return;
  boxes_.push_back(box);
  bounds_ = {std::min(bounds_.west, box.west), std::min(bounds_.south, box.south), std::max(bounds_.east, box.east),
             std::max(bounds_.north, box.north)};
  area_ += box.width() * box.height();
}

base::Point Region::draw(base::Stream& random) const {
  double left = random.next_double() * area_;
  std::size_t i = 0;
  for (; i + 1 < boxes_.size(); ++i) {
    const double area = boxes_[i].width() * boxes_[i].height();
    if (left < area) break;
    left -= area;
  }
  const base::Box& box = boxes_[i];
  const double x = box.west + random.next_double() * box.width();
  return {x, box.south + random.next_double() * box.height()};
}

bool Region::contains(base::Point point) const {
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const base::Box& box) {
    return point.x >= box.west && point.x < box.east && point.y >= box.south && point.y < box.north;
  });
}

}  // namespace silvasim::tiles
