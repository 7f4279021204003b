// Smooth patches: values, slopes, bounds, and their distance from flat facets.
#include "relief/field/patch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "relief/field/interval_algebra.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

std::array<double, 16> random_posts(samples::Random& random) {
  std::array<double, 16> posts;
  for (double& post : posts) post = random.in(-3.0, 3.0);
  return posts;
}

Patch random_patch(samples::Random& random, Interpolation interpolation) {
  const std::array<double, 16> p = random_posts(random);
  return interpolation == Interpolation::kBilinear ? Patch::bilinear(p[0], p[1], p[2], p[3])
                                                   : Patch::bicubic(p);
}

// Keys' cubic convolution with a = -1/2, by its own formula.
double cubic(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

TEST(ReliefPatch, ABilinearPatchIsAMeanOfItsPosts) {
  const Patch patch = Patch::bilinear(1, 3, 5, 11);
  EXPECT_EQ(patch.height_m(0, 0), 1);
  EXPECT_EQ(patch.height_m(1, 0), 3);
  EXPECT_EQ(patch.height_m(0, 1), 5);
  EXPECT_EQ(patch.height_m(1, 1), 11);
  EXPECT_EQ(patch.height_m(0.5, 0.5), 5);
  EXPECT_EQ(patch.gradient(0.25, 0.5), glm::dvec2(4, 5));
}

TEST(ReliefPatch, ABicubicPatchIsCatmullRoms) {
  samples::Random random(9);
  for (int n = 0; n < 200; ++n) {
    const std::array<double, 16> p = random_posts(random);
    const Patch patch = Patch::bicubic(p);
    EXPECT_NEAR(patch.height_m(0, 0), p[5], 1e-15);
    EXPECT_NEAR(patch.height_m(1, 1), p[10], 1e-15);
    const double u = random.in(0.0, 1.0);
    const double v = random.in(0.0, 1.0);
    std::array<double, 4> rows;
    for (std::size_t j = 0; j < 4; ++j) rows[j] = cubic(p[4 * j], p[4 * j + 1], p[4 * j + 2], p[4 * j + 3], u);
    EXPECT_NEAR(patch.height_m(u, v), cubic(rows[0], rows[1], rows[2], rows[3], v), 1e-13);
  }
}

TEST(ReliefPatch, GradientsAreThoseOfDifferences) {
  samples::Random random(10);
  for (const Interpolation interpolation : {Interpolation::kBilinear, Interpolation::kBicubic}) {
    for (int n = 0; n < 200; ++n) {
      const Patch patch = random_patch(random, interpolation);
      const double u = random.in(0.0, 1.0);
      const double v = random.in(0.0, 1.0);
      const double h = 1e-5;
      const glm::dvec2 found = patch.gradient(u, v);
      EXPECT_NEAR(found.x, (patch.height_m(u + h, v) - patch.height_m(u - h, v)) / (2 * h), 1e-8);
      EXPECT_NEAR(found.y, (patch.height_m(u, v + h) - patch.height_m(u, v - h)) / (2 * h), 1e-8);
    }
  }
}

TEST(ReliefPatch, BoundsHoldHeightsAndSlopesOfEveryPart) {
  samples::Random random(11);
  for (const Interpolation interpolation : {Interpolation::kBilinear, Interpolation::kBicubic}) {
    for (int n = 0; n < 300; ++n) {
      const Patch patch = random_patch(random, interpolation);
      const PatchSlopes slopes(patch);
      const double size = std::pow(10.0, random.in(-8.0, 0.0));
      const double u0 = random.in(0.0, 1 - size);
      const double v0 = random.in(0.0, 1 - size);
      const Interval u{u0, u0 + size};
      const Interval v{v0, v0 + size};
      const Interval heights = patch.bounds_m(u, v);
      const PatchSlopes::Slopes rise = slopes.over(u, v);
      for (int m = 0; m < 30; ++m) {
        const double pu = random.in(u.low, u.high);
        const double pv = random.in(v.low, v.high);
        EXPECT_TRUE(holds(patch.bounds_m(), patch.height_m(pu, pv)));
        EXPECT_TRUE(holds(heights, patch.height_m(pu, pv)));
        const glm::dvec2 slope = patch.gradient(pu, pv);
        EXPECT_TRUE(holds(widened(rise.u, 1e-14), slope.x));
        EXPECT_TRUE(holds(widened(rise.v, 1e-14), slope.y));
      }
      // They shrink with the part.
      EXPECT_LE(width(heights), 60 * size + 1e-12);
      EXPECT_LE(width(rise.u) + width(rise.v), 500 * size + 1e-11);
    }
  }
}

// The height of the two triangles that share the diagonal through (0, 0) or the other one.
double facet_m(const Patch& patch, double u, double v, bool is_main) {
  const double h00 = patch.height_m(0, 0);
  const double h10 = patch.height_m(1, 0);
  const double h01 = patch.height_m(0, 1);
  const double h11 = patch.height_m(1, 1);
  if (is_main) return u > v ? h00 + u * (h10 - h00) + v * (h11 - h10) : h00 + v * (h01 - h00) + u * (h11 - h01);
  return u + v < 1 ? h00 + u * (h10 - h00) + v * (h01 - h00)
                   : h11 + (1 - u) * (h01 - h11) + (1 - v) * (h10 - h11);
}

double largest_deviation_m(const Patch& patch) {
  double largest = 0;
  for (int j = 0; j <= 40; ++j)
    for (int i = 0; i <= 40; ++i)
      for (const bool is_main : {false, true})
        largest = std::max(largest, std::abs(patch.height_m(i / 40.0, j / 40.0) -
                                             facet_m(patch, i / 40.0, j / 40.0, is_main)));
  return largest;
}

TEST(ReliefPatch, TheFacetDeviationOfABilinearPatchIsReached) {
  samples::Random random(12);
  for (int n = 0; n < 200; ++n) {
    const Patch patch = random_patch(random, Interpolation::kBilinear);
    EXPECT_NEAR(largest_deviation_m(patch), patch.facet_deviation_m(), 1e-14);
  }
}

TEST(ReliefPatch, TheFacetDeviationOfABicubicPatchHolds) {
  samples::Random random(13);
  double closest = 0;
  for (int n = 0; n < 500; ++n) {
    const Patch patch = random_patch(random, Interpolation::kBicubic);
    const double found = largest_deviation_m(patch);
    EXPECT_LE(found, patch.facet_deviation_m());
    closest = std::max(closest, found / patch.facet_deviation_m());
  }
  EXPECT_GT(closest, 0.5);
}

TEST(ReliefPatch, AFlatPatchLiesInItsFacets) {
  std::array<double, 16> posts;
  for (std::size_t n = 0; n < 16; ++n)
    posts[n] = 2.0 * static_cast<double>(n % 4) - 3.0 * static_cast<double>(n / 4);
  EXPECT_NEAR(Patch::bicubic(posts).facet_deviation_m(), 0, 1e-14);
}

}  // namespace
}  // namespace relief
