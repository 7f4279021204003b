#include <glm/gtc/quaternion.hpp>

#include "mars/geodesy/sphere.h"
#include "scripts/monotone_spline.h"
#include "scripts/spherical_spline.h"
#include "tests/support/support.h"

namespace scripts {
namespace {

using test_support::Random;

TEST(Tangent, LengthIsTheAngleAndFollowingItArrives) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 p = random.direction();
    const glm::dvec3 away = random.direction();
    const glm::dvec3 q = glm::normalize(p + away * random.log_uniform(1e-12, 10));
    const glm::dvec3 tangent = tangent_towards(p, q);
    const double angle_rad = mars::angle_between_rad(p, q);
    ASSERT_NEAR(glm::length(tangent), angle_rad, 1e-15 + 2e-15 * angle_rad);
    // The direction of the way to nearly opposite points is not well defined.
    ASSERT_NEAR(glm::dot(tangent, p), 0.0, 2e-15 * angle_rad / glm::length(p + q));
    ASSERT_LT(glm::length(follow(p, tangent) - q), 5e-15);
  }
}

TEST(Tangent, EqualAndOppositePointsHaveNone) {
  const glm::dvec3 p = glm::normalize(glm::dvec3(1, 2, 3));
  EXPECT_EQ(tangent_towards(p, p), glm::dvec3(0.0));
  EXPECT_EQ(follow(p, glm::dvec3(0.0)), p);
  EXPECT_LT(glm::length(tangent_towards(glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1))), 1e-15);
}

TEST(SphericalSpline, TwoKnotsAreTheGreatCircleAtConstantSpeed) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 a = random.direction();
    const glm::dvec3 b = random.direction();
    if (mars::angle_between_rad(a, b) > 3.0) continue;
    const double start_s = random.uniform(0, 100);
    const double span_s = random.log_uniform(1e-3, 1e3);
    const SphericalSpline<glm::dvec3> spline({start_s, start_s + span_s}, {a, b});
    for (int k = 0; k <= 10; ++k) {
      const double t = start_s + span_s * k / 10.0;
      const double u = (t - start_s) / (start_s + span_s - start_s);
      ASSERT_LT(glm::length(spline.at(t) - mars::slerp(a, b, u)), 4e-15);
    }
  }
}

TEST(SphericalSpline, StaysOnAGreatCircleThatHoldsItsKnots) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 a = random.direction();
    const glm::dvec3 b = mars::any_perpendicular(a);
    std::vector<double> times_s{0};
    std::vector<glm::dvec3> points{a};
    double angle_rad = 0;
    for (int k = 0; k < 6; ++k) {
      times_s.push_back(times_s.back() + random.log_uniform(0.1, 100));
      angle_rad += random.uniform(0.01, 1.5);
      points.push_back(a * std::cos(angle_rad) + b * std::sin(angle_rad));
    }
    const SphericalSpline<glm::dvec3> spline(times_s, points);
    double before_rad = 0;
    for (int k = 0; k <= 300; ++k) {
      const glm::dvec3 p = spline.at(times_s.back() * k / 300.0);
      ASSERT_NEAR(glm::dot(p, glm::cross(a, b)), 0.0, 3e-15);
      // Never turns back: the limit on the velocities keeps it monotone.
      const double ahead_rad =
          std::remainder(std::atan2(glm::dot(p, b), glm::dot(p, a)) - before_rad, 2 * mars::kPi);
      ASSERT_GE(ahead_rad, -1e-14);
      before_rad += ahead_rad;
    }
  }
}

TEST(SphericalSpline, NeverOvershoots) {
  Random random(4);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> times_s{0};
    std::vector<glm::dvec3> points{random.direction()};
    for (int k = 0; k < 5; ++k) {
      times_s.push_back(times_s.back() + random.log_uniform(0.01, 100));
      const glm::dvec3 away = random.direction();
      points.push_back(glm::normalize(points.back() + away * random.log_uniform(1e-4, 0.9)));
    }
    const SphericalSpline<glm::dvec3> spline(times_s, points);
    for (std::size_t s = 0; s + 1 < points.size(); ++s) {
      const double chord_rad = mars::angle_between_rad(points[s], points[s + 1]);
      for (int k = 1; k < 20; ++k) {
        const double t = times_s[s] + (times_s[s + 1] - times_s[s]) * k / 20.0;
        const double detour_rad = mars::angle_between_rad(points[s], spline.at(t)) +
                                  mars::angle_between_rad(spline.at(t), points[s + 1]);
        worst = std::max(worst, detour_rad / chord_rad);
      }
    }
  }
  EXPECT_LT(worst, 1.5);
  EXPECT_GT(worst, 1.01);
}

// Neighbours that are much faster or slower, in any direction, give the longest control points. Without a limit
// on them segments over 77 degrees could lead round the other side of the sphere.
TEST(SphericalSpline, LongSegmentsDoNotLeadRoundTheSphere) {
  Random random(6);
  double farthest = 0;
  double fastest = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 a = random.direction();
    const auto beside = [&](const glm::dvec3& p, double arc_rad) {
      return follow(p, glm::normalize(glm::cross(p, random.direction())) * arc_rad);
    };
    const double arc_rad = random.uniform(0.5, 3.1);
    const glm::dvec3 b = beside(a, arc_rad);
    const glm::dvec3 before = beside(a, random.uniform(0.1, 3));
    const glm::dvec3 after = beside(b, random.uniform(0.1, 3));
    const double first_s = random.log_uniform(1e-3, 1);
    const SphericalSpline<glm::dvec3> spline(
        {0, first_s, first_s + 1, first_s + 1 + random.log_uniform(1e-3, 1)}, {before, a, b, after});
    glm::dvec3 last = a;
    for (int k = 1; k <= 50; ++k) {
      const glm::dvec3 p = spline.at(first_s + k / 50.0);
      farthest = std::max(farthest, mars::angle_between_rad(a, p) / arc_rad);
      fastest = std::max(fastest, mars::angle_between_rad(last, p) * 50 / arc_rad);
      last = p;
    }
  }
  EXPECT_LE(farthest, 1.22);
  EXPECT_GT(farthest, 1.1);
  EXPECT_LE(fastest, 2.5);
}

