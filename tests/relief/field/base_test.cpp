// Heights above bases, their gradients and their bounds.
#include "relief/field/base.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "relief/field/interval_algebra.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

Quadratic bowl(double radius_m) {
  Quadratic f;
  f.matrix[0][0] = f.matrix[1][1] = -1 / (2 * radius_m);
  f.linear = {0, 0, 0.5};
  return f;  // z - (x^2 + y^2) / (2 radius)
}

std::vector<Base> all_bases() {
  const glm::dvec3 x = glm::normalize(glm::dvec3(1, 2, 3));
  const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(0, 0, 1)));
  return {Base::plane({1, 2, 3}, {1, -2, 2}), Base::sphere({3, -1, 2}, 5),
          Base::ellipsoid({1, 1, 0}, {6, 4, 3}, glm::dmat3(x, y, glm::cross(x, y))),
          Base::quadric(bowl(4), {1, 2, 1})};
}

TEST(ReliefBase, HeightsAreThoseOfClosedForms) {
  EXPECT_NEAR(Base::plane({1, 2, 3}, {0, 0, 7}).height_m({9, 9, 5}), 2, 1e-15);
  EXPECT_NEAR(Base::sphere({1, 0, 0}, 5).height_m({1, 6, 8}), 5, 1e-14);
  // On its axes an ellipsoid's heights are differences of lengths.
  const Base egg = Base::ellipsoid({0, 0, 0}, {6, 4, 3});
  EXPECT_NEAR(egg.height_m({7, 0, 0}), 1, 1e-14);
  EXPECT_NEAR(egg.height_m({0, -3.5, 0}), -0.5, 1e-14);
  // The way from the surface on the ray from the centre.
  const glm::dvec3 at = glm::normalize(glm::dvec3(1, 1, 1));
  const double reach = 1 / std::sqrt((1 / 36.0 + 1 / 16.0 + 1 / 9.0) / 3);
  EXPECT_NEAR(egg.height_m((reach + 2) * at), 2, 1e-14);
  EXPECT_NEAR(Base::quadric(bowl(4), {0, 0, 0}).height_m({2, 2, 3}), 2, 1e-15);
}

TEST(ReliefBase, AQuadricIsScaledToMetresAtItsAnchor) {
  Quadratic ball;  // 10 (|p|^2 - 25)
  ball.matrix = glm::dmat3(10.0);
  ball.constant = -250;
  const Base base = Base::quadric(ball, {3, 0, 4});
  EXPECT_NEAR(glm::length(base.gradient({3, 0, 4})), 1, 1e-15);
  const double h = 1e-5;
  EXPECT_NEAR(base.height_m(glm::dvec3(3, 0, 4) * (1 + h / 5)), h, h * h);
}

TEST(ReliefBase, ASphereOfMarsKeepsMillimetres) {
  const Base base = Base::sphere({0, 0, 0}, 3396190);
  const glm::dvec3 d = glm::normalize(glm::dvec3(1, -2, 0.3));
  EXPECT_NEAR(base.height_m(d * 3396190.001), 0.001, 4e-9);
}

TEST(ReliefBase, GradientsAreThoseOfDifferences) {
  samples::Random random(2);
  const double h = 1e-5;
  for (const Base& base : all_bases()) {
    for (int n = 0; n < 200; ++n) {
      const glm::dvec3 p = random.in_box(10);
      if (base.kind() != Base::Kind::kPlane && glm::length(p - base.centre_m()) < 1) continue;
      const glm::dvec3 found = base.gradient(p);
      for (int k = 0; k < 3; ++k) {
        glm::dvec3 step{0, 0, 0};
        step[k] = h;
        EXPECT_NEAR(found[k], (base.height_m(p + step) - base.height_m(p - step)) / (2 * h), 1e-7);
      }
    }
  }
  EXPECT_EQ(Base::sphere({0, 0, 0}, 1).gradient({0, 0, 0}), glm::dvec3(0, 0, 0));
}

