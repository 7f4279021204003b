// Residuals of control points against polynomials whose deviations are known.
#include "mars/raster/placement/control_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mars/raster/placement/memory_file.h"
#include "mars/raster/placement/placement_options.h"
#include "tests/support/support.h"

namespace {

using mars::ControlPoint;

std::vector<ControlPoint> grid(int side, const auto& pixel_of) {
  std::vector<ControlPoint> points;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const glm::dvec2 ground(137 + 0.1 * column, -5 + 0.07 * row);
      points.push_back({pixel_of(ground), ground, std::to_string(points.size())});
    }
  }
  return points;
}

glm::dvec2 cubic(const glm::dvec2& g) {
  const glm::dvec2 d = g - glm::dvec2(137.2, -4.9);
  return {500 + 900 * d.x + 40 * d.y + 300 * d.x * d.x * d.x, 400 - 800 * d.y + 100 * d.x * d.y * d.y};
}

TEST(ControlFit, TermsOfEachOrder) {
  EXPECT_EQ(mars::polynomial_terms(1), 3U);
  EXPECT_EQ(mars::polynomial_terms(2), 6U);
  EXPECT_EQ(mars::polynomial_terms(3), 10U);
}

TEST(ControlFit, APolynomialOfTheOrderFitsExactly) {
  const auto points = grid(5, cubic);
  const auto third = mars::check_polynomial(points, 3);
  ASSERT_TRUE(third.has_value());
  EXPECT_NEAR(third->fitted.largest_px, 0, 1e-9);
  ASSERT_TRUE(third->left_out.has_value());
  EXPECT_NEAR(third->left_out->largest_px, 0, 1e-8);
  const auto second = mars::check_polynomial(points, 2);
  ASSERT_TRUE(second.has_value());
  EXPECT_GT(second->fitted.rms_px, 0.1);
}

TEST(ControlFit, AlternatingCornersAreWhatAnAffineMapLeaves) {
  std::vector<ControlPoint> points = grid(2, [](const glm::dvec2& g) { return 1000.0 * g; });
  for (std::size_t i = 0; i < 4; ++i) points[i].pixel.x += i == 0 || i == 3 ? 2 : -2;
  const auto check = mars::check_polynomial(points, 1);
  ASSERT_TRUE(check.has_value());
  EXPECT_NEAR(check->fitted.rms_px, 2, 1e-9);
  EXPECT_NEAR(check->fitted.largest_px, 2, 1e-9);
  // Three points fix an affine map; the fourth then lies off by all four deviations.
  ASSERT_TRUE(check->left_out.has_value());
  EXPECT_NEAR(check->left_out->rms_px, 8, 1e-9);
}

TEST(ControlFit, LeavingOutIsFittingWithoutThePoint) {
  test_support::Random random(5);
  auto points = grid(4, cubic);
  for (ControlPoint& p : points) p.pixel += glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1));
  const auto check = mars::check_polynomial(points, 2);
  ASSERT_TRUE(check && check->left_out);
  // The deviation of a point from the fit without it, found by moving it until it fits: its residual is linear in it.
  const std::size_t worst = check->left_out->worst;
  const auto residual = [&](double by) {
    auto moved = points;
    moved[worst].pixel.x += by;
    const auto fit = mars::check_polynomial(moved, 2);
    return fit->fitted.rms_px * fit->fitted.rms_px;
  };
  const double curve = (residual(1) - 2 * residual(0) + residual(-1)) / 2;
  const double slope = (residual(1) - residual(-1)) / 2;
  const double off_x = -slope / (2 * curve);
  EXPECT_LE(std::abs(off_x), check->left_out->largest_px + 1e-6);
  EXPECT_GT(check->left_out->rms_px, check->fitted.rms_px);
}

TEST(ControlFit, TooFewOrDegeneratePointsDetermineNothing) {
  const auto points = grid(3, cubic);
  EXPECT_FALSE(mars::check_polynomial(points, 3).has_value());
  EXPECT_TRUE(mars::check_polynomial(points, 2).has_value());
  EXPECT_FALSE(mars::check_polynomial(std::span(points).first(2), 1).has_value());
  // All on a circle, which is a curve of order 2.
  std::vector<ControlPoint> ring;
  for (int i = 0; i < 12; ++i) {
    const glm::dvec2 g(std::cos(i / 1.9), std::sin(i / 1.9));
    ring.push_back({100.0 * g, g, "r"});
  }
  EXPECT_FALSE(mars::check_polynomial(ring, 2).has_value());
  EXPECT_TRUE(mars::check_polynomial(ring, 1).has_value());
  // As many points as coefficients: nothing is left over.
  const auto exact = mars::check_polynomial(std::span(points).first(3), 1);
  EXPECT_FALSE(exact.has_value());  // the first row: one line
  const std::vector<ControlPoint> corner{points[0], points[2], points[6]};
  ASSERT_TRUE(mars::check_polynomial(corner, 1).has_value());
  EXPECT_FALSE(mars::check_polynomial(corner, 1)->left_out.has_value());
}

TEST(ControlFit, PointsOnALine) {
  const auto points = grid(3, cubic);
  EXPECT_FALSE(mars::are_on_one_line(points));
  EXPECT_TRUE(mars::are_on_one_line(std::span(points).first(3)));
  EXPECT_TRUE(mars::are_on_one_line(std::span(points).first(2)));
  std::vector<ControlPoint> slanted;
  for (int i = 0; i < 6; ++i)
    slanted.push_back({{i * 10.0, i * 20.0 + i % 2 * 0.1}, {i * 1.0, i % 3 * 1.0}, "s"});
  EXPECT_TRUE(mars::are_on_one_line(slanted));  // the pixels lie on one
}

TEST(PlacementOptions, MethodsHaveTheirWords) {
  EXPECT_EQ(mars::parse_gcp_method("polynomial1"), mars::GcpMethod::kPolynomial1);
  EXPECT_EQ(mars::parse_gcp_method("polynomial2"), mars::GcpMethod::kPolynomial2);
  EXPECT_EQ(mars::parse_gcp_method("polynomial3"), mars::GcpMethod::kPolynomial3);
  EXPECT_EQ(mars::parse_gcp_method("tps"), mars::GcpMethod::kSpline);
  EXPECT_FALSE(mars::parse_gcp_method("TPS").has_value());
  EXPECT_FALSE(mars::parse_gcp_method("").has_value());
}

TEST(MemoryFile, NamesDiffer) {
  const mars::MemoryFile a("tif");
  const mars::MemoryFile b("tif");
  EXPECT_NE(a.name(), b.name());
  EXPECT_TRUE(a.name().starts_with("/vsimem/"));
  EXPECT_TRUE(a.name().ends_with(".tif"));
}

}  // namespace
