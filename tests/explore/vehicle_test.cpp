#include "vpe/explore/vehicle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <random>
#include <vector>

#include "tests/explore/terrain_support.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

constexpr double kR = mars::kMarsRadius_m;

// The least-squares plane z = a + b x + c y by the full normal equations, with x to the east and y to the north of
// the place, from wheels placed by bearings and distances.
struct Plane {
  double a = 0;
  glm::dvec3 normal{0, 0, 1};  // east, north, up
};
Plane plane_under(mars::LonLat place, double heading_deg, const VehicleOptions& o, const TerrainQuery& ground) {
  glm::dmat3 sums(0);
  glm::dvec3 rhs(0);
  for (int row = 0; row < o.wheels / 2; ++row) {
    for (const double side : {-1.0, 1.0}) {
      const double x_m = side * o.width_m / 2;
      const double y_m = o.length_m * row / (o.wheels / 2 - 1) - o.length_m / 2;
      const double bearing_deg = heading_deg + std::atan2(x_m, y_m) / mars::kRadiansPerDegree;
      const double way_m = std::hypot(x_m, y_m);
      const mars::LonLat wheel = mars::destination(place, bearing_deg, way_m / kR);
      const double z = ground.height_m(mars::direction(wheel));
      const glm::dvec3 v(1, way_m * std::sin(bearing_deg * mars::kRadiansPerDegree),
                         way_m * std::cos(bearing_deg * mars::kRadiansPerDegree));
      sums += glm::outerProduct(v, v);
      rhs += v * z;
    }
  }
  const glm::dvec3 solved = glm::inverse(sums) * rhs;
  return {solved.x, glm::normalize(glm::dvec3(-solved.y, -solved.z, 1))};
}

TEST(Vehicle, TheAttitudeIsThatOfTheLeastSquaresPlane) {
  const TerrainQuery ground = rough_ground();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  double worst_deg = 0;
  double steepest_deg = 0;
  for (int n = 0; n < 2000; ++n) {
    VehicleOptions o;
    o.wheels = 4 + 2 * (n % 4);
    const mars::LonLat place{180 * unit(random), 80 * unit(random)};
    const double heading_deg = 180 * unit(random);
    const Vehicle vehicle = placed(place, heading_deg, o, ground);
    const Plane plane = plane_under(place, heading_deg, o, ground);
    const mars::Axes axes = mars::to_camera(vehicle.pose, kR).axes;
    const mars::LocalFrame frame = mars::local_frame(place);
    const glm::dvec3 normal =
        frame.east * plane.normal.x + frame.north * plane.normal.y + frame.up * plane.normal.z;
    worst_deg = std::max(worst_deg, mars::angle_between_rad(axes.up, normal) / mars::kRadiansPerDegree);
    steepest_deg = std::max(steepest_deg, vehicle.contact.slope_deg);
    EXPECT_NEAR(vehicle.contact.plane_m, plane.a, 1e-4);
    EXPECT_NEAR(vehicle.contact.slope_deg, std::acos(plane.normal.z) / mars::kRadiansPerDegree, 1e-3);
    // Ahead is where the heading points to.
    EXPECT_NEAR(glm::dot(axes.forward, frame.east * std::cos(heading_deg * mars::kRadiansPerDegree) -
                                           frame.north * std::sin(heading_deg * mars::kRadiansPerDegree)),
                0, 1e-9);
  }
  EXPECT_LT(worst_deg, 1e-3);
  EXPECT_GT(steepest_deg, 30) << "the ground is rough";
}

TEST(Vehicle, SignsOnASlope) {
  const VehicleOptions o;
  // 10 % upwards to the east, 5 % to the north.
  const TerrainQuery ground = sloping_ground(0.1, 0.05);
  const Contact east = contact({0, 0}, 90, o, ground);
  EXPECT_NEAR(east.pitch_deg, std::atan(0.1) / mars::kRadiansPerDegree, 1e-3);
  EXPECT_GT(east.roll_deg, 0) << "the right side, in the south, is down";
  const Contact west = contact({0, 0}, -90, o, ground);
  EXPECT_NEAR(west.pitch_deg, -east.pitch_deg, 1e-3);
  EXPECT_NEAR(west.roll_deg, -east.roll_deg, 1e-3);
  EXPECT_NEAR(east.residual_m, 0, 1e-6);
}

TEST(Vehicle, GoesInACircleOfItsTurningRadius) {
  const TerrainQuery ground = ball(kR);
  VehicleOptions o;
  o.turning_radius_m = 5;
  Vehicle vehicle = placed({0, 0}, 0, o, ground);
  double east_most_m = 0;
  double turned_deg = 0;
  for (int n = 0; n < 5000 && turned_deg < 360; ++n) {
    const double before_deg = vehicle.pose.yaw_deg;
    vehicle = driven(vehicle, {.right = 1, .forward = 1}, 0.01, o, ground);
    turned_deg += std::remainder(vehicle.pose.yaw_deg - before_deg, 360.0);
    east_most_m = std::max(east_most_m, vehicle.pose.lon_deg * mars::kRadiansPerDegree * kR);
  }
  EXPECT_NEAR(east_most_m, 10, 0.1);
  EXPECT_NEAR(vehicle.pose.lon_deg * mars::kRadiansPerDegree * kR, 0, 0.2);
  EXPECT_NEAR(vehicle.pose.lat_deg * mars::kRadiansPerDegree * kR, 0, 0.2);
}

