// Functions on rays and on bundles of rays against their values at points.
#include "relief/cast/ray_forms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relief/cast/ray_paths.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

struct Case {
  RayAxes axes;
  Tangents tangents;
  double s0 = 0;
  double s1 = 0;
};

Case random_case(samples::Random& random) {
  const glm::dvec3 forward = random.direction();
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.1, 0.2, 1)));
  const double size = std::pow(10.0, random.in(-4.0, 0.0));
  const double x = random.in(-1.0, 1.0);
  const double y = random.in(-1.0, 1.0);
  const double s0 = random.in(0.0, 10.0);
  return {{random.in_box(10), right, glm::cross(right, forward), forward},
          {x, x + size, y, y + size * random.in(0.0, 1.0)},
          s0,
          s0 + std::pow(10.0, random.in(-3.0, 1.0))};
}

glm::dvec3 point(const Case& c, double x, double y, double s) {
  return c.axes.origin_m + s * (x * c.axes.right + y * c.axes.up + c.axes.forward);
}

Quadratic random_quadratic(samples::Random& random) {
  Quadratic f;
  f.centre_m = random.in_box(3);
  f.linear = random.in_box(2);
  f.constant = random.in(-2.0, 2.0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) f.matrix[i][j] = f.matrix[j][i] = random.in(-1.0, 1.0);
  return f;
}

TEST(ReliefRayForms, BundlesHoldTheValuesOfTheirPoints) {
  samples::Random random(52);
  for (int n = 0; n < 1000; ++n) {
    const Case c = random_case(random);
    const Linear line{random.direction(), random.in(-3.0, 3.0)};
    const Quadratic curve = random_quadratic(random);
    const Interval lines = LinearForm(line, c.axes).bundle(c.tangents).over(c.s0, c.s1);
    const Interval curves = QuadraticForm(curve, c.axes).bundle(c.tangents).over(c.s0, c.s1);
    for (int m = 0; m < 20; ++m) {
      const glm::dvec3 p = point(c, random.in(c.tangents.x0, c.tangents.x1),
                                 random.in(c.tangents.y0, c.tangents.y1), random.in(c.s0, c.s1));
      EXPECT_TRUE(holds(lines, line.at(p)));
      EXPECT_TRUE(holds(curves, curve.value(p)));
    }
  }
}

TEST(ReliefRayForms, ABundleOfOneRayIsExact) {
  samples::Random random(53);
  for (int n = 0; n < 500; ++n) {
    Case c = random_case(random);
    c.tangents.x1 = c.tangents.x0;
    c.tangents.y1 = c.tangents.y0;
    const Quadratic curve = random_quadratic(random);
    const QuadraticForm form(curve, c.axes);
    const Interval found = form.bundle(c.tangents).over(c.s0, c.s0);
    const double value = curve.value(point(c, c.tangents.x0, c.tangents.y0, c.s0));
    EXPECT_LT(width(found), 1e-11);
    EXPECT_NEAR(middle(found), value, 1e-11);
    EXPECT_NEAR(form.ray(c.tangents.x0, c.tangents.y0).at(c.s1),
                curve.value(point(c, c.tangents.x0, c.tangents.y0, c.s1)), 1e-10);
  }
}

TEST(ReliefRayForms, HalvesLieBetweenTheEnds) {
  for (const auto& [a, b] :
       {std::pair{0.0, 1e15}, std::pair{1.0, 1e15}, std::pair{1.0, 3.0}, std::pair{0.0, 1e-9}}) {
    EXPECT_GT(split(a, b), a);
    EXPECT_LT(split(a, b), b);
  }
  EXPECT_EQ(split(2, 4), 3);
  EXPECT_NEAR(split(1, 100), 10, 1e-14);
}

TEST(ReliefRayForms, PathsAreThoseOfTheirPoints) {
  samples::Random random(54);
  const Base base = Base::ellipsoid({1, 2, 3}, {5, 4, 3});
  const Chart chart = Chart::cube_face({1, 2, 3}, mars::Face::kPlusZ, 4);
  for (int n = 0; n < 300; ++n) {
    const Ray ray{glm::dvec3(1, 2, 9) + random.in_box(1), random.direction()};
    const double s0 = random.in(0.0, 1.0);
    const double s1 = s0 + random.in(0.0, 1.0);
    const HeightOnRay height(base, ray);
    const LinearOnRay w = on_ray(chart.w(), ray);
    const CoordinateOnRay x(on_ray(chart.x(), ray), w, 0.5, 2);
    const Interval heights = height.over(s0, s1);
    const Interval slopes = height.slope(s0, s1);
    for (int m = 0; m <= 10; ++m) {
      const double s = s0 + (s1 - s0) * m / 10;
      const glm::dvec3 p = moved(ray, s).origin_m;
      EXPECT_NEAR(height.value(s), base.height_m(p), 1e-13);
      EXPECT_TRUE(holds(heights, base.height_m(p)));
      EXPECT_TRUE(holds(widened(slopes, 1e-12), glm::dot(base.gradient(p), ray.direction)));
      EXPECT_NEAR(x.at(s), (chart.at(p).x - 0.5) / 2, 1e-13 + x.rounding(s0, s1));
      EXPECT_NEAR(x.rate(s), glm::dot(chart.gradients(p)[0], ray.direction) / 2, 1e-12);
      EXPECT_NEAR(x.where(x.at(s)), s, 1e-9 / std::max(1e-3, std::abs(x.rate(s))));
    }
  }
}

}  // namespace
}  // namespace relief
