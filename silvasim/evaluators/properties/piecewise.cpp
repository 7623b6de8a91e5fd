#include "silvasim/evaluators/properties/piecewise.h"

#include <algorithm>
#include <cmath>

#include "silvasim/base/vector_clones.h"

namespace silvasim::evaluators {

namespace {

struct Line {
  float start, reciprocal_width, y, rise;
};

SILVA_VECTOR_CLONES void draw(Line line, const float* x, float* y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float t = (x[i] - line.start) * line.reciprocal_width;
    const float inside = line.y + (t < 1.0f ? t : 1.0f) * line.rise;
    y[i] = x[i] >= line.start ? inside : y[i];
  }
}

SILVA_VECTOR_CLONES void level_from(float start, float level, const float* x, float* y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) y[i] = x[i] >= start ? level : y[i];
}

struct Even {
  float start, pieces_per_unit, pieces;
  const float *y, *rise;
};

SILVA_VECTOR_CLONES void look_up(Even even, const float* x, float* y, std::size_t count) {
  const int last = static_cast<int>(even.pieces) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const float along = (x[i] - even.start) * even.pieces_per_unit;
    const float above = along > 0.0f ? along : 0.0f;
    const float bound = above < even.pieces ? above : even.pieces;
    const int whole = static_cast<int>(bound);
    const int k = whole < last ? whole : last;
    y[i] = even.y[k] + (bound - static_cast<float>(k)) * even.rise[k];
  }
}

}  // namespace

PiecewiseLinear::PiecewiseLinear(const std::vector<CurvePoint>& points)
    : before_(points.front().y), last_x_(points.back().x), after_(points.back().y) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const float width = points[i + 1].x - points[i].x;
    if (!(width > 0)) continue;
    segments_.push_back({points[i].x, 1.0f / width, points[i].y, points[i + 1].y - points[i].y});
  }
}

void PiecewiseLinear::apply(const float* x, float* y, std::size_t count) const {
  std::fill_n(y, count, before_);
  // Segment by segment over the whole block, so that each loop is a plain one that vectorises; later segments overwrite.
  for (const Segment& segment : segments_) {
    draw({segment.start, segment.reciprocal_width, segment.y, segment.rise}, x, y, count);
  }
  level_from(last_x_, after_, x, y, count);
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

EvenCurve::EvenCurve(float start, float last, const std::vector<float>& y)
    : start_(start),
      last_(last),
      pieces_per_unit_(static_cast<float>(y.size() - 1) / (last - start)),
      after_(y.back()),
      y_(y.begin(), y.end() - 1) {
  for (std::size_t k = 0; k + 1 < y.size(); ++k) rise_.push_back(y[k + 1] - y[k]);
}

void EvenCurve::apply(const float* x, float* y, std::size_t count) const {
  look_up({start_, pieces_per_unit_, static_cast<float>(y_.size()), y_.data(), rise_.data()}, x, y, count);
  level_from(last_, after_, x, y, count);
}

std::unique_ptr<Response> smooth_curve(std::vector<CurvePoint> points) {
  constexpr std::size_t pieces = 1024;
  constexpr float allowed = 1e-4f;
  const float start = points.front().x, last = points.back().x;
  auto searched = std::make_unique<SampledCurve>(points);
  if (!(last > start)) return searched;
  std::vector<float> x(pieces + 1), y(pieces + 1);
  for (std::size_t k = 0; k <= pieces; ++k) {
    x[k] = start + (last - start) * (static_cast<float>(k) / static_cast<float>(pieces));
  }
  searched->apply(x.data(), y.data(), x.size());
  auto even = std::make_unique<EvenCurve>(start, last, y);
  // Both are straight between their points, and equal at the even ones: they differ most at the others.
  for (const CurvePoint& point : points) {
    float here = 0, there = 0;
    even->apply(&point.x, &here, 1);
    searched->apply(&point.x, &there, 1);
    if (!(std::fabs(here - there) < allowed)) return searched;
  }
  return even;
}

}  // namespace silvasim::evaluators