TEST(ReliefBase, BoundsHoldTheHeightsOfABox) {
  samples::Random random(3);
  for (const Base& base : all_bases()) {
    for (int n = 0; n < 500; ++n) {
      const glm::dvec3 low = random.in_box(10);
      const double size = std::pow(10.0, random.in(-6.0, 1.0));
      const glm::dvec3 half = glm::dvec3(random.in(0.0, size), random.in(0.0, size), random.in(0.0, size));
      const Interval found = base.bounds_m({low, low + half});
      for (int m = 0; m < 20; ++m) {
        const glm::dvec3 p =
            low + half * glm::dvec3(random.in(0.0, 1.0), random.in(0.0, 1.0), random.in(0.0, 1.0));
        if (base.kind() == Base::Kind::kEllipsoid && glm::length(p - base.centre_m()) < 1e-5) continue;
        EXPECT_TRUE(holds(found, base.height_m(p))) << static_cast<int>(base.kind()) << " " << size;
      }
    }
  }
}

TEST(ReliefBase, BoundsOfASmallBoxAreTight) {
  for (const Base& base : all_bases()) {
    const glm::dvec3 p{7, -5, 4};
    const double size = 1e-3;
    const Interval found = base.bounds_m({p - 0.5 * size, p + 0.5 * size});
    const glm::dvec3 slope = glm::abs(base.gradient(p));
    const double first_order = size * (slope.x + slope.y + slope.z);
    // An ellipsoid's height is a product of two bounded factors.
    const double allowed = base.kind() == Base::Kind::kEllipsoid ? 3 * first_order : first_order + 1e-6;
    EXPECT_LE(width(found), allowed) << static_cast<int>(base.kind());
  }
}

TEST(ReliefBase, SlopesAlongARayHoldThoseOfDifferences) {
  samples::Random random(4);
  for (const Base& base : all_bases()) {
    for (int n = 0; n < 500; ++n) {
      const glm::dvec3 from = random.in_box(10);
      const glm::dvec3 d = random.direction();
      const double length = std::pow(10.0, random.in(-3.0, 1.0));
      const auto along = [&](double s) {
        const glm::dvec3 p = from + s * d;
        return Base::Along{base.first().value(p), 0.5 * glm::dot(base.first().gradient(p), d),
                           base.second().value(p), 0.5 * glm::dot(base.second().gradient(p), d)};
      };
      const Interval found = base.slope_of(along(0), along(length), length);
      for (int m = 0; m <= 10; ++m) {
        const glm::dvec3 p = from + (length * m / 10) * d;
        if (base.kind() == Base::Kind::kEllipsoid && glm::length(p - base.centre_m()) < 1e-3) continue;
        const double slope = glm::dot(base.gradient(p), d);
        EXPECT_NEAR(base.slope_of(along(length * m / 10)), slope, 1e-9 * (1 + std::abs(slope)));
        EXPECT_TRUE(holds(widened(found, 1e-9 * (1 + std::abs(slope))), slope))
            << static_cast<int>(base.kind());
      }
    }
  }
}

TEST(ReliefBase, BadNumbersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Base::plane({0, 0, 0}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(Base::plane({nan, 0, 0}, {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(Base::sphere({0, 0, 0}, -1), std::invalid_argument);
  EXPECT_THROW(Base::sphere({0, 0, 0}, nan), std::invalid_argument);
  EXPECT_THROW(Base::ellipsoid({0, 0, 0}, {1, 0, 1}), std::invalid_argument);
  EXPECT_THROW(Base::ellipsoid({0, 0, 0}, {1, 1, 1}, glm::dmat3(2.0)), std::invalid_argument);
  EXPECT_THROW(Base::quadric({}, {0, 0, 0}), std::invalid_argument);
  Quadratic skew = bowl(1);
  skew.matrix[0][1] = 1;
  EXPECT_THROW(Base::quadric(skew, {0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace relief
