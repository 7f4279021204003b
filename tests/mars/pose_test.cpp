#include "mars/geodesy/pose.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <vector>

#include "tests/mars/exact.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using exact::Bound;
using exact::Real;
using exact::vec;

struct ExactAxes {
  exact::Vec right, up, forward;
};

void turn(exact::Vec& from, exact::Vec& to, double angle_deg) {
  const Real s = exact::sin_deg(angle_deg);
  const Real c = exact::cos_deg(angle_deg);
  const exact::Vec turned = from * c + to * s;
  to = to * c - from * s;
  from = turned;
}

void apply(ExactAxes& a, double yaw_deg, double pitch_deg, double roll_deg) {
  turn(a.forward, a.right, yaw_deg);
  turn(a.forward, a.up, pitch_deg);
  turn(a.up, a.right, roll_deg);
}

ExactAxes exact_axes(const Pose& pose, const HeadAngles& head) {
  const exact::Vec up = exact::direction({pose.lon_deg, pose.lat_deg});
  const exact::Vec east{-exact::sin_deg(pose.lon_deg), exact::cos_deg(pose.lon_deg), 0};
  ExactAxes axes{east, up, exact::cross(up, east)};
  apply(axes, pose.yaw_deg, pose.pitch_deg, pose.roll_deg);
  apply(axes, head.yaw_deg, head.pitch_deg, head.roll_deg);
  return axes;
}

double hostile_angle(test_support::Random& random) {
  static const std::vector<double> kSpecial{0,   90,  -90,  180,    -180,          270,    360,    -360,
                                            540, 1e9, 1e15, 5e-324, 89.9999999999, -1e-12, 1e-300, 45};
  if (random.integer(0, 1) == 0) return random.uniform(-360, 360);
  return kSpecial[static_cast<std::size_t>(random.integer(0, static_cast<int>(kSpecial.size()) - 1))];
}

Pose random_pose(test_support::Random& random) {
  Pose pose;
  pose.lon_deg = hostile_angle(random);
  pose.lat_deg = random.integer(0, 3) == 0 ? 90.0 * random.integer(-1, 1) : random.uniform(-90, 90);
  pose.alt_m = random.integer(0, 1) == 0 ? random.uniform(-8000, 22000) : random.log_uniform(0.1, 4e7);
  pose.yaw_deg = hostile_angle(random);
  pose.pitch_deg = random.integer(0, 3) == 0 ? 90.0 * random.integer(-1, 1) : random.uniform(-90, 90);
  if (random.integer(0, 9) == 0)
    pose.pitch_deg = std::copysign(90 - random.log_uniform(1e-14, 1e-3), pose.pitch_deg);
  pose.roll_deg = hostile_angle(random);
  return pose;
}

void expect_orthonormal(const Axes& axes, Bound& bound) {
  const std::array<exact::Vec, 3> a{vec(axes.right), vec(axes.up), vec(axes.forward)};
  for (std::size_t i = 0; i < 3; ++i) {
    bound.add(std::abs(exact::length(a[i]) - 1), kAxesError);
    bound.add(std::abs(exact::dot(a[i], a[(i + 1) % 3])), kAxesError);
  }
  EXPECT_LE(exact::length(exact::cross(a[0], a[1]) + a[2]), 2 * kAxesError);
}

TEST(Pose, CameraIsWithinItsBounds) {
  test_support::Random random(1);
  Bound position("to_camera: position");
  Bound orthonormal("to_camera: orthonormal");
  Bound direction_bound("to_camera: axes");
  for (int n = 0; n < 40000; ++n) {
    const Pose pose = random_pose(random);
    const HeadAngles head{hostile_angle(random), hostile_angle(random), hostile_angle(random)};
    const double radius_m = random.log_uniform(1e3, 1e8);
    const CameraPose camera = to_camera(pose, head, radius_m);
    const ExactAxes want = exact_axes(pose, head);
    expect_orthonormal(camera.axes, orthonormal);
    for (const auto& [got, twin] : {std::pair{camera.axes.right, want.right},
                                    {camera.axes.up, want.up},
                                    {camera.axes.forward, want.forward}}) {
      direction_bound.add(exact::angle(vec(got), twin), kAxesError);
    }
    const Real distance = static_cast<Real>(radius_m) + pose.alt_m;
    const exact::Vec place = exact::direction({pose.lon_deg, pose.lat_deg}) * distance;
    position.add(exact::length(vec(camera.position_m) - place), kCameraPositionError * std::abs(distance));
  }
}

TEST(Pose, NoHeadAnglesIsTheViewAhead) {
  test_support::Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Pose pose = random_pose(random);
    const CameraPose a = to_camera(pose, kMarsRadius_m);
    const CameraPose b = to_camera(pose, HeadAngles{}, kMarsRadius_m);
    EXPECT_EQ(a.position_m, b.position_m);
    EXPECT_EQ(a.axes.forward, b.axes.forward);
    EXPECT_EQ(a.axes.up, b.axes.up);
  }
}

