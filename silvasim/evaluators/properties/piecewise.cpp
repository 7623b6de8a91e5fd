#include "silvasim/evaluators/properties/piecewise.h"

#include <algorithm>

namespace silvasim::evaluators {

PiecewiseLinear::PiecewiseLinear(const std::vector<CurvePoint>& points)
    : before_(points.front().y), last_x_(points.back().x), after_(points.back().y) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const float width = points[i + 1].x - points[i].x;
    if (!(width > 0)) continue;
    segments_.push_back({points[i].x, 1.0f / width, points[i].y, points[i + 1].y - points[i].y});
  }
}

void PiecewiseLinear::apply(const float* x, float* y, std::size_t count) const {
  const float before = before_, last_x = last_x_, after = after_;
  for (std::size_t i = 0; i < count; ++i) y[i] = before;
  // Segment by segment over the whole block, so that each loop is a plain one that vectorises; later segments overwrite.
  for (const Segment segment : segments_) {
    for (std::size_t i = 0; i < count; ++i) {
      const float t = (x[i] - segment.start) * segment.reciprocal_width;
      const float inside = segment.y + (t < 1.0f ? t : 1.0f) * segment.rise;
      y[i] = x[i] >= segment.start ? inside : y[i];
    }
  }
  for (std::size_t i = 0; i < count; ++i) y[i] = x[i] >= last_x ? after : y[i];
}

SampledCurve::SampledCurve(std::vector<CurvePoint> points) : points_(std::move(points)), start_(points_.front().x) {
  const float width = points_.back().x - start_;
  const std::size_t buckets = 2 * points_.size();
  buckets_per_unit_ = width > 0 ? static_cast<float>(buckets) / width : 0;
  first_.resize(buckets + 1);
  for (std::size_t b = 0; b <= buckets; ++b) {
    const float x = start_ + width * (static_cast<float>(b) / static_cast<float>(buckets));
    const auto after =
        std::upper_bound(points_.begin(), points_.end(), x, [](float v, const CurvePoint& p) { return v < p.x; });
    first_[b] = std::max(0, static_cast<int>(after - points_.begin()) - 1);
  }
}

void SampledCurve::apply(const float* x, float* y, std::size_t count) const {
  const float last_x = points_.back().x;
  const int last = static_cast<int>(points_.size()) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (x[i] < start_) {
      y[i] = points_.front().y;
      continue;
    }
    if (x[i] >= last_x) {
      y[i] = points_.back().y;
      continue;
    }
    // The bucket's start may round to just past x: step back first.
    int k = first_[static_cast<std::size_t>((x[i] - start_) * buckets_per_unit_)];
    while (k > 0 && points_[static_cast<std::size_t>(k)].x > x[i]) --k;
    while (k + 1 < last && points_[static_cast<std::size_t>(k) + 1].x <= x[i]) ++k;
    const CurvePoint a = points_[static_cast<std::size_t>(k)], b = points_[static_cast<std::size_t>(k) + 1];
    const float width = b.x - a.x;
    y[i] = width > 0 ? a.y + (x[i] - a.x) / width * (b.y - a.y) : b.y;
  }
}

}  // namespace silvasim::evaluators
