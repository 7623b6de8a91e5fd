// Responses against their formulas (docs/reading.md, B3).
#include <gtest/gtest.h>

#include <cmath>

#include "silvasim/evaluators/evaluator.h"
#include "silvasim/evaluators/properties/piecewise.h"
#include "tests/unit/config/files.h"

namespace silvasim::evaluators {
namespace {

// The response that an element makes, over some values.
std::vector<float> respond_to(const std::string& element, const std::vector<float>& x) {
  config::Files files;
  files.add("ecosystem.xml", "<ecosystem><RadiusEvaluator/></ecosystem>")
      .add("plants.xml", "<plants><plant name=\"p\"><property name=\"q\">" + element + "</property></plant></plants>");
  const config::Scenario scenario = files.load();
  std::vector<base::Diagnostic> errors;
  const auto response = make_response(scenario.layers[0].species[0].properties[0].response, errors);
  for (const auto& error : errors) ADD_FAILURE() << base::to_string(error);
  std::vector<float> y(x.size(), -7);
  if (response) response->apply(x.data(), y.data(), x.size());
  return y;
}

using Floats = std::vector<float>;

TEST(Properties, MinMaxIncludesItsEnds) {
  EXPECT_EQ(respond_to("<MinMax min=\"0.25\" max=\"0.5\"/>", {0.2499f, 0.25f, 0.3f, 0.5f, 0.5001f}),
            (Floats{0, 1, 1, 1, 0}));
}

TEST(Properties, TrapezoidIsExactAtItsCorners) {
  EXPECT_EQ(respond_to("<Trapezoid a=\"1\" b=\"3\" c=\"7\" d=\"11\"/>", {0, 1, 2, 3, 5, 7, 8, 11, 12}),
            (Floats{0, 0, 0.5f, 1, 1, 1, 0.75f, 0, 0}));
}

TEST(Properties, TrapezoidWithUprightSides) {
  EXPECT_EQ(respond_to("<Trapezoid a=\"1\" b=\"1\" c=\"2\" d=\"2\"/>", {0.5f, 1, 1.5f, 2.5f}), (Floats{0, 1, 1, 0}));
}

TEST(Properties, TableIsConstantOutsideAndStepsWhereXRepeats) {
  EXPECT_EQ(respond_to("<Table><point x=\"0\" y=\"0.5\"/><point x=\"1\" y=\"1\"/><point x=\"1\" y=\"0\"/><point "
                       "x=\"3\" y=\"0.5\"/></Table>",
                       {-5, 0, 0.5f, 1, 2, 3, 9}),
            (Floats{0.5f, 0.5f, 0.75f, 0, 0.25f, 0.5f, 0.5f}));
}

TEST(Properties, GaussFollowsItsFormula) {
  Floats x;
  for (int i = -400; i <= 400; ++i) x.push_back(static_cast<float>(i) / 40);
  const Floats y = respond_to("<Gauss mean=\"2\" deviation=\"1.5\"/>", x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off = static_cast<double>(x[i]) - 2;
    EXPECT_NEAR(y[i], std::exp(-off * off / (2 * 1.5 * 1.5)), 4e-7) << x[i];
  }
}

TEST(Properties, BezierOnTheDiagonalIsTheIdentity) {
  Floats x;
  for (int i = 0; i <= 1000; ++i) x.push_back(static_cast<float>(i) / 1000);
  const Floats y = respond_to(
      "<Bezier><point x=\"0\" y=\"0\"/><point x=\"0.25\" y=\"0.25\"/><point x=\"0.9\" y=\"0.9\"/><point x=\"1\" "
      "y=\"1\"/></Bezier>",
      x);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(y[i], x[i], 1e-6);
}

// Against the curve itself: solve x(t) = x by bisection in double.
TEST(Properties, BezierAgreesWithItsCurve) {
  const double px[] = {0, 0.1, 0.2, 1}, py[] = {0, 1, 0, 0.7};
  const auto cubic = [](const double* p, double t) {
    const double s = 1 - t;
    return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
  };
  Floats x;
  for (int i = 0; i <= 997; ++i) x.push_back(static_cast<float>(i) / 997);
  const Floats y = respond_to(
      "<Bezier><point x=\"0\" y=\"0\"/><point x=\"0.1\" y=\"1\"/><point x=\"0.2\" y=\"0\"/><point x=\"1\" "
      "y=\"0.7\"/></Bezier>",
      x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k)
      (cubic(px, (low + high) / 2) < static_cast<double>(x[i]) ? low : high) = (low + high) / 2;
    EXPECT_NEAR(y[i], cubic(py, low), 2e-4) << x[i];
  }
}

TEST(Properties, ClassesAnswerByCode) {
  EXPECT_EQ(respond_to(
                "<Classes otherwise=\"0.1\"><class code=\"5\" value=\"1\"/><class code=\"3\" value=\"0.4\"/></Classes>",
                {5, 3, 4, 0}),
            (Floats{1, 0.4f, 0.1f, 0.1f}));
}

// The two ways to a piecewise linear curve agree, over random points and values.
TEST(Properties, SampledCurveEqualsPiecewiseLinear) {
  std::uint32_t state = 12345;
  const auto next = [&] { return static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f; };
  for (int round = 0; round < 200; ++round) {
    std::vector<CurvePoint> points;
    float x = -3;
    for (int i = 0; i < 2 + round % 40; ++i) {
      points.push_back({x, next()});
      x += next() < 0.2f ? 0.0f : next();
    }
    Floats xs, a(500), b(500);
    for (int i = 0; i < 500; ++i) xs.push_back(-4 + (x + 6) * next());
    for (std::size_t i = 0; i < points.size() && i < 400; ++i) xs[i] = points[i].x;
    PiecewiseLinear(points).apply(xs.data(), a.data(), xs.size());
    SampledCurve(points).apply(xs.data(), b.data(), xs.size());
    for (std::size_t i = 0; i < xs.size(); ++i) ASSERT_NEAR(a[i], b[i], 2e-6) << "round " << round << " x " << xs[i];
  }
}

}  // namespace
}  // namespace silvasim::evaluators
