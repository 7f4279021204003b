#include "objects/scene/place.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/support.h"

namespace objects {
namespace {

using mars::LonLat;

constexpr double kRadius_m = mars::kMarsRadius_m;
constexpr unsigned kSeed = 20261127;

const GroundRadius kSphere = [](const glm::dvec3&) { return kRadius_m; };

// Gives the ground of a plane through a point; `normal` may have any length.
GroundRadius tilted_ground(const glm::dvec3& point_m, const glm::dvec3& normal) {
  return [=](const glm::dvec3& d) { return glm::dot(point_m, normal) / glm::dot(d, normal); };
}

// Gives smooth hills and hollows, metres high and metres apart, around a place.
GroundRadius bumpy_ground(LonLat place) {
  const mars::LocalFrame frame = mars::local_frame(place);
  return [=](const glm::dvec3& d) {
    const double x = kRadius_m * glm::dot(d, frame.east);
    const double y = kRadius_m * glm::dot(d, frame.north);
    return kRadius_m - 2500 + 0.6 * std::sin(1.3 * x) * std::cos(0.9 * y) + 0.3 * std::sin(3.1 * x + 2.3 * y);
  };
}

glm::dvec3 turned(const Instance& instance, const glm::dvec3& model) {
  return glm::dquat(instance.rotation) * model;
}
glm::dvec3 right_of(const Instance& instance) { return turned(instance, {1, 0, 0}); }
glm::dvec3 forward_of(const Instance& instance) { return turned(instance, {0, 1, 0}); }
glm::dvec3 up_of(const Instance& instance) { return turned(instance, {0, 0, 1}); }

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance, const char* what) {
  EXPECT_LT(glm::length(a - b), tolerance) << what;
}

Instance placed(const Placing& placing, const GroundRadius& ground = kSphere) {
  return place_instance(placing, 1, kRadius_m, ground);
}

TEST(Place, AxesFollowHeadingPitchAndRoll) {
  const LonLat place{137.4, -4.6};
  const mars::LocalFrame frame = mars::local_frame(place);
  const double s = std::sin(0.5);
  const double c = std::cos(0.5);
  const double half_rad_deg = 0.5 / mars::kRadiansPerDegree;
  struct Case {
    double heading_deg, pitch_deg, roll_deg;
    glm::dvec3 right, forward, up;
  };
  const Case cases[] = {
      {0, 0, 0, frame.east, frame.north, frame.up},
      {90, 0, 0, -frame.north, frame.east, frame.up},
      {180, 0, 0, -frame.east, -frame.north, frame.up},
      {-90, 0, 0, frame.north, -frame.east, frame.up},
      {0, half_rad_deg, 0, frame.east, c * frame.north + s * frame.up, c * frame.up - s * frame.north},
      {0, 0, half_rad_deg, c * frame.east - s * frame.up, frame.north, c * frame.up + s * frame.east},
      {90, half_rad_deg, 0, -frame.north, c * frame.east + s * frame.up, c * frame.up - s * frame.east},
      {0, 90, 0, frame.east, frame.up, -frame.north},
      {0, 90, 90, frame.north, frame.up, frame.east},  // the roll is about the nose, which is up
  };
  for (const Case& one : cases) {
    Placing placing{.place = place};
    placing.heading_deg = one.heading_deg;
    placing.pitch_deg = one.pitch_deg;
    placing.roll_deg = one.roll_deg;
    const Instance instance = placed(placing);
    expect_near(right_of(instance), one.right, 3e-7, "right");
    expect_near(forward_of(instance), one.forward, 3e-7, "forward");
    expect_near(up_of(instance), one.up, 3e-7, "up");
    EXPECT_NEAR(glm::length(instance.rotation), 1.0F, 2e-7F);
    expect_near(instance.position_m, frame.up * kRadius_m, 1e-8, "position");
  }
}

TEST(Place, RotationsAreThoseOfTheCamera) {
  test_support::Random random(kSeed);
  for (int n = 0; n < 1000; ++n) {
    const LonLat place = mars::lon_lat(random.direction());
    Placing placing{.place = place};
    placing.heading_deg = random.uniform(-360, 360);
    placing.pitch_deg = random.uniform(-360, 360);
    placing.roll_deg = random.uniform(-360, 360);
    const mars::Axes axes =
        mars::oriented_axes(mars::local_frame(place), placing.heading_deg, placing.pitch_deg, placing.roll_deg);
    const Instance instance = placed(placing);
    expect_near(right_of(instance), axes.right, 5e-7, "right");
    expect_near(forward_of(instance), axes.forward, 5e-7, "forward");
    expect_near(up_of(instance), axes.up, 5e-7, "up");
    EXPECT_GE(instance.rotation.w, 0);
  }
}

TEST(Place, HeightsCountFromTheGroundOrFromTheSphere) {
  const GroundRadius ground = [](const glm::dvec3&) { return kRadius_m - 4000; };
  Placing placing{.place = {10, 20}};
  EXPECT_NEAR(glm::length(placed(placing, ground).position_m), kRadius_m - 4000, 1e-8);
  placing.height_m = 2.5;
  EXPECT_NEAR(glm::length(placed(placing, ground).position_m), kRadius_m - 3997.5, 1e-8);
  placing.height_kind = HeightKind::kAltitude;
  EXPECT_NEAR(glm::length(placed(placing, ground).position_m), kRadius_m + 2.5, 1e-8);
  placing.scale = 3;
  EXPECT_EQ(placed(placing, ground).scale, 3.0F);
  placing.scale = 1e-300;
  EXPECT_GT(placed(placing, ground).scale, 0.0F);
}

TEST(Place, PolesAndTheDateLineAreNotSpecial) {
  // At the north pole north is along the meridian of the place, away from it.
  Placing pole{.place = {0, 90}};
  expect_near(placed(pole).position_m, {0, 0, kRadius_m}, 1e-8, "pole");
  expect_near(forward_of(placed(pole)), {-1, 0, 0}, 3e-7, "pole");
  pole.place = {90, -90};
  expect_near(forward_of(placed(pole)), {0, 1, 0}, 3e-7, "south pole");
  pole.follows_slope = true;
  expect_near(forward_of(placed(pole)), {0, 1, 0}, 3e-7, "south pole");
  Placing east{.place = {180, 30}};
  Placing west{.place = {-180, 30}};
  EXPECT_EQ(placed(east), placed(west));
  east.place.lon_deg = 180 - 1e-9;
  expect_near(placed(east).position_m, placed(west).position_m, 1e-4, "date line");
}

TEST(Place, UpIsTheNormalOfATiltedPlaneAndTheHeadingStays) {
  test_support::Random random(kSeed);
  for (int n = 0; n < 2000; ++n) {
    const LonLat place = n == 0 ? LonLat{33, 90} : n == 1 ? LonLat{180, 0} : mars::lon_lat(random.direction());
    const mars::LocalFrame frame = mars::local_frame(place);
    const double slope_deg = random.uniform(0, 60);
    const double azimuth_deg = random.uniform(0, 360);
    const glm::dvec3 downhill =
        frame.north * mars::sin_cos_deg(azimuth_deg).cos + frame.east * mars::sin_cos_deg(azimuth_deg).sin;
    const glm::dvec3 normal =
        frame.up * mars::sin_cos_deg(slope_deg).cos + downhill * mars::sin_cos_deg(slope_deg).sin;
    Placing placing{.place = place};
    placing.heading_deg = random.uniform(0, 360);
    placing.follows_slope = true;
    const GroundRadius ground = tilted_ground(frame.up * (kRadius_m + 1000), normal);
    const Instance instance = place_instance(placing, random.uniform(0.2, 20), kRadius_m, ground);
    EXPECT_LT(glm::length(up_of(instance) - normal), 1e-6);
    expect_near(instance.position_m, frame.up * (kRadius_m + 1000), 1e-7, "position");
    const glm::dvec3 forward = forward_of(instance);
    const glm::dvec3 across = frame.east * mars::sin_cos_deg(placing.heading_deg).cos -
                              frame.north * mars::sin_cos_deg(placing.heading_deg).sin;
    EXPECT_LT(std::abs(glm::dot(forward, across)), 1e-6);
    EXPECT_GT(glm::dot(forward, glm::cross(frame.up, across)), 0);
    // Pitch and roll count from the plane.
    placing.pitch_deg = 30;
    const Instance pitched = place_instance(placing, 1, kRadius_m, ground);
    EXPECT_NEAR(glm::dot(forward_of(pitched), normal), 0.5, 1e-6);
    placing.pitch_deg = 0;
    placing.roll_deg = 30;
    EXPECT_NEAR(glm::dot(right_of(place_instance(placing, 1, kRadius_m, ground)), normal), -0.5, 1e-6);
  }
}

TEST(Place, TinyFeetAreTakenApart) {
  const mars::LocalFrame frame = mars::local_frame({20, 10});
  const glm::dvec3 normal = glm::normalize(frame.up + 0.5 * frame.east);
  Placing placing{.place = {20, 10}};
  placing.follows_slope = true;
  const Instance instance = place_instance(placing, 0, kRadius_m, tilted_ground(frame.up * kRadius_m, normal));
  expect_near(up_of(instance), normal, 1e-6, "up");
}

std::array<glm::dvec3, 4> wheels_of(const Instance& instance, const PathEntry& path) {
  const glm::dvec3 right = right_of(instance) * (0.5 * path.track_m);
  const glm::dvec3 ahead = forward_of(instance) * (0.5 * path.wheelbase_m);
  const glm::dvec3& p = instance.position_m;
  return {p + right + ahead, p + right - ahead, p - right + ahead, p - right - ahead};
}

// Returns the largest height of the wheels above the ground, and the smallest.
std::pair<double, double> heights_m(const Instance& instance, const PathEntry& path,
                                    const GroundRadius& ground) {
  double most = -1e9;
  double least = 1e9;
  for (const glm::dvec3& wheel : wheels_of(instance, path)) {
    const double height_m = glm::length(wheel) - ground(glm::normalize(wheel));
    most = std::max(most, height_m);
    least = std::min(least, height_m);
  }
  return {most, least};
}

PathEntry rover_path(LonLat from, LonLat to) {
  PathEntry path;
  path.model = 3;
  path.points = {{10, from}, {110, to}};
  path.scale = 2;
  path.wheelbase_m = 2.4;
  path.track_m = 1.9;
  return path;
}

TEST(PathInstance, MovesAtConstantSpeedAlongAGreatCircle) {
  PathEntry path = rover_path({0, 0}, {90, 0});
  path.points.push_back({210, {90, 45}});
  path.wheelbase_m = 0;
  for (const double part : {0.0, 0.1, 0.5, 0.9}) {
    const Instance instance = path_instance(path, 10 + 100 * part, kSphere);
    const mars::LocalFrame frame = mars::local_frame({90 * part, 0});
    expect_near(instance.position_m, frame.up * kRadius_m, 1e-7, "position");
    expect_near(forward_of(instance), frame.east, 3e-7, "forward");
    expect_near(up_of(instance), frame.up, 3e-7, "up");
    EXPECT_EQ(instance.model, 3U);
    EXPECT_EQ(instance.scale, 2.0F);
  }
  const Instance later = path_instance(path, 160, kSphere);
  expect_near(later.position_m, mars::direction({90, 22.5}) * kRadius_m, 1e-7, "position");
  expect_near(forward_of(later), mars::local_frame({90, 22.5}).north, 3e-7, "forward");
}

TEST(PathInstance, CrossesPoleAndDateLine) {
  const PathEntry over = rover_path({20, 89}, {-160, 89});
  const Instance top = path_instance(over, 60, kSphere);
  expect_near(top.position_m, {0, 0, kRadius_m}, 1, "pole");
  expect_near(forward_of(top), -mars::direction({20, 0}), 1e-6, "pole");
  const PathEntry line = rover_path({179, 0}, {-179, 0});
  const Instance middle = path_instance(line, 60, kSphere);
  expect_near(glm::normalize(middle.position_m), mars::direction({180, 0}), 1e-9, "date line");
  expect_near(forward_of(middle), {0, -1, 0}, 1e-6, "date line");
  // Antipodes: some great circle, the same all the way.
  const PathEntry far = rover_path({0, 0}, {180, 0});
  const glm::dvec3 pole = glm::cross(glm::normalize(path_instance(far, 20, kSphere).position_m),
                                     forward_of(path_instance(far, 20, kSphere)));
  for (const double t : {30.0, 60.0, 100.0}) {
    const Instance on = path_instance(far, t, kSphere);
    EXPECT_LT(std::abs(glm::dot(glm::normalize(on.position_m), pole)), 2e-6);
    EXPECT_LT(std::abs(glm::dot(forward_of(on), pole)), 2e-6);
  }
}

TEST(PathInstance, StandsStillAtTheEnds) {
  const GroundRadius ground = bumpy_ground({30, 40});
  const PathEntry path = rover_path({30, 40}, {30.001, 40.001});
  const Instance first = path_instance(path, 10, ground);
  const Instance last = path_instance(path, 110, ground);
  for (const double before : {-1e12, 0.0, 9.999}) EXPECT_EQ(path_instance(path, before, ground), first);
  for (const double after : {110.001, 1e12}) EXPECT_EQ(path_instance(path, after, ground), last);
  EXPECT_NE(first, last);
  PathEntry single = path;
  single.points.resize(1);
  const Instance alone = path_instance(single, 50, kSphere);
  expect_near(glm::normalize(alone.position_m), mars::direction({30, 40}), 1e-12, "single");
  expect_near(forward_of(alone), mars::local_frame({30, 40}).north, 1e-6, "single");
}

TEST(PathInstance, HeadingsAreThoseOfThePointOrOfTheWay) {
  PathEntry path;
  path.points = {{0, {0, 0}}, {10, {0, 1}}, {20, {0, 1}}, {30, {1, 1}, 200}, {40, {1, 1}, 10}, {50, {2, 1}}};
  const auto heading_deg = [&path](double t) {
    const Instance instance = path_instance(path, t, kSphere);
    const mars::Pose pose = mars::to_pose(
        {instance.position_m, {right_of(instance), up_of(instance), forward_of(instance)}}, kRadius_m);
    return pose.yaw_deg < -1e-3 ? pose.yaw_deg + 360 : pose.yaw_deg;
  };
  EXPECT_NEAR(heading_deg(-5), 0, 1e-4);
  EXPECT_NEAR(heading_deg(5), 0, 1e-4);
  EXPECT_NEAR(heading_deg(15), 0, 1e-4);  // waits as it came
  EXPECT_NEAR(heading_deg(25), 90, 1e-2);
  EXPECT_NEAR(heading_deg(35), 200, 1e-4);
  EXPECT_NEAR(heading_deg(45), 10, 1e-4);
  EXPECT_NEAR(heading_deg(99), 90, 2e-2);  // as it came
  // A path that begins with waiting looks to where it will go.
  path.points = {{0, {0, 0}}, {10, {0, 0}}, {20, {-1, 0}}};
  EXPECT_NEAR(heading_deg(5), 270, 1e-4);
  path.points.back().place = {0, 0};
  EXPECT_NEAR(heading_deg(5), 0, 1e-4);
}

TEST(PathInstance, WheelsTouchATiltedPlane) {
  test_support::Random random(kSeed);
  for (int n = 0; n < 1000; ++n) {
    const LonLat place = mars::lon_lat(random.direction());
    const mars::LocalFrame frame = mars::local_frame(place);
    const glm::dvec3 normal = glm::normalize(frame.up + frame.east * random.uniform(-0.7, 0.7) +
                                             frame.north * random.uniform(-0.7, 0.7));
    const GroundRadius ground = tilted_ground(frame.up * (kRadius_m - 3000), normal);
    const PathEntry path = rover_path(place, mars::destination(place, random.uniform(0, 360), 1e-5));
    const Instance instance = path_instance(path, random.uniform(10, 110), ground);
    const auto [most, least] = heights_m(instance, path, ground);
    EXPECT_LT(most, 1e-6);
    EXPECT_GT(least, -wheel_error_m(path.wheelbase_m, path.track_m));
    EXPECT_LT(glm::length(up_of(instance) - normal), 1e-6);
    EXPECT_NEAR(glm::length(instance.position_m), ground(glm::normalize(instance.position_m)), 1e-6);
  }
}

TEST(PathInstance, NoWheelIsBelowBumpyGround) {
  test_support::Random random(kSeed);
  const LonLat place{77.4, 18.4};
  const GroundRadius ground = bumpy_ground(place);
  double worst_m = 1e9;
  double highest_m = 0;
  for (int n = 0; n < 10000; ++n) {
    PathEntry path = rover_path(mars::destination(place, random.uniform(0, 360), random.uniform(0, 1e-4)),
                                mars::destination(place, random.uniform(0, 360), random.uniform(0, 1e-4)));
    path.wheelbase_m = random.uniform(0.3, 4);
    path.track_m = random.uniform(0.3, 4);
    const Instance instance = path_instance(path, random.uniform(10, 110), ground);
    const auto [most, least] = heights_m(instance, path, ground);
    EXPECT_GT(least, -wheel_error_m(path.wheelbase_m, path.track_m));
    EXPECT_LT(least, 1.5);  // it does not hover
    worst_m = std::min(worst_m, least);
    highest_m = std::max(highest_m, least);
    EXPECT_EQ(path_instance(path, 50, ground), path_instance(path, 50, ground));
  }
  RecordProperty("lowest_wheel_m", std::to_string(worst_m));
  RecordProperty("highest_lowest_wheel_m", std::to_string(highest_m));
}

TEST(PathInstance, WheelsStandOnSmallBodies) {
  const GroundRadius ground = [](const glm::dvec3& d) {
    return 100 + 3 * std::sin(9 * d.x) * std::cos(7 * d.z);
  };
  test_support::Random random(kSeed);
  for (int n = 0; n < 1000; ++n) {
    const PathEntry path = rover_path(mars::lon_lat(random.direction()), mars::lon_lat(random.direction()));
    const Instance instance = path_instance(path, random.uniform(10, 110), ground);
    EXPECT_GT(heights_m(instance, path, ground).second, -wheel_error_m(path.wheelbase_m, path.track_m));
  }
}

}  // namespace
}  // namespace objects
