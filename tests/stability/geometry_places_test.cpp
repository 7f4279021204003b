// Places, poses and pixels on planets of any size, at heights from 1e-7 to ten radii, where charts and
// longitudes meet.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "mars/geodesy/pose.h"
#include "tests/stability/terrains.h"
#include "tests/support/worst.h"
#include "vpe/core/view.h"

namespace {

namespace core = vpe::core;
using test_support::hostile_places;
using test_support::Random;
using test_support::record_worst;

constexpr double kRadii_m[] = {1, 1e3, mars::kMarsRadius_m, 1e8};
constexpr double kHeights[] = {1e-9, 1e-7, 1e-4, 0.1, 1, 10};  // in radii

double largest_difference(const mars::Axes& a, const mars::Axes& b) {
  return std::max(
      {glm::length(a.right - b.right), glm::length(a.up - b.up), glm::length(a.forward - b.forward)});
}

TEST(GeometryPlaces, PosesComeBackFromCameras) {
  Random random(301);
  double position = 0;
  double axes = 0;
  double height = 0;
  for (const double radius_m : kRadii_m) {
    for (const double up : kHeights) {
      for (const mars::LonLat& place : hostile_places()) {
        const mars::Pose pose{
            place.lon_deg,
            place.lat_deg,
            up * radius_m,
            random.integer(0, 2) == 0 ? 90.0 * random.integer(-2, 2) : random.uniform(-180, 180),
            random.integer(0, 2) == 0 ? 90.0 * random.integer(-1, 1) : random.uniform(-90, 90),
            random.integer(0, 2) == 0 ? 180.0 : random.uniform(-180, 180)};
        const mars::CameraPose camera = mars::to_camera(pose, radius_m);
        const mars::Pose back = mars::to_pose(camera, radius_m);
        const mars::CameraPose again = mars::to_camera(back, radius_m);
        const double away = glm::length(camera.position_m);
        position = std::max(position, glm::length(again.position_m - camera.position_m) / away);
        axes = std::max(axes, largest_difference(again.axes, camera.axes));
        height = std::max(height, std::abs(back.alt_m - pose.alt_m) / away);
        ASSERT_TRUE(mars::is_valid({back.lon_deg, back.lat_deg}));
        ASSERT_LE(std::abs(back.pitch_deg), 90.0);
      }
    }
  }
  record_worst("pose from camera: place, any radius", position, mars::kToPosePositionError,
               "of the distance from the centre");
  record_worst("pose from camera: axes, any radius", axes, mars::kToPoseAxesError_rad, "rad");
  record_worst("pose from camera: altitude", height, 1e-15, "of the distance from the centre");
}

TEST(GeometryPlaces, EveryPlaceIsOnAChartAndComesBack) {
  double angle = 0;
  double lines = 0;
  for (const mars::LonLat& place : hostile_places()) {
    const glm::dvec3 d = mars::direction(place);
    const mars::ChartPoint at = mars::chart_point(d);
    ASSERT_LE(std::abs(at.u), 1.0);
    ASSERT_LE(std::abs(at.v), 1.0);
    angle = std::max(angle, mars::angle_between_rad(mars::chart_direction(at.face, at.u, at.v), d));
    const mars::LonLat back = mars::lon_lat(d);
    angle = std::max(angle, mars::angle_between_rad(mars::direction(back), d));
    lines = std::max(lines, std::abs(mars::face_parameter(at.u) - 0.5) - 0.5);
  }
  record_worst("place to chart or longitude and back", angle,
               mars::kLonLatError_rad + mars::kChartDirectionError_rad, "rad");
  EXPECT_LE(lines, 0.0);
}

// Moving by 1e-9 degrees over a pole, the antimeridian or an edge of the cube moves the camera by exactly that
// angle.
TEST(GeometryPlaces, NothingJumpsBetweenNeighbours) {
  constexpr double kStep_deg = 1e-9;
  double jump = 0;
  for (const mars::LonLat& place : hostile_places()) {
    const mars::CameraPose camera =
        mars::to_camera({place.lon_deg, place.lat_deg, 10, 30, -10, 5}, mars::kMarsRadius_m);
    const glm::dvec3 up = glm::normalize(camera.position_m);
    for (int n = 0; n < 16; ++n) {
      const mars::LonLat next =
          mars::destination(mars::lon_lat(up), 22.5 * n, kStep_deg * mars::kRadiansPerDegree);
      const double moved = mars::angle_between_rad(mars::direction(next), up) / mars::kRadiansPerDegree;
      jump = std::max(jump, std::abs(moved - kStep_deg));
    }
  }
  record_worst("a step of 1e-9 degrees at poles, edges and the antimeridian", jump, 3e-13, "degrees off");
}

// Every projection at its narrowest and widest: what a pixel sees is projected to that pixel.
TEST(GeometryPlaces, PixelsComeBackAtAnyFieldOfView) {
  Random random(302);
  double off_px = 0;
  double wide_off_px = 0;
  for (const double fov_deg : {0.01, 0.1, 1.0, 60.0, 150.0, 179.0}) {
    for (const core::Projection projection :
         {core::Projection::kPerspective, core::Projection::kCylinder, core::Projection::kEquirectangular}) {
      for (int n = 0; n < 300; ++n) {
        const mars::LonLat place = hostile_places()[static_cast<std::size_t>(random.integer(0, 159))];
        core::View view;
        view.projection = projection;
        view.fov_deg = fov_deg;
        view.width = 1920;
        view.height = 1080;
        const double height_m = random.log_uniform(0.1, 3e7);
        view.camera = mars::to_camera({place.lon_deg, place.lat_deg, height_m, random.uniform(0, 360),
                                       random.uniform(-90, 90), random.uniform(-180, 180)},
                                      mars::kMarsRadius_m);
        ASSERT_EQ(core::check(view), "");
        const glm::dvec2 at{random.uniform(0, 1920), random.uniform(0, 1080)};
        const glm::dvec3 ray = core::pixel_ray(view, at.x, at.y);
        // As far as the ground is at least, so that the camera's own rounding does not count.
        const core::Projected back = core::project(view, view.camera.position_m + ray * 1e9);
        ASSERT_FALSE(back.behind);
        double across = std::abs(back.xy.x - at.x);
        if (projection != core::Projection::kPerspective) across = std::min(across, 1920 - across);
        const double off = std::max(across, std::abs(back.xy.y - at.y));
        double& worst = fov_deg < 100 ? off_px : wide_off_px;
        worst = std::max(worst, off);
      }
    }
  }
  record_worst("pixel to ray and back, field of view 0.01 to 60 degrees", off_px, 1e-8, "px");
  record_worst("pixel to ray and back, field of view 150 to 179 degrees", wide_off_px, 1e-8, "px");
}

}  // namespace
