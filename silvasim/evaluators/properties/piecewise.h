// A piecewise linear function through given points, constant outside of them. Trapezoids, tables and gradients are made of it.
#pragma once

#include <memory>
#include <vector>

#include "silvasim/evaluators/response.h"

namespace silvasim::evaluators {

struct CurvePoint {
  float x = 0;
  float y = 0;
};

class PiecewiseLinear final : public Response {
 public:
  // Points ascending in x; equal x make a step, at which the later point holds. One point at least.
  explicit PiecewiseLinear(const std::vector<CurvePoint>& points);

  void apply(const float* x, float* y, std::size_t count) const override;

 private:
  struct Segment {
    float start, reciprocal_width, y, rise;
  };
  float before_;
  float last_x_, after_;
  std::vector<Segment> segments_;
};

// As above through many points: finds the segment by a table of buckets instead of trying each.
class SampledCurve final : public Response {
 public:
  explicit SampledCurve(std::vector<CurvePoint> points);

  void apply(const float* x, float* y, std::size_t count) const override;

 private:
  std::vector<CurvePoint> points_;
  std::vector<int> first_;  // a bucket: the last point at or before its start
  float start_ = 0, buckets_per_unit_ = 0;
};

// As above through equally spaced points, which need no search: three times as fast.
class EvenCurve final : public Response {
 public:
  // y: at `start`, then every 1 / `pieces_per_unit`, up to `last`. Two points at least.
  EvenCurve(float start, float last, const std::vector<float>& y);

  void apply(const float* x, float* y, std::size_t count) const override;

 private:
  float start_, last_, pieces_per_unit_, after_;
  std::vector<float> y_, rise_;
};

// A curve that is drawn through many points: an EvenCurve where that is off by less than 0.0001 anywhere, else a SampledCurve.
std::unique_ptr<Response> smooth_curve(std::vector<CurvePoint> points);

}  // namespace silvasim::evaluators
