// Coordinates of charts, their domains, gradients and bounds.
#include "relief/field/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/relief/samples.h"

namespace relief {
namespace {

TEST(ReliefChart, AParallelChartMeasuresAcrossItsAxis) {
  const Chart chart = Chart::parallel({1, 2, 3}, {0, 1, 0}, {0, 0, 1}, {-1, -2, 3, 4});
  const glm::dvec2 at = chart.at({77, 4, 6});
  EXPECT_EQ(at, glm::dvec2(2, 3));
  EXPECT_TRUE(chart.holds({-500, 4, 6}));
  EXPECT_FALSE(chart.holds({0, 5.5, 6}));
  EXPECT_FALSE(chart.holds({0, 4, 0.5}));
  EXPECT_FALSE(chart.cut({{1, 0, 0}, -10}).holds({9, 4, 6}));
  EXPECT_TRUE(chart.cut({{1, 0, 0}, -10}).holds({11, 4, 6}));
}

TEST(ReliefChart, ACubeFaceIsTheCubesOwnChart) {
  samples::Random random(5);
  for (int n = 0; n < 1000; ++n) {
    const glm::dvec3 d = random.direction();
    const mars::ChartPoint expected = mars::chart_point(d);
    const Chart chart = Chart::cube_face({0, 0, 0}, expected.face, 7);
    EXPECT_TRUE(chart.holds(d * 3.0));
    EXPECT_NEAR(chart.at(d * 3.0).x, 7 * expected.u, 1e-14);
    EXPECT_NEAR(chart.at(d * 3.0).y, 7 * expected.v, 1e-14);
  }
}

TEST(ReliefChart, TheSixFacesCoverSpaceOnce) {
  samples::Random random(6);
  for (int n = 0; n < 1000; ++n) {
    const glm::dvec3 p = random.in_box(10);
    int held = 0;
    for (int face = 0; face < mars::kFaces; ++face)
      held += Chart::cube_face({1, 2, 3}, static_cast<mars::Face>(face), 7).holds(p) ? 1 : 0;
    EXPECT_EQ(held, 1);
  }
}

TEST(ReliefChart, StretchOfACentralChartIsAsStated) {
  const Chart chart = Chart::central({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  const double angle = 0.9;
  const double h = 1e-6;
  const auto point = [](double a, double b) {
    return glm::dvec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  };
  const double outwards = glm::length(chart.at(point(angle + h, 0)) - chart.at(point(angle - h, 0))) / (2 * h);
  const double across =
      glm::length(chart.at(point(angle, h)) - chart.at(point(angle, -h))) / (2 * h * std::sin(angle));
  EXPECT_NEAR(outwards, 1 / std::pow(std::cos(angle), 2), 1e-8);
  EXPECT_NEAR(across, 1 / std::cos(angle), 1e-8);
}

std::vector<Chart> some_charts() {
  const glm::dvec3 right = glm::normalize(glm::dvec3(1, 2, 3));
  const glm::dvec3 up = glm::normalize(glm::cross(right, glm::dvec3(0, 0, 1)));
  return {Chart::parallel({1, 2, 3}, right, up), Chart::central({1, 2, 3}, right, up, 4),
          Chart::cube_face({1, 2, 3}, mars::Face::kMinusY, 4)};
}

TEST(ReliefChart, GradientsAreThoseOfDifferences) {
  samples::Random random(7);
  for (const Chart& chart : some_charts()) {
    for (int n = 0; n < 500; ++n) {
      const glm::dvec3 p = random.in_box(10);
      if (!chart.holds(p) || chart.w().at(p) < 0.5) continue;
      const auto gradients = chart.gradients(p);
      for (int k = 0; k < 3; ++k) {
        glm::dvec3 step{0, 0, 0};
        step[k] = 1e-6;
        const glm::dvec2 slope = (chart.at(p + step) - chart.at(p - step)) / 2e-6;
        EXPECT_NEAR(gradients[0][k], slope.x, 1e-5);
        EXPECT_NEAR(gradients[1][k], slope.y, 1e-5);
      }
    }
  }
}

TEST(ReliefChart, BoundsHoldThePointsOfABoxThatAreInTheDomain) {
  samples::Random random(8);
  int tested = 0;
  for (const Chart& chart : some_charts()) {
    for (int n = 0; n < 500; ++n) {
      const glm::dvec3 low = random.in_box(10);
      const double size = std::pow(10.0, random.in(-6.0, 1.0));
      const Rect found = chart.bounds(low, low + size);
      for (int m = 0; m < 20; ++m) {
        const glm::dvec3 p =
            low + size * glm::dvec3(random.in(0.0, 1.0), random.in(0.0, 1.0), random.in(0.0, 1.0));
        if (!chart.holds(p)) continue;
        const glm::dvec2 at = chart.at(p);
        EXPECT_TRUE(overlap(found, {at.x, at.y, at.x, at.y}));
        ++tested;
      }
    }
  }
  EXPECT_GT(tested, 5000);
}

TEST(ReliefChart, BadFramesAreRefused) {
  EXPECT_THROW(Chart::parallel({0, 0, 0}, {1, 0, 0}, {1, 0, 0}), std::invalid_argument);
  EXPECT_THROW(Chart::parallel({0, 0, 0}, {2, 0, 0}, {0, 1, 0}), std::invalid_argument);
  EXPECT_THROW(Chart::parallel({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(Chart::parallel({std::nan(""), 0, 0}, {1, 0, 0}, {0, 1, 0}), std::invalid_argument);
  EXPECT_THROW(Chart::central({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace relief
