// Fitted planes, against planes that are known and the spread of many fits.
#include "vpe/explore/drawing/plane_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace vpe::explore {
namespace {

// Adds squares of 1 m, two triangles each, over x and y from 0 to `side`.
template <class Height>
PlaneFit fit_of(int side, const Height& height, bool is_clockwise = false) {
  PlaneFit fit({0, 0}, {side, side});
  const auto at = [&](int x, int y) { return glm::dvec3(x, y, height(x, y)); };
  const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    is_clockwise ? fit.add(a, c, b) : fit.add(a, b, c);
  };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      add(at(x, y), at(x + 1, y), at(x + 1, y + 1));
      add(at(x, y), at(x + 1, y + 1), at(x, y + 1));
    }
  return fit;
}

TEST(PlaneFit, PlanesComeBack) {
  test_support::Random random(20261127);
  for (int n = 0; n < 50; ++n) {
    const double azimuth_deg = random.uniform(0, 360);
    const double dip_deg = random.uniform(0.1, 80);
    const double fall = std::tan(dip_deg * mars::kRadiansPerDegree);
    const double east = std::sin(azimuth_deg * mars::kRadiansPerDegree);
    const double north = std::cos(azimuth_deg * mars::kRadiansPerDegree);
    const PlaneFit fit = fit_of(
        12, [&](int x, int y) { return 7 - fall * (east * x + north * y); }, n % 2 == 0);
    const auto plane = fit.plane();
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->dip_deg, dip_deg, 1e-9);
    EXPECT_NEAR(std::remainder(plane->dip_azimuth_deg - azimuth_deg, 360), 0, 1e-8);
    EXPECT_NEAR(std::remainder(plane->dip_azimuth_deg - plane->strike_deg, 360), 90, 1e-9);
    EXPECT_NEAR(plane->height_m, 7, 1e-9 * (1 + fall));
    EXPECT_LT(plane->residual_m, 1e-6 * (1 + fall));
    EXPECT_LT(plane->dip_error_deg.value(), 1e-6);
    EXPECT_LT(plane->strike_error_deg.value(), 1e-5);
  }
}

// Waves some ten posts long: posts are far from independent, and the stated error has to know that.
TEST(PlaneFit, StatedErrorsAreThoseOfManyFits) {
  test_support::Random random(7);
  double dip_squares = 0;
  double stated_squares = 0;
  constexpr int kFits = 300;
  for (int n = 0; n < kFits; ++n) {
    std::array<std::array<double, 4>, 24> waves{};
    for (auto& wave : waves) {
      const double angle = random.uniform(0, 2 * mars::kPi);
      const double length = random.uniform(8, 16);
      wave = {std::cos(angle) * 2 * mars::kPi / length, std::sin(angle) * 2 * mars::kPi / length,
              random.uniform(0, 2 * mars::kPi), random.uniform(0, 1)};
    }
    const auto plane = fit_of(48, [&](int x, int y) {
                         double height = 0.2 * x;
                         for (const auto& [kx, ky, phase, size] : waves)
                           height += size * std::sin(kx * x + ky * y + phase);
                         return height;
                       }).plane();
    ASSERT_TRUE(plane);
    const double off_deg = plane->dip_deg - std::atan(0.2) / mars::kRadiansPerDegree;
    dip_squares += off_deg * off_deg;
    stated_squares += plane->dip_error_deg.value() * plane->dip_error_deg.value();
    EXPECT_GT(plane->residual_m, 0.5);
  }
  const double ratio = std::sqrt(stated_squares / dip_squares);
  std::printf("dip: deviation %.4f degrees, stated %.4f\n", std::sqrt(dip_squares / kFits),
              std::sqrt(stated_squares / kFits));
  EXPECT_GT(ratio, 0.7);
  EXPECT_LT(ratio, 2.0);
}

TEST(PlaneFit, ALevelPlaneHasNoStrike) {
  const auto plane = fit_of(8, [](int, int) { return 3.0; }).plane();
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->dip_deg, 0);
  EXPECT_NEAR(plane->strike_error_deg.value(), 180, 1e-9);
}

TEST(PlaneFit, GroundWithoutALevelAreaHasNoPlane) {
  PlaneFit fit({0, 0}, {1, 1});
  EXPECT_FALSE(fit.plane());
  fit.add({0, 0, 0}, {1, 1, 0}, {1, 1, 5});  // a wall
  EXPECT_FALSE(fit.plane());
  PlaneFit one({0, 0}, {9, 9});
  one.add({0, 0, 0}, {1, 0, 1}, {0, 1, 0});
  ASSERT_TRUE(one.plane());
  EXPECT_NEAR(one.plane()->dip_deg, 45, 1e-9);
  EXPECT_NEAR(one.plane()->dip_azimuth_deg, 270, 1e-9);
  EXPECT_FALSE(one.plane()->dip_error_deg);  // a single part
}

}  // namespace
}  // namespace vpe::explore
