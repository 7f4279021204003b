#include "vpe/explore/foresight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace vpe::explore {
namespace {

TEST(Foresight, ContinuesAlongTheGreatCircle) {
  const auto pose = foreseen({{10, 0, 5000, 90, -10, 0}, {11, 0, 5000, 90, -10, 0}, 0.1}, 0.5);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->lon_deg, 16, 1e-9);
  EXPECT_NEAR(pose->lat_deg, 0, 1e-9);
  EXPECT_EQ(pose->alt_m, 5000);
  EXPECT_EQ(pose->yaw_deg, 90);
  test_support::Random random(5);
  for (int n = 0; n < 1000; ++n) {
    const mars::Pose a{random.uniform(-180, 180), random.uniform(-80, 80), 1000, 0, 0, 0};
    const mars::Pose b{a.lon_deg + random.uniform(-1, 1), a.lat_deg + random.uniform(-1, 1), 1000, 0, 0, 0};
    const double steps = random.uniform(0.1, 10);
    const auto later = foreseen({a, b, 0.1}, 0.1 * steps);
    ASSERT_TRUE(later);
    const glm::dvec3 p = mars::direction({a.lon_deg, a.lat_deg});
    const glm::dvec3 q = mars::direction({b.lon_deg, b.lat_deg});
    const glm::dvec3 r = mars::direction({later->lon_deg, later->lat_deg});
    EXPECT_NEAR(mars::angle_between_rad(q, r), std::min(kFarthest_rad, steps * mars::angle_between_rad(p, q)),
                1e-9);
    EXPECT_NEAR(glm::dot(glm::cross(p, q), r), 0, 1e-9) << "on one circle";
    EXPECT_GT(mars::angle_between_rad(p, r), mars::angle_between_rad(p, q)) << "ahead";
  }
}

TEST(Foresight, TurnsAndClimbsWithinLimits) {
  const auto pose = foreseen({{0, 0, 1000, 350, 80, 5}, {0, 0, 1100, 2, 85, 5}, 0.1}, 0.2);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->yaw_deg, 26, 1e-9);
  EXPECT_EQ(pose->pitch_deg, 90);
  EXPECT_NEAR(pose->alt_m, 1300, 1e-9);
  EXPECT_EQ(foreseen({{0, 0, 1000, 0, 0, 0}, {0, 0, 100, 0, 0, 0}, 0.1}, 1)->alt_m, 50);
  EXPECT_EQ(foreseen({{0, 0, 0, 0, 0, 0}, {0, 0, 0, 100, 0, 0}, 0.1}, 1)->yaw_deg, 190);
}

TEST(Foresight, SaysNothingOfACameraThatRests) {
  const mars::Pose pose{1, 2, 3, 4, 5, 0};
  EXPECT_FALSE(foreseen({pose, pose, 0.1}, 1));
  EXPECT_FALSE(foreseen({pose, {2, 2, 3, 4, 5, 0}, 0}, 1));
  EXPECT_FALSE(foreseen({pose, {2, 2, 3, 4, 5, 0}, 2}, 1)) << "a long rest between them";
  EXPECT_FALSE(foreseen({pose, {2, 2, 3, 4, 5, 0}, std::nan("")}, 1));
}

}  // namespace
}  // namespace vpe::explore
