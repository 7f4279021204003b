// Tests lines with fewer points.
#include "vpe/overlay/polyline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "mars/geodesy/sphere.h"

namespace {

using vpe::overlay::kStrokeTolerance_px;
using vpe::overlay::simplified;

double distance_px(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::length(p - (a + t * along));
}

// Returns the largest distance of any point to the piece that is drawn in its place, and checks that points are kept in order.
double largest_distance_px(const std::vector<glm::dvec2>& points, const std::vector<glm::dvec2>& kept) {
  double most = 0;
  std::size_t k = 0;
  for (const glm::dvec2& point : points) {
    if (k + 1 < kept.size() && point == kept[k + 1]) ++k;
    most = std::max(
        most, k + 1 < kept.size() ? distance_px(point, kept[k], kept[k + 1]) : glm::length(point - kept[k]));
  }
  EXPECT_EQ(k + 1, kept.size());
  return most;
}

TEST(Polyline, StraightLinesKeepTheirEnds) {
  std::vector<glm::dvec2> points;
  for (int n = 0; n <= 100; ++n) points.push_back({3 + 0.7 * n, 5 - 0.4 * n});
  EXPECT_EQ(simplified(points), (std::vector<glm::dvec2>{points.front(), points.back()}));
  EXPECT_EQ(simplified(std::vector<glm::dvec2>{{1, 2}}), (std::vector<glm::dvec2>{{1, 2}}));
  EXPECT_TRUE(simplified({}).empty());
}

TEST(Polyline, LinesThatTurnBackKeepTheirTip) {
  std::vector<glm::dvec2> points;
  for (int n = 0; n <= 10; ++n) points.push_back({1.0 * n, 0});
  for (int n = 9; n >= -5; --n) points.push_back({1.0 * n, 0});
  EXPECT_EQ(simplified(points), (std::vector<glm::dvec2>{{0, 0}, {10, 0}, {-5, 0}}));
}

TEST(Polyline, CurvesKeepAFewPointsWithinTheTolerance) {
  std::vector<glm::dvec2> points;
  for (int n = 0; n <= 628; ++n) {
    const double a = 2 * mars::kPi * n / 628;
    points.push_back({100 * std::cos(a), 100 * std::sin(a)});
  }
  const auto kept = simplified(points);
  // Pieces over an arc of four steps are off it by 0.02 px, of five by 0.031.
  EXPECT_LE(kept.size(), 628U / 4 + 1);
  EXPECT_GT(kept.size(), 20U);
  EXPECT_LE(largest_distance_px(points, kept), kStrokeTolerance_px * (1 + 1e-9));
}

TEST(Polyline, WalksOfAnyStepStayWithinTheTolerance) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  std::size_t fewer = 0;
  for (int line = 0; line < 300; ++line) {
    const double step_px = std::pow(10.0, 2 * any(random) - 1), bend = std::pow(10.0, any(random) - 1);
    std::vector<glm::dvec2> points{{0, 0}};
    double angle = 0;
    for (int n = 0; n < 200; ++n) {
      angle += bend * any(random);
      points.push_back(points.back() + step_px * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    for (const double tolerance_px : {0.003, kStrokeTolerance_px, 1.0}) {
      const auto kept = simplified(points, tolerance_px);
      ASSERT_EQ(kept.front(), points.front());
      ASSERT_EQ(kept.back(), points.back());
      ASSERT_LE(largest_distance_px(points, kept), tolerance_px * (1 + 1e-9)) << line << " " << tolerance_px;
      fewer += kept.size() < points.size() / 2 ? 1 : 0;
    }
  }
  EXPECT_GT(fewer, 300U);
}

}  // namespace