TEST(SphericalSpline, RotatingTheKnotsRotatesTheCurve) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const double angle_rad = random.uniform(-3, 3);
    const glm::dquat turn = glm::angleAxis(angle_rad, random.direction());
    std::vector<double> times_s;
    std::vector<glm::dvec3> points, turned;
    for (int k = 0; k < 5; ++k) {
      times_s.push_back(k + random.uniform(0, 0.9));
      points.push_back(glm::normalize(glm::dvec3(1, 0, 0) + random.direction() * 0.8));
      turned.push_back(turn * points.back());
    }
    const SphericalSpline<glm::dvec3> a(times_s, points);
    const SphericalSpline<glm::dvec3> b(times_s, turned);
    for (int k = 0; k < 50; ++k) {
      const double t = random.uniform(-1, 6);
      ASSERT_LT(glm::length(turn * a.at(t) - b.at(t)), 1e-14);
    }
  }
}

TEST(MonotoneSpline, HasTheValuesOfThePublishedFormula) {
  // Slopes by hand: 0 at the start (the three-point estimate is 0), 2 * 1 * 3 / (1 + 3) = 1.5, and 4.
  const MonotoneSpline spline({0, 1, 2}, {0, 1, 4});
  EXPECT_DOUBLE_EQ(spline.at(0.5), 0.3125);
  EXPECT_DOUBLE_EQ(spline.at(1.5), 2.1875);
  EXPECT_EQ(spline.at(1), 1);
  // Uneven: slopes 1 and 1/2; weights (2 * 2 + 1, 2 + 2 * 1) = (5, 4): 9 / (5 / 1 + 4 / 0.5) = 9 / 13.
  const MonotoneSpline uneven({0, 1, 3}, {0, 1, 2});
  const double h = 1e-6;
  EXPECT_NEAR((uneven.at(1 + h) - uneven.at(1 - h)) / (2 * h), 9.0 / 13.0, 1e-6);
}

TEST(MonotoneSpline, NeverOvershootsAndIsSmooth) {
  Random random(6);
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> times_s{random.uniform(0, 5)};
    std::vector<double> values{random.uniform(-1e4, 1e4)};
    for (int k = 0; k < 7; ++k) {
      times_s.push_back(times_s.back() + random.log_uniform(0.05, 50));
      values.push_back(random.integer(0, 4) == 0 ? values.back() : random.log_uniform(1e-2, 1e7));
    }
    const MonotoneSpline spline(times_s, values);
    for (std::size_t s = 0; s + 1 < values.size(); ++s) {
      ASSERT_EQ(spline.at(times_s[s]), values[s]);
      const double span_s = times_s[s + 1] - times_s[s];
      const double sign = values[s + 1] >= values[s] ? 1.0 : -1.0;
      double before = values[s];
      for (int k = 1; k <= 40; ++k) {
        const double value = spline.at(k == 40 ? times_s[s + 1] : times_s[s] + span_s * k / 40.0);
        ASSERT_GE((value - before) * sign, -1e-15 * std::abs(values[s] - values[s + 1]) * 10);
        ASSERT_LE((value - values[s + 1]) * sign, 0.0);
        before = value;
      }
    }
    for (std::size_t s = 1; s + 1 < values.size(); ++s) {
      const double before_s = times_s[s] - times_s[s - 1];
      const double after_s = times_s[s + 1] - times_s[s];
      const double h = 1e-4 * std::min(before_s, after_s);
      const double y = values[s];
      const double left = (3 * y - 4 * spline.at(times_s[s] - h) + spline.at(times_s[s] - 2 * h)) / (2 * h);
      const double right = (-3 * y + 4 * spline.at(times_s[s] + h) - spline.at(times_s[s] + 2 * h)) / (2 * h);
      const double scale = std::abs(y - values[s - 1]) / before_s + std::abs(values[s + 1] - y) / after_s;
      ASSERT_NEAR(left, right, 1e-5 * scale + 1e-14 * std::abs(y) / h);
    }
  }
}

TEST(MonotoneSpline, IsExactOnLinesAndHoldsOutside) {
  const MonotoneSpline line({0, 1, 4, 6}, {2, 4, 10, 14});
  for (double t = 0; t <= 6; t += 0.125) EXPECT_NEAR(line.at(t), 2 + 2 * t, 4e-15 * 14);
  EXPECT_EQ(line.at(-1), 2);
  EXPECT_EQ(line.at(1e9), 14);
  EXPECT_EQ(line.at(std::nan("")), 2);
  EXPECT_EQ(MonotoneSpline({3}, {7}).at(5), 7);
  const MonotoneSpline two({1, 3}, {0, 1});
  EXPECT_DOUBLE_EQ(two.at(1.5), 0.25);
}

}  // namespace
}  // namespace scripts
