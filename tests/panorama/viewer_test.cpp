// The viewer: directions and screen positions, limits, turning and zooming.
#include "panorama/viewer/viewer.h"
#include "panorama/viewer/head_offset.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

using panorama::Direction;
using panorama::Viewer;
using panorama::ViewerLimits;

constexpr double kDeg = mars::kRadiansPerDegree;

// Elevations of +-45 degrees.
const panorama::PanoramaMap kCylinder = panorama::cylinder_map(6284, 2000, 6283.1853, -180.0, 1000.0);
const panorama::PanoramaMap kSphere = panorama::equirectangular_map(4000, 2000, 4000, 0.0, 1000.0);

double apart_deg(const Direction& a, const Direction& b) {
  return std::max(std::abs(std::remainder(a.azimuth_deg - b.azimuth_deg, 360.0)),
                  std::abs(a.elevation_deg - b.elevation_deg));
}

// Independent of View: by the definition of azimuth and elevation.
TEST(Viewer, TheHorizonIsAtanOfTheColumn) {
  Viewer viewer(kCylinder, 800, 600);
  viewer.set_fov(50.0);
  viewer.look_at(350.0, 0.0);
  const double focal_px = 300.0 / std::tan(25.0 * kDeg);
  for (const double x : {0.0, 123.5, 400.0, 799.0}) {
    const Direction d = viewer.direction(x, 300.0);
    EXPECT_NEAR(std::remainder(d.azimuth_deg - 350.0 - std::atan((x - 400.0) / focal_px) / kDeg, 360.0), 0.0,
                1e-10);
    EXPECT_NEAR(d.elevation_deg, 0.0, 1e-12);
  }
  viewer.look_at(350.0, 12.0);
  EXPECT_NEAR(viewer.direction(400.0, 0.0).elevation_deg, 12.0 + 25.0, 1e-10);
  EXPECT_NEAR(viewer.direction(400.0, 600.0).elevation_deg, 12.0 - 25.0, 1e-10);
}

TEST(Viewer, TwentyDirectionsComeBackAcrossTheWrap) {
  for (const panorama::PanoramaMap& map :
       {kCylinder, kSphere, panorama::faceted_map(8, 500, 1500, 30.0, 700.0)}) {
    for (const double turns : {-720.0, 0.0, 360.0 * 1000}) {
      for (int n = 0; n < 20; ++n) {
        const Direction known{std::fmod(340.0 + 2.1 * n, 360.0), -15.0 + 1.5 * n};
        Viewer viewer(map, 1280, 720);
        viewer.look_at(turns + 358.0 + n % 5, 2.0);
        const auto at = viewer.screen(known);
        ASSERT_TRUE(at);
        EXPECT_LT(apart_deg(viewer.direction(at->x, at->y), known), 1e-10);
        // The pixel that it falls into is at most half a pixel away.
        const Direction pixel = viewer.direction(std::floor(at->x) + 0.5, std::floor(at->y) + 0.5);
        const auto again = viewer.screen(pixel);
        ASSERT_TRUE(again);
        EXPECT_LE(std::abs(again->x - at->x), 0.5 + 1e-9);
        EXPECT_LE(std::abs(again->y - at->y), 0.5 + 1e-9);
      }
    }
  }
}

TEST(Viewer, WhatIsBehindIsNotOnTheScreen) {
  Viewer viewer(kSphere, 640, 480);
  viewer.look_at(90.0, 0.0);
  EXPECT_FALSE(viewer.screen({270.0, 0.0}));
  EXPECT_FALSE(viewer.screen({181.0, 0.0}));
  const auto east_of_it = viewer.screen({100.0, 0.0});
  ASSERT_TRUE(east_of_it);
  EXPECT_GT(east_of_it->x, 320.0);  // clockwise is to the right
}

TEST(Viewer, PitchEndsAtTheImage) {
  Viewer viewer(kCylinder, 1000, 500);
  viewer.set_fov(40.0);
  viewer.look_at(0.0, 80.0);
  EXPECT_NEAR(viewer.pitch_deg(), 45.0 - 20.0, 1e-6);
  EXPECT_NEAR(viewer.direction(500.0, 0.0).elevation_deg, 45.0, 1e-6);
  viewer.turn(10.0, -200.0);
  EXPECT_NEAR(viewer.pitch_deg(), -25.0, 1e-6);
  viewer.set_fov(100.0);  // higher than the image
  EXPECT_NEAR(viewer.pitch_deg(), 0.0, 1e-9);
  EXPECT_NEAR(viewer.direction(500.0, 0.0).elevation_deg, 50.0, 1e-9);

  Viewer whole(kSphere, 1000, 500);
  whole.look_at(0.0, 95.0);
  EXPECT_EQ(whole.pitch_deg(), 90.0);
  whole.look_at(0.0, -1e9);
  EXPECT_EQ(whole.pitch_deg(), -90.0);
}

