// Where the eyes of panoramas show points.
#include "panorama/eye_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "panorama/panorama_plan.h"
#include "panorama/stereo_pieces.h"
#include "tests/panorama/stereo_fixture.h"
#include "tests/support/support.h"

namespace panorama {
namespace {

const mars::Pose kStand{137.4, -4.6, 2000, 0, 0, 0};
const Viewpoint kStandpoint = viewpoint_of(kStand, mars::kMarsRadius_m);

PanoramaMap planned(MapKind kind, std::optional<Arc> arc = {}) {
  PlanOptions options;
  options.kind = kind;
  options.width_px = 4096;
  options.yaw_deg = 33;
  options.arc = arc;
  return plan_panorama(options).map;
}

TEST(EyeProjection, OfTheViewpointIsThatOfThePieces) {
  test_support::Random random(71);
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular, MapKind::kFacets}) {
    const PanoramaMap map = planned(kind);
    const EyeProjection projection(map, kStandpoint);
    for (const Strip& strip : strips_of(map)) {
      for (const Piece& piece : pieces_of(map, kStandpoint, strip, 0)) {
        for (int n = 0; n < 20; ++n) {
          const glm::dvec2 at(random.uniform(0, piece.width), random.uniform(0, piece.height));
          const vpe::core::SubRectangle part = vpe::core::drawn_part(piece.view);
          const glm::dvec3 point_m =
              piece.view.camera.position_m +
              random.log_uniform(1, 1e6) * vpe::core::pixel_ray(piece.view, part.x + at.x, part.y + at.y);
          const auto seen = projection.project(point_m);
          ASSERT_TRUE(seen);
          EXPECT_EQ(seen->seen_from_m, kStandpoint.position_m);
          const double x = static_cast<double>(piece.x) + at.x;
          EXPECT_NEAR(std::remainder(seen->at_px.x - x, map.turn_px), 0, 1e-4);
          EXPECT_NEAR(seen->at_px.y, static_cast<double>(piece.y) + at.y, 1e-4);
        }
      }
    }
  }
}

TEST(EyeProjection, OfAPairIsThatOfItsDefinition) {
  test_support::Random random(72);
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular}) {
    const PanoramaMap map = planned(kind);
    for (const double base_m : {0.065, 3.0, 200.0}) {
      const test_support::TwoEyes eyes(kStand, mars::kMarsRadius_m, base_m);
      for (const Eye eye : {Eye::kLeft, Eye::kRight}) {
        const EyeProjection projection(map, kStandpoint, eye, base_m);
        for (int n = 0; n < 300; ++n) {
          const glm::dvec3 ray = random.direction();
          const double up = glm::dot(ray, kStandpoint.frame.up);
          if (std::abs(up) > 0.99) continue;
          const glm::dvec3 point_m =
              kStandpoint.position_m + ray * random.log_uniform(base_m / kMostBase, 1e4 * base_m);
          const auto seen = projection.project(point_m);
          ASSERT_TRUE(seen);
          const glm::dvec2 is = map.place(eyes.seen(eye, point_m));
          EXPECT_NEAR(std::remainder(seen->at_px.x - is.x, map.turn_px), 0, 0.1) << up;
          EXPECT_NEAR(seen->at_px.y, is.y, 0.1) << up;
          // The eye is half a base from the viewpoint, or nearer where it fades.
          EXPECT_LE(glm::length(seen->seen_from_m - kStandpoint.position_m), 0.5 * base_m + 1e-8);
        }
      }
    }
  }
}

TEST(EyeProjection, BallsOutOfSightAreToldOnlyIfNoneOfTheirPointsIsSeen) {
  test_support::Random random(73);
  int refused = 0;
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular, MapKind::kFacets}) {
    for (const bool is_arc : {false, true}) {
      const PanoramaMap map = planned(kind, is_arc ? std::optional(Arc{100, 160}) : std::nullopt);
      const EyeProjection projection(map, kStandpoint);
      for (int n = 0; n < 3000; ++n) {
        const glm::dvec3 centre_m = kStandpoint.position_m + random.direction() * random.log_uniform(10, 1e6);
        const double radius_m = random.log_uniform(1, 1e6);
        if (projection.may_show(centre_m, radius_m, 8)) continue;
        ++refused;
        for (int k = 0; k < 10; ++k) {
          const auto seen = projection.project(centre_m + random.direction() * radius_m * random.uniform(0, 1));
          if (!seen) continue;
          const double middle_px = 0.5 * static_cast<double>(map.width_px);
          const double beside_px = std::abs(std::remainder(seen->at_px.x - middle_px, map.turn_px));
          EXPECT_TRUE(seen->at_px.y < -8 || seen->at_px.y > static_cast<double>(map.height_px) + 8 ||
                      beside_px > middle_px + 8)
              << seen->at_px.x << " " << seen->at_px.y;
        }
      }
    }
  }
  EXPECT_GT(refused, 2000);
}

TEST(EyeProjection, WhatHasNoPlaceIsRefused) {
  const EyeProjection projection(planned(MapKind::kCylinder), kStandpoint);
  EXPECT_FALSE(projection.project(kStandpoint.position_m));
  EXPECT_FALSE(projection.project(kStandpoint.position_m * 0.5));
  EXPECT_TRUE(
      EyeProjection(planned(MapKind::kEquirectangular), kStandpoint).project(kStandpoint.position_m * 0.5));
}

}  // namespace
}  // namespace panorama
