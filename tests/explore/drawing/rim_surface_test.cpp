// Surfaces through the heights of an outline.
#include "vpe/explore/drawing/rim_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace vpe::explore {
namespace {

std::vector<glm::dvec2> star(test_support::Random& random, int corners, double least) {
  std::vector<glm::dvec2> outline;
  for (int n = 0; n < corners; ++n) {
    const double angle = 2 * mars::kPi * n / corners;
    outline.push_back(random.uniform(least, 1.0) * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return outline;
}

TEST(RimSurface, LinearHeightsComeBackInAnyOutline) {
  test_support::Random random(20261127);
  for (int n = 0; n < 30; ++n) {
    const std::vector<glm::dvec2> outline = star(random, random.integer(3, 60), 0.3);
    const auto plane = [](const glm::dvec2& p) { return 12 + 3 * p.x - 5 * p.y; };
    std::vector<double> heights_m;
    for (const glm::dvec2& corner : outline) heights_m.push_back(plane(corner));
    const RimSurface rim(outline, heights_m);
    for (int k = 0; k < 40; ++k) {
      // Near the middle, which is within any of these.
      const glm::dvec2 p{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
      EXPECT_NEAR(mean_value_height(outline, heights_m, p), plane(p), 1e-9);
      EXPECT_NEAR(rim.at(p), plane(p), 1e-9);
    }
  }
}

TEST(RimSurface, GoesThroughTheOutlineAndStaysBetweenItsHeights) {
  test_support::Random random(3);
  for (int n = 0; n < 30; ++n) {
    const std::vector<glm::dvec2> outline = star(random, 40, 1.0);  // convex
    std::vector<double> heights_m;
    for (std::size_t k = 0; k < outline.size(); ++k) heights_m.push_back(random.uniform(-100, 100));
    const auto [low, high] = std::ranges::minmax(heights_m);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const glm::dvec2& next = outline[(k + 1) % outline.size()];
      EXPECT_EQ(mean_value_height(outline, heights_m, outline[k]), heights_m[k]);
      EXPECT_NEAR(mean_value_height(outline, heights_m, 0.75 * outline[k] + 0.25 * next),
                  0.75 * heights_m[k] + 0.25 * heights_m[(k + 1) % outline.size()], 1e-6);
    }
    const RimSurface rim(outline, heights_m);
    for (int k = 0; k < 100; ++k) {
      const glm::dvec2 p = random.uniform(0, 0.9) * outline[static_cast<std::size_t>(random.integer(0, 39))];
      EXPECT_GE(rim.at(p), low);
      EXPECT_LE(rim.at(p), high);
      // Away from the outline, where heights change from corner to corner, cells of the lattice are small.
      if (glm::dot(p, p) < 0.5) {
        EXPECT_NEAR(rim.at(p), mean_value_height(outline, heights_m, p), 0.5);
      }
    }
  }
}

TEST(RimSurface, PlacesNearAnEdgeAreNearItsHeights) {
  const std::vector<glm::dvec2> outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<double> heights_m{0, 10, 20, 30};
  for (const double off : {1e-6, 1e-8, 1e-9, 1e-12, 1e-15, 0.0})
    for (const double sign : {-1.0, 1.0})
      EXPECT_NEAR(mean_value_height(outline, heights_m, {0.3, sign * off}), 3, 100 * off + 1e-9) << off;
}

TEST(RimSurface, BadRimsAreRefused) {
  const std::vector<glm::dvec2> line{{0, 0}, {1, 0}, {2, 0}};
  const std::vector<glm::dvec2> triangle{{0, 0}, {1, 0}, {0, 1}};
  const std::vector<double> three{1, 2, 3};
  EXPECT_THROW(RimSurface(line, three), std::invalid_argument);
  EXPECT_THROW(RimSurface(triangle, std::vector<double>{1, 2}), std::invalid_argument);
  EXPECT_THROW(RimSurface(std::span(triangle).first(2), std::span(three).first(2)), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::explore
