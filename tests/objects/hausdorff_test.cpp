#include "objects/model/hausdorff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "objects/model/shapes.h"
#include "tests/objects/surface_points.h"

namespace objects {
namespace {

using test_support::farthest_sample_m;
using test_support::soup;

constexpr unsigned kHausdorffSeed = 20261126;

Mesh square(float side_m, float z_m) {
  return soup({{{0, 0, z_m}, {side_m, 0, z_m}, {side_m, side_m, z_m}},
               {{0, 0, z_m}, {side_m, side_m, z_m}, {0, side_m, z_m}}});
}

void expect_both_ways(const Mesh& a, const Mesh& b, double distance_m) {
  for (const double bound_m : {hausdorff_bound(a, b, 0), hausdorff_bound(b, a, 0)}) {
    EXPECT_GE(bound_m, distance_m * (1 - 1e-6));
    EXPECT_LE(bound_m, distance_m * 1.051 + 1e-9);
  }
}

TEST(Hausdorff, DistancesOfPointsAreExact) {
  const std::array<glm::dvec3, 3> at{glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(0, 4, 0)};
  EXPECT_DOUBLE_EQ(distance_to_triangle({1, 1, 3}, at), 3);
  EXPECT_DOUBLE_EQ(distance_to_triangle({-3, -4, 0}, at), 5);
  EXPECT_DOUBLE_EQ(distance_to_triangle({8, 0, 3}, at), 5);
  EXPECT_DOUBLE_EQ(distance_to_triangle({0, 7, 4}, at), 5);
  EXPECT_DOUBLE_EQ(distance_to_triangle({2, -3, 4}, at), 5);
  EXPECT_DOUBLE_EQ(distance_to_triangle({-3, 2, 4}, at), 5);
  EXPECT_NEAR(distance_to_triangle({4, 4, 0}, at), std::sqrt(8), 1e-15);
  std::mt19937 random(kHausdorffSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto point = [&] { return glm::dvec3(any(random), any(random), any(random)); };
  for (int n = 0; n < 2000; ++n) {
    const std::array<glm::dvec3, 3> t{point(), point(), point()};
    const glm::dvec3 p = 2.0 * point();
    double sampled = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j)
        sampled =
            std::min(sampled, glm::distance(p, t[0] + (t[1] - t[0]) * (i / 60.0) + (t[2] - t[0]) * (j / 60.0)));
    const double exact = distance_to_triangle(p, t);
    ASSERT_LE(exact, sampled + 1e-12);
    ASSERT_GE(exact, sampled - 0.06);
  }
}

TEST(Hausdorff, TheTreeFindsTheNearestTriangle) {
  const Mesh rock = make_rock(3, 3);
  const DistanceTree tree(rock);
  EXPECT_EQ(tree.size(), rock.triangles.size());
  std::mt19937 random(kHausdorffSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 p(any(random), any(random), any(random));
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < tree.size(); ++t) least = std::min(least, tree.distance_m(p, t));
    const DistanceTree::Nearest found = tree.nearest(p, static_cast<std::uint32_t>(random()) % tree.size());
    ASSERT_EQ(found.distance_m, least);
    ASSERT_EQ(tree.distance_m(p, found.triangle), least);
  }
}

TEST(Hausdorff, ParallelSquaresAreTheirDistanceApart) {
  expect_both_ways(square(1, 0), square(1, 0.25F), 0.25);
  expect_both_ways(square(1, 0), square(1, 100), 100);
  // One square juts out.
  expect_both_ways(square(1, 0), square(3, 0), std::sqrt(8.0));
}

TEST(Hausdorff, EqualSurfacesHaveNoDistance) {
  const Mesh rock = make_rock(1, 3);
  EXPECT_LT(hausdorff_bound(rock, rock, 0), 1e-12);
  Mesh turned = rock;
  for (glm::uvec3& t : turned.triangles) t = {t.y, t.z, t.x};
  std::reverse(turned.triangles.begin(), turned.triangles.end());
  EXPECT_LT(hausdorff_bound(rock, turned, 0), 1e-12);
  // The same square in two triangles and in eight, whose edges cross.
  Mesh fan;
  for (int n = 0; n < 8; ++n) {
    constexpr std::array<std::array<float, 2>, 8> kRim{
        {{0, 0}, {0.5F, 0}, {1, 0}, {1, 0.5F}, {1, 1}, {0.5F, 1}, {0, 1}, {0, 0.5F}}};
    const auto& p = kRim[static_cast<std::size_t>(n)];
    const auto& q = kRim[static_cast<std::size_t>(n + 1) % 8];
    fan = test_support::joined(fan, soup({{{0.25F, 0.5F, 0}, {p[0], p[1], 0}, {q[0], q[1], 0}}}));
  }
  EXPECT_LT(hausdorff_bound(fan, square(1, 0), 1e-6), 1.1e-6);
}

TEST(Hausdorff, ScaledSpheresAreTheDifferenceOfTheirRadiiApart) {
  const Mesh one = make_ellipsoid({1, 1, 1}, 48);
  for (const float scale : {1.001F, 1.1F, 2.0F, 5.0F})
    expect_both_ways(one, make_ellipsoid(glm::vec3(scale), 48), static_cast<double>(scale) - 1);
}

TEST(Hausdorff, ASpikeIsFoundFromBothSides) {
  const Mesh box = make_box({1, 1, 1});
  const glm::mat4 placed = glm::translate(glm::mat4(1), {0, 0, 1});
  Mesh spiked = box;
  append(spiked, make_cone(0.05F, 0.7F, 5), placed, {});
  expect_both_ways(box, spiked, 0.7);
  // Nothing of the box is far from the spiked one, so that one side alone would not see it.
  EXPECT_LT(farthest_sample_m(box, spiked, 20000, kHausdorffSeed), 1e-6);
}

TEST(Hausdorff, ATorusFillsNoBall) {
  // The middle of the disc is farthest from the ring, whose inner side is a polygon.
  expect_both_ways(make_torus(1, 0.25F, 96, 24), make_ellipsoid({1.25F, 1.25F, 0.01F}, 96),
                   0.75 * std::cos(3.14159265 / 96));
}

TEST(Hausdorff, BoundsHoldForAnyTriangles) {
  std::mt19937 random(kHausdorffSeed);
  for (int n = 0; n < 12; ++n) {
    const Mesh a = test_support::random_soup(random, 1 + n * n, 1.0F);
    const Mesh b = test_support::random_soup(random, 60, 1.0F);
    const double sampled_m = std::max(farthest_sample_m(a, b, 50000, kHausdorffSeed),
                                      farthest_sample_m(b, a, 50000, kHausdorffSeed));
    const double bound_m = hausdorff_bound(a, b, 0);
    EXPECT_GE(bound_m, sampled_m) << n;
    EXPECT_LE(bound_m, 1.05 * sampled_m + 0.03) << n;
    EXPECT_NEAR(bound_m, hausdorff_bound(b, a, 0), 0.05 * bound_m) << n;
    const double loose_m = hausdorff_bound(a, b, 0.2);
    EXPECT_GE(loose_m, sampled_m) << n;
    EXPECT_LE(loose_m, std::max(1.05 * sampled_m, sampled_m + 0.2) + 0.03) << n;
  }
}

TEST(Hausdorff, NearbySurfacesAreBoundedTightly) {
  const Mesh a = make_rock(5, 4);
  Mesh b = a;
  std::mt19937 random(kHausdorffSeed);
  std::uniform_real_distribution<float> any(-0.004F, 0.004F);
  for (glm::vec3& p : b.positions_m) p += glm::vec3(any(random), any(random), any(random));
  const double sampled_m = std::max(farthest_sample_m(a, b, 150000, kHausdorffSeed),
                                    farthest_sample_m(b, a, 150000, kHausdorffSeed));
  const double bound_m = hausdorff_bound(a, b, 0);
  EXPECT_GE(bound_m, sampled_m);
  EXPECT_LE(bound_m, 1.05 * sampled_m + 3e-4);
}

TEST(Hausdorff, TrianglesWithoutAreaCountAsWhatTheyAre) {
  const Mesh point = soup({{{0, 0, 2}, {0, 0, 2}, {0, 0, 2}}});
  const Mesh segment = soup({{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}});
  const Mesh other_segment = soup({{{3, 0, 0}, {3, 0, 0}, {0, 0, 0}}});
  EXPECT_LT(hausdorff_bound(segment, other_segment, 0), 1e-12);
  expect_both_ways(point, segment, std::sqrt(13.0));
  expect_both_ways(point, point, 0);
  // A needle beside a square, and one in it.
  expect_both_ways(square(1, 0), test_support::joined(square(1, 0), soup({{{0, 0, 0}, {0, 0, 1}, {0, 0, 5}}})),
                   5);
  expect_both_ways(square(1, 0), test_support::joined(square(1, 0), soup({{{0, 0, 0}, {1, 1, 0}, {0, 0, 0}}})),
                   0);
}

TEST(Hausdorff, SizesOfCoordinatesDoNotMatter) {
  for (const float scale : {1e-6F, 1e6F}) {
    Mesh a = make_box(glm::vec3(scale));
    Mesh b = make_box(glm::vec3(1.25F * scale));
    EXPECT_NEAR(hausdorff_bound(a, b, 0) / static_cast<double>(scale), std::hypot(0.125, 0.125, 0.25), 0.02);
  }
}

TEST(Hausdorff, NothingIsFarFromEverything) {
  EXPECT_EQ(hausdorff_bound(Mesh{}, Mesh{}, 0), 0);
  EXPECT_EQ(hausdorff_bound(Mesh{}, square(1, 0), 0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(hausdorff_bound(square(1, 0), Mesh{}, 0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace objects
