// Volumes between triangles and a reference, in closed form and against fine subdivision.
#include "vpe/explore/drawing/ground_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/support.h"

namespace vpe::explore {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

constexpr double kRadius_m = 3.4e6;

Triangle random_triangle(test_support::Random& random, double size_m, double rise_m) {
  const glm::dvec3 up = random.direction();
  const glm::dvec3 side = glm::normalize(glm::cross(up, glm::dvec3(0.3, -0.5, 0.8)));
  const glm::dvec3 ahead = glm::cross(up, side);
  const auto corner = [&](double x, double y) {
    return up * (kRadius_m + random.uniform(-rise_m, rise_m)) + size_m * (x * side + y * ahead);
  };
  return {corner(0, 0), corner(1, 0), corner(0.2, 1)};
}

// Divides a triangle into four to a depth.
template <class Do>
void divide(const Triangle& t, int depth, const Do& act) {
  if (depth == 0) return act(t);
  const glm::dvec3 ab = (t[0] + t[1]) / 2.0;
  const glm::dvec3 bc = (t[1] + t[2]) / 2.0;
  const glm::dvec3 ca = (t[2] + t[0]) / 2.0;
  divide({t[0], ab, ca}, depth - 1, act);
  divide({ab, t[1], bc}, depth - 1, act);
  divide({ca, bc, t[2]}, depth - 1, act);
  divide({ab, bc, ca}, depth - 1, act);
}

TEST(SolidAngle, EightOctantsAreTheSphere) {
  double sum = 0;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-2.0, 3.0}) {
        const bool is_turned = x * y * z < 0;
        const Triangle octant{glm::dvec3{x, 0, 0}, {0, y, 0}, {0, 0, z}};
        const double angle = solid_angle(is_turned ? Triangle{octant[0], octant[2], octant[1]} : octant);
        EXPECT_NEAR(angle, mars::kPi / 2, 1e-14);
        sum += angle;
      }
  EXPECT_NEAR(sum, 4 * mars::kPi, 1e-13);
}

// A plane that cuts the triangle: parts of any subdivision have the same sums.
TEST(VolumeSum, OfAPlaneIsExactInAnyParts) {
  test_support::Random random(20261127);
  int cut = 0;
  for (int n = 0; n < 200; ++n) {
    const Triangle t = random_triangle(random, 500, 40);
    const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const glm::dvec3 normal = glm::normalize(glm::normalize(middle) + 0.05 * random.direction());
    const double offset_m = glm::dot(normal, middle) + random.uniform(-20, 20);
    const auto plane_m = [&](const glm::dvec3& p) { return offset_m * glm::length(p) / glm::dot(normal, p); };
    VolumeSum whole(plane_m, true, kRadius_m);
    whole.add(t);
    VolumeSum parts(plane_m, true, kRadius_m);
    divide(t, 3, [&](const Triangle& part) { parts.add(part); });
    const double seen_m2 = glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), normal) / 2;
    const double scale_m3 = seen_m2 * 40;
    // The cone of the triangle less that of its shadow on the plane.
    const auto cone_m3 = [](const Triangle& of) { return glm::dot(of[0], glm::cross(of[1], of[2])) / 6; };
    Triangle shadow = t;
    for (glm::dvec3& corner : shadow) corner *= plane_m(corner) / glm::length(corner);
    EXPECT_NEAR(whole.sum().above_m3, parts.sum().above_m3, 1e-7 * scale_m3) << n;
    EXPECT_NEAR(whole.sum().below_m3, parts.sum().below_m3, 1e-7 * scale_m3) << n;
    EXPECT_NEAR(whole.sum().area_above_m2, parts.sum().area_above_m2, 1e-6 * seen_m2) << n;
    EXPECT_NEAR(whole.sum().above_m3 - whole.sum().below_m3, cone_m3(t) - cone_m3(shadow), 1e-4 * scale_m3)
        << n;
    cut += whole.sum().above_m3 > 0 && whole.sum().below_m3 > 0 ? 1 : 0;
  }
  EXPECT_GT(cut, 50);
}

TEST(VolumeSum, OfASphereIsThatOfShells) {
  test_support::Random random(5);
  for (int n = 0; n < 100; ++n) {
    const Triangle t = random_triangle(random, 300, 30);
    const double level_m = kRadius_m + random.uniform(-30, 30);
    VolumeSum whole([&](const glm::dvec3&) { return level_m; }, false, kRadius_m);
    whole.add(t);
    VolumeSum fine([&](const glm::dvec3&) { return level_m; }, false, kRadius_m);
    divide(t, 6, [&](const Triangle& part) { fine.add(part); });
    const double scale_m3 = 0.5 * 300 * 300 * 30;
    EXPECT_NEAR(whole.sum().above_m3 - whole.sum().below_m3, fine.sum().above_m3 - fine.sum().below_m3,
                1e-6 * scale_m3);
    // The line between above and below is straight on the triangle: 300 m bulge by 3 mm.
    EXPECT_NEAR(whole.sum().above_m3, fine.sum().above_m3, 3e-4 * scale_m3);
    EXPECT_GE(whole.sum().above_m3, 0);
    EXPECT_GE(whole.sum().below_m3, -1e-6 * scale_m3);
  }
}

TEST(VolumeSum, ClockwiseTrianglesCountNegative) {
  test_support::Random random(6);
  const Triangle t = random_triangle(random, 300, 30);
  VolumeSum sum([](const glm::dvec3&) { return kRadius_m + 3; }, false, kRadius_m);
  sum.add(t);
  sum.add({t[0], t[2], t[1]});
  EXPECT_NEAR(sum.sum().above_m3, 0, 1e-3);
  EXPECT_NEAR(sum.sum().below_m3, 0, 1e-3);
  EXPECT_NEAR(sum.sum().area_above_m2, 0, 1e-6);
}

}  // namespace
}  // namespace vpe::explore