TEST(Vehicle, HoldsItsSpeedLimitAndComesToRest) {
  const TerrainQuery ground = ball(kR);
  const VehicleOptions o;
  Vehicle vehicle = placed({0, 0}, 0, o, ground);
  for (int n = 0; n < 400; ++n) vehicle = driven(vehicle, {.forward = 1}, 0.02, o, ground);
  EXPECT_NEAR(vehicle.speed_m_s, o.speed_m_s, 0.01);
  for (int n = 0; n < 400; ++n) vehicle = driven(vehicle, {.forward = 1, .speed = 100}, 0.02, o, ground);
  EXPECT_NEAR(vehicle.speed_m_s, o.fastest_m_s, 0.01);
  for (int n = 0; n < 400; ++n) vehicle = driven(vehicle, {}, 0.02, o, ground);
  EXPECT_EQ(vehicle.speed_m_s, 0);
}

TEST(Vehicle, StopsAtASlopeBeyondItsLimitAndCanLeaveIt) {
  TerrainQuery ground = ball(kR);
  // Level, then 40 degrees upwards from 20 m in the east.
  const double slope = std::tan(40 * mars::kRadiansPerDegree);
  ground.height_m = [slope](const glm::dvec3& d) {
    return slope * std::max(0.0, std::atan2(d.y, d.x) * kR - 20.0);
  };
  const VehicleOptions o;
  Vehicle vehicle = placed({0, 0}, 90, o, ground);
  for (int n = 0; n < 2000 && !vehicle.is_blocked; ++n)
    vehicle = driven(vehicle, {.forward = 1}, 0.02, o, ground);
  EXPECT_TRUE(vehicle.is_blocked);
  EXPECT_EQ(vehicle.speed_m_s, 0);
  EXPECT_LE(vehicle.contact.slope_deg, o.steepest_deg);
  const double east_deg = vehicle.pose.lon_deg;
  for (int n = 0; n < 200; ++n) vehicle = driven(vehicle, {.forward = -1}, 0.02, o, ground);
  EXPECT_LT(vehicle.pose.lon_deg, east_deg);
  EXPECT_FALSE(vehicle.is_blocked);
  // Put on the slope itself, it may go down but not up.
  Vehicle high = placed({25.0 / kR / mars::kRadiansPerDegree, 0}, 90, o, ground);
  EXPECT_GT(high.contact.slope_deg, o.steepest_deg);
  const double alt_m = high.pose.alt_m;
  for (int n = 0; n < 400; ++n) high = driven(high, {.forward = -1}, 0.02, o, ground);
  EXPECT_LT(high.pose.alt_m, alt_m - 2);
}

TEST(Vehicle, TheMastStandsAboveTheGroundInRandomTracks) {
  const TerrainQuery ground = rough_ground();
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> unit(-1, 1);
  VehicleOptions o;
  o.steepest_deg = 60;
  double lowest_m = 1e9;
  double farthest_deg = 0;
  for (int track = 0; track < 10'000; ++track) {
    const mars::LonLat place{180 * unit(random), 90 * unit(random)};
    Vehicle vehicle = placed(place, 180 * unit(random), o, ground);
    Controls controls;
    controls.forward = unit(random);
    controls.right = unit(random);
    controls.speed = std::pow(10.0, unit(random));
    for (int step = 0; step < 20; ++step) {
      vehicle = driven(vehicle, controls, 0.06 + 0.05 * unit(random), o, ground);
      lowest_m = std::min(lowest_m, height_above_ground_m(vehicle.pose, ground));
    }
    farthest_deg =
        std::max(farthest_deg, mars::distance_rad(place, {vehicle.pose.lon_deg, vehicle.pose.lat_deg}));
    ASSERT_TRUE(std::isfinite(vehicle.pose.alt_m));
  }
  EXPECT_GE(lowest_m, o.mast_m - 1e-6);
  EXPECT_GT(farthest_deg * kR, 3);
}

TEST(Vehicle, AStepAsksTheGroundOnceForEachWheelAndTheMiddle) {
  int queries = 0;
  TerrainQuery ground = ball(kR);
  ground.height_m = [&queries](const glm::dvec3&) {
    ++queries;
    return 0.0;
  };
  const VehicleOptions o;
  Vehicle vehicle = placed({0, 0}, 0, o, ground);
  EXPECT_EQ(queries, 7);
  vehicle = driven(vehicle, {}, 0.02, o, ground);
  EXPECT_EQ(queries, 7) << "at rest";
  vehicle = driven(vehicle, {.forward = 1}, 0.02, o, ground);
  EXPECT_EQ(queries, 14);
}

TEST(Vehicle, BadOptionsAreNamed) {
  EXPECT_EQ(problem(VehicleOptions{}), "");
  const auto fault = [](auto change) {
    VehicleOptions o;
    change(o);
    return problem(o);
  };
  EXPECT_NE(fault([](auto& o) { o.wheels = 5; }).find("even"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.wheels = 2; }).find("wheels"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.wheels = 22; }).find("wheels"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.length_m = 0; }).find("length"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.width_m = std::nan(""); }).find("width"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.mast_m = -1; }).find("mast"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.steepest_deg = 90; }).find("slope"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.speed_m_s = 0; }).find("speed"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.fastest_m_s = 1e9; }).find("speed"), std::string::npos);
  EXPECT_NE(fault([](auto& o) { o.turning_radius_m = 0; }).find("radius"), std::string::npos);
}

}  // namespace
}  // namespace vpe::explore