TEST(Viewer, FacetsAreSeenWholeAtTheirCorners) {
  const panorama::PanoramaMap map = panorama::faceted_map(4, 400, 600, 0.0, 250.0);
  const panorama::ElevationRange range = panorama::elevations_of(map);
  const double corner_px = std::hypot(200.0, 200.0);  // four facets: focal length = half a width
  EXPECT_NEAR(range.high_deg, std::atan(250.0 / corner_px) / kDeg, 1e-9);
  EXPECT_NEAR(range.low_deg, -std::atan(350.0 / corner_px) / kDeg, 1e-9);
}

TEST(Viewer, YawIsKept) {
  Viewer viewer(kCylinder, 640, 480);
  viewer.look_at(10.0, 0.0);
  for (int n = 0; n < 100; ++n) viewer.turn(36.0, 0.0);
  EXPECT_NEAR(viewer.yaw_deg(), 3610.0, 1e-9);
  EXPECT_NEAR(viewer.direction(320.0, 240.0).azimuth_deg, 10.0, 1e-9);
}

TEST(Viewer, FieldOfViewHasLimits) {
  Viewer viewer(kCylinder, 800, 600);
  viewer.set_fov(170.0);
  EXPECT_EQ(viewer.fov_deg(), ViewerLimits::kMaxFov_deg);
  viewer.set_fov(1e-9);
  // A pixel of the image (1000 to a radian) is 16 wide in the middle of the screen.
  const double focal_px = 300.0 / std::tan(0.5 * viewer.fov_deg() * kDeg);
  EXPECT_NEAR(focal_px / 1000.0, ViewerLimits::kMaxMagnification, 1e-6);
  const double before = viewer.fov_deg();
  viewer.set_fov(NAN);
  viewer.look_at(NAN, 3.0);
  viewer.zoom(0.0, 1.0, 1.0);
  viewer.zoom(-2.0, 1.0, 1.0);
  viewer.hold({NAN, 0.0}, 1.0, 1.0);
  EXPECT_EQ(viewer.fov_deg(), before);
  EXPECT_TRUE(std::isfinite(viewer.yaw_deg()));
}

TEST(Viewer, ZoomKeepsWhatIsUnderTheCursor) {
  test_support::Random random(20261122);
  int ends = 0;
  for (int n = 0; n < 2000; ++n) {
    Viewer viewer(kSphere, 900, 700);
    const double azimuth_deg = random.uniform(-1000.0, 1000.0);
    viewer.look_at(azimuth_deg, random.uniform(-60.0, 60.0));
    viewer.set_fov(random.uniform(20.0, 80.0));
    const double x = random.uniform(0.0, 900.0);
    const double y = random.uniform(0.0, 700.0);
    const Direction under = viewer.direction(x, y);
    const double yaw_deg = viewer.yaw_deg();
    viewer.zoom(random.uniform(0.8, 3.0), x, y);
    // Straight up or down is the end, and a level screen's side does not reach the zenith.
    const double f = vpe::core::focal_px(viewer.view());
    const double u = (x - 450.0) / f;
    const double v = (y - 350.0) / f;
    const double highest_deg = std::acos(std::abs(u) / std::sqrt(1.0 + u * u + v * v)) / kDeg;
    if (std::abs(viewer.pitch_deg()) == 90.0 || std::abs(under.elevation_deg) >= highest_deg) {
      ++ends;
      continue;
    }
    EXPECT_LT(glm::length(panorama::to_vector(viewer.direction(x, y)) - panorama::to_vector(under)), 1e-11)
        << n;
    EXPECT_LE(std::abs(viewer.yaw_deg() - yaw_deg), 180.0);
  }
  EXPECT_LT(ends, 20);
}

TEST(Viewer, DraggingAcrossNorthGoesOn) {
  Viewer viewer(kSphere, 900, 700);
  viewer.look_at(359.0, 0.0);
  const Direction grabbed = viewer.direction(100.0, 350.0);
  viewer.hold(grabbed, 0.0, 350.0);
  EXPECT_GT(viewer.yaw_deg(), 360.0);  // not back to 5
  EXPECT_LT(viewer.yaw_deg(), 375.0);
}

TEST(HeadOffset, IsSeenFromABodyThatFacesTheAzimuth) {
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-12; };
  // To the north right is east, behind is south; to the east right is south, behind is west. Up is up.
  EXPECT_TRUE(near(panorama::head_offset(0, {1, 2, 3}), {1, -3, 2}));
  EXPECT_TRUE(near(panorama::head_offset(90, {1, 2, 3}), {-3, -1, 2}));
  EXPECT_TRUE(near(panorama::head_offset(450, {1, 2, 3}), {-3, -1, 2}));
  // Those of the level axes of a view there.
  const mars::Axes axes = panorama::view_of(123, 0, 60, 100, 100).camera.axes;
  EXPECT_TRUE(near(panorama::head_offset(123, {1, 2, 3}), axes.right + 2.0 * axes.up - 3.0 * axes.forward));
}

}  // namespace
