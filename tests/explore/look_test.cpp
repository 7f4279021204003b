#include "vpe/explore/look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace vpe::explore {
namespace {

constexpr double kR = mars::kMarsRadius_m;

TEST(Look, HeadOfIsTheInverseOfToCamera) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int n = 0; n < 2000; ++n) {
    const mars::Pose platform{180 * unit(random), 89 * unit(random), 5000,
                              180 * unit(random), 90 * unit(random), 180 * unit(random)};
    const mars::HeadAngles head{179 * unit(random), 89 * unit(random), 179 * unit(random)};
    const mars::CameraPose camera = mars::to_camera(platform, head, kR);
    const mars::HeadAngles found = head_of(platform, camera, kR);
    EXPECT_NEAR(found.yaw_deg, head.yaw_deg, 1e-9);
    EXPECT_NEAR(found.pitch_deg, head.pitch_deg, 1e-9);
    EXPECT_NEAR(found.roll_deg, head.roll_deg, 1e-9);
  }
}

// About the platform's own axis the horizon would tilt: by 30 degrees after a quarter turn.
TEST(Look, AroundALoweredPlatformTheHorizonStaysLevel) {
  const mars::Pose platform{10, 20, 3000, 40, -30, 0};
  mars::HeadAngles look;
  for (int n = 1; n <= 12; ++n) {
    look = turned_look(platform, look, 30, 0, kR);
    const mars::Pose seen = mars::to_pose(mars::to_camera(platform, look, kR), kR);
    EXPECT_NEAR(seen.roll_deg, 0, 1e-9);
    EXPECT_NEAR(seen.pitch_deg, -30, 1e-9);
    EXPECT_NEAR(std::remainder(seen.yaw_deg - 40 - 30 * n, 360.0), 0, 1e-9);
  }
}

TEST(Look, PitchEndsStraightUp) {
  const mars::Pose platform{0, 0, 3000, 0, -30, 0};
  const mars::HeadAngles look = turned_look(platform, {}, 0, 500, kR);
  EXPECT_NEAR(look.pitch_deg, 120 - 2 * 30, 1e-6) << "beyond the platform's zenith the head is turned round";
  EXPECT_NEAR(mars::to_pose(mars::to_camera(platform, look, kR), kR).pitch_deg, 90, 1e-5);
}

}  // namespace
}  // namespace vpe::explore