// The signs, by hand: on the equator at longitude 0, east is +Y, north +Z, up +X.
TEST(Pose, YawIsClockwisePitchUpRollRightWingDown) {
  const auto axes = [](double yaw, double pitch, double roll) {
    return to_camera({0, 0, 0, yaw, pitch, roll}, 1.0).axes;
  };
  EXPECT_EQ(axes(0, 0, 0).forward, glm::dvec3(0, 0, 1));
  EXPECT_EQ(axes(0, 0, 0).right, glm::dvec3(0, 1, 0));
  EXPECT_EQ(axes(0, 0, 0).up, glm::dvec3(1, 0, 0));
  EXPECT_EQ(axes(90, 0, 0).forward, glm::dvec3(0, 1, 0));  // heading 90 = east
  EXPECT_EQ(axes(0, 90, 0).forward, glm::dvec3(1, 0, 0));
  EXPECT_EQ(axes(0, 0, 90).right, glm::dvec3(-1, 0, 0));  // the right wing points down
  EXPECT_EQ(axes(0, 0, 90).up, glm::dvec3(0, 1, 0));
  // A head turned right on a platform flying north looks east; on one in a right bank of 90, looks down.
  EXPECT_EQ(to_camera({0, 0, 0, 0, 0, 0}, HeadAngles{90, 0, 0}, 1.0).axes.forward, glm::dvec3(0, 1, 0));
  EXPECT_EQ(to_camera({0, 0, 0, 0, 0, 90}, HeadAngles{90, 0, 0}, 1.0).axes.forward, glm::dvec3(-1, 0, 0));
}

TEST(Pose, AxesAgreeWithGlmQuaternions) {
  test_support::Random random(3);
  for (int n = 0; n < 5000; ++n) {
    const LonLat place{random.uniform(-180, 180), random.uniform(-90, 90)};
    const double yaw = random.uniform(-180, 180);
    const double pitch = random.uniform(-90, 90);
    const double roll = random.uniform(-180, 180);
    const LocalFrame f = local_frame(place);
    const auto rotation = [](double deg, const glm::dvec3& axis) {
      return glm::angleAxis(deg * kRadiansPerDegree, axis);
    };
    // In the platform's own frame (right, up, back): yaw about up, then pitch about right, then roll.
    const glm::dquat q = rotation(-yaw, {0, 1, 0}) * rotation(pitch, {1, 0, 0}) * rotation(-roll, {0, 0, 1});
    const glm::dmat3 level(f.east, f.up, -f.north);
    const Axes axes = oriented_axes(f, yaw, pitch, roll);
    ASSERT_LE(glm::length(axes.right - level * (q * glm::dvec3(1, 0, 0))), 4e-15);
    ASSERT_LE(glm::length(axes.up - level * (q * glm::dvec3(0, 1, 0))), 4e-15);
    ASSERT_LE(glm::length(axes.forward - level * (q * glm::dvec3(0, 0, -1))), 4e-15);
  }
}

TEST(Pose, ToPoseInvertsToCameraWithinItsBounds) {
  test_support::Random random(4);
  Bound axes_bound("to_pose: axes");
  Bound position("to_pose: position");
  for (int n = 0; n < 40000; ++n) {
    const Pose pose = random_pose(random);
    const double radius_m = random.log_uniform(1e5, 1e8);
    const CameraPose camera = to_camera(pose, radius_m);
    const Pose back = to_pose(camera, radius_m);
    EXPECT_GT(back.yaw_deg, -180.0);
    EXPECT_LE(back.yaw_deg, 180.0);
    EXPECT_GT(back.roll_deg, -180.0);
    EXPECT_LE(back.roll_deg, 180.0);
    EXPECT_LE(std::abs(back.pitch_deg), 90.0);
    const CameraPose again = to_camera(back, radius_m);
    axes_bound.add(exact::angle(vec(again.axes.right), vec(camera.axes.right)), kToPoseAxesError_rad);
    axes_bound.add(exact::angle(vec(again.axes.up), vec(camera.axes.up)), kToPoseAxesError_rad);
    axes_bound.add(exact::angle(vec(again.axes.forward), vec(camera.axes.forward)), kToPoseAxesError_rad);
    position.add(exact::length(vec(again.position_m) - vec(camera.position_m)),
                 kToPosePositionError * (radius_m + pose.alt_m));
  }
}

TEST(Pose, AnglesOfOrdinaryPosesComeBack) {
  test_support::Random random(5);
  for (int n = 0; n < 10000; ++n) {
    const Pose pose{random.uniform(-179, 179), random.uniform(-89, 89), random.uniform(-5000, 1e6),
                    random.uniform(-179, 179), random.uniform(-89, 89), random.uniform(-179, 179)};
    const Pose back = to_pose(to_camera(pose, kMarsRadius_m), kMarsRadius_m);
    ASSERT_NEAR(back.lon_deg, pose.lon_deg, 1e-11);
    ASSERT_NEAR(back.lat_deg, pose.lat_deg, 1e-12);
    ASSERT_NEAR(back.alt_m, pose.alt_m, 1e-8);
    ASSERT_NEAR(back.yaw_deg, pose.yaw_deg, 2e-11);
    ASSERT_NEAR(back.pitch_deg, pose.pitch_deg, 1e-12);
    ASSERT_NEAR(back.roll_deg, pose.roll_deg, 2e-11);
  }
}

TEST(Pose, StraightUpAndDownHaveNoRoll) {
  for (const double pitch : {90.0, -90.0}) {
    for (const double yaw : {0.0, 33.0, -120.0, 180.0}) {
      for (const double roll : {0.0, 20.0, -170.0}) {
        const Pose back = to_pose(to_camera({10, 20, 500, yaw, pitch, roll}, kMarsRadius_m), kMarsRadius_m);
        EXPECT_NEAR(back.pitch_deg, pitch, 1e-12);
        EXPECT_NEAR(back.roll_deg, 0, 1e-12);
      }
    }
  }
}

TEST(Pose, NoNumberIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(to_camera({nan, 0, 0, 0, 0, 0}, 1).position_m.x));
  EXPECT_TRUE(std::isnan(to_camera({0, 0, 0, nan, 0, 0}, 1).axes.forward.x));
  EXPECT_TRUE(std::isnan(to_camera({0, 0, nan, 0, 0, 0}, 1).position_m.x));
}

}  // namespace
}  // namespace mars
