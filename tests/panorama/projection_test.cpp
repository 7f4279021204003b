// Places of a panorama and the directions that they show.
#include "panorama/projection.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/pose.h"
#include "tests/support/support.h"

namespace {

using panorama::check;
using panorama::Direction;
using panorama::MapKind;
using panorama::PanoramaMap;

constexpr double kDegrees = 180.0 / mars::kPi;

// Any kind, full circles and arcs, the seam anywhere, elevations within 85 degrees.
PanoramaMap any_map(test_support::Random& random) {
  const int kind = random.integer(0, 2);
  const int height = random.integer(1, 20000);
  const double azimuth_deg = random.uniform(-720.0, 720.0);
  PanoramaMap map;
  if (kind == 2) {
    const int facets = random.integer(3, 64);
    map = panorama::faceted_map(facets, random.integer(1, 100000 / facets), height, azimuth_deg, 0.0);
  } else {
    const int turn = random.integer(1, 100000);
    map = panorama::cylinder_map(turn, height, turn + random.uniform(0.0, 0.5), azimuth_deg, 0.0);
    if (kind == 1) map.kind = MapKind::kEquirectangular;
  }
  if (random.integer(0, 1) == 1) {
    map.width_px = random.integer(1, static_cast<int>(map.width_px));
    map.crop_left_px = random.uniform(0.0, 0.999 * map.turn_px);
  }
  const double reach_px = map.focal_px * (kind == 1 ? 85.0 / kDegrees : std::tan(85.0 / kDegrees) * 0.99);
  map.height_px =
      std::max<std::int64_t>(1, std::min<std::int64_t>(map.height_px, static_cast<std::int64_t>(reach_px)));
  map.horizon_px = random.uniform(0.0, 1.0) * static_cast<double>(map.height_px);
  return map;
}

TEST(PanoramaMap, PlacesComeBackFromTheirDirections) {
  test_support::Random random(801);
  for (int n = 0; n < 20000; ++n) {
    const PanoramaMap map = any_map(random);
    ASSERT_EQ(check(map), "");
    for (int k = 0; k < 10; ++k) {
      // The edges themselves are among them; the right edge of a full circle is its left one.
      const double across = k == 0 ? 0.0 : k == 1 ? 1.0 : random.uniform(0.0, 1.0);
      const double x = across * static_cast<double>(map.width_px);
      const double y = random.uniform(0.0, 1.0) * static_cast<double>(map.height_px);
      const Direction direction = map.to_direction(x, y);
      ASSERT_GE(direction.azimuth_deg, 0.0);
      ASSERT_LT(direction.azimuth_deg, 360.0);
      const auto back = map.to_pixel(direction);
      ASSERT_TRUE(back) << x << " " << y << " of " << map.width_px << "x" << map.height_px;
      ASSERT_NEAR(std::remainder(back->x - x, map.turn_px), 0.0, panorama::kRoundTrip_px);
      if (across != 1.0) {
        ASSERT_NEAR(back->x, x, panorama::kRoundTrip_px);
      }
      ASSERT_NEAR(back->y, y, panorama::kRoundTrip_px);
      // A column does not know how often one has turned.
      const int turns = random.integer(-1000, 1000);
      const auto again = map.to_pixel({direction.azimuth_deg + 360.0 * turns, direction.elevation_deg});
      ASSERT_TRUE(again);
      ASSERT_NEAR(std::remainder(again->x - x, map.turn_px), 0.0,
                  panorama::kRoundTrip_px + 1e-10 * map.turn_px / 360.0);
    }
  }
}

TEST(PanoramaMap, ShowsTwentyKnownDirections) {
  // Cylinder of 10 columns a degree from 350 degrees on, f = 3600 / 2 pi; equirectangular the same; four facets
  // of 1000 columns with f = 500 from yaw 90 on.
  const double f = 3600.0 / (2.0 * mars::kPi);
  const PanoramaMap cylinder = panorama::cylinder_map(3600, 1200, 3600, 350.0, 600.0);
  const PanoramaMap even = panorama::equirectangular_map(3600, 1800, 3600, 350.0, 900.0);
  const PanoramaMap facets = panorama::faceted_map(4, 1000, 800, 90.0, 400.0);
  EXPECT_DOUBLE_EQ(facets.focal_px, 500.0);
  const double root2 = std::sqrt(2.0);
  struct Known {
    const PanoramaMap& map;
    Direction direction;
    double x, y;
  };
  const Known known[] = {
      {cylinder, {350.0, 0.0}, 0.0, 600.0},
      {cylinder, {0.0, 0.0}, 100.0, 600.0},
      {cylinder, {90.0, 45.0}, 1000.0, 600.0 - f},
      {cylinder, {180.0, -30.0}, 1900.0, 600.0 + f / std::sqrt(3.0)},
      {cylinder, {-10.5, 10.0}, 3595.0, 600.0 - f * std::tan(10.0 / kDegrees)},
      {cylinder, {349.9, 0.0}, 3599.0, 600.0},
      {cylinder, {710.0, 0.0}, 0.0, 600.0},
      {even, {350.0, 90.0}, 0.0, 0.0},
      {even, {0.0, -90.0}, 100.0, 1800.0},
      {even, {270.0, 17.0}, 2800.0, 730.0},
      {even, {-1000.0, -17.05}, 900.0, 1070.5},
      {even, {349.95, 0.05}, 3599.5, 899.5},
      {facets, {90.0, 0.0}, 500.0, 400.0},
      {facets, {45.0, 0.0}, 0.0, 400.0},
      {facets, {180.0, 0.0}, 1500.0, 400.0},
      {facets, {0.0, 0.0}, 3500.0, 400.0},
      {facets, {90.0 + std::atan(0.5) * kDegrees, 0.0}, 750.0, 400.0},
      {facets, {90.0, std::atan(0.5) * kDegrees}, 500.0, 150.0},
      // At a seam the facet is sqrt(2) as far away.
      {facets, {135.0, std::atan(0.5 / root2) * kDegrees}, 1000.0, 150.0},
      {facets,
       {270.0 - std::atan(0.2) * kDegrees, -std::atan(0.3 / std::sqrt(1.04)) * kDegrees},
       2400.0,
       550.0},
  };
  for (const Known& k : known) {
    const auto at = k.map.to_pixel(k.direction);
    ASSERT_TRUE(at) << k.direction.azimuth_deg << " " << k.direction.elevation_deg;
    EXPECT_NEAR(at->x, k.x, 1e-9) << k.direction.azimuth_deg;
    EXPECT_NEAR(at->y, k.y, 1e-9) << k.direction.elevation_deg;
    const Direction back = k.map.to_direction(k.x, k.y);
    EXPECT_NEAR(std::remainder(back.azimuth_deg - k.direction.azimuth_deg, 360.0), 0.0, 1e-11);
    EXPECT_NEAR(back.elevation_deg, k.direction.elevation_deg, 1e-11);
  }
}

TEST(PanoramaMap, HasNoPlaceForWhatItDoesNotShow) {
  PanoramaMap arc = panorama::cylinder_map(900, 100, 3600, 300.0, 80.0);  // 300 to 390 degrees
  EXPECT_TRUE(arc.to_pixel({29.99, 0.0}));
  EXPECT_FALSE(arc.to_pixel({30.01, 0.0}));
  EXPECT_FALSE(arc.to_pixel({299.99, 0.0}));
  EXPECT_TRUE(arc.to_pixel({300.0, 0.0}));
  EXPECT_TRUE(arc.to_pixel({390.0, 0.0}));
  EXPECT_FALSE(arc.is_full_turn());
  EXPECT_DOUBLE_EQ(arc.azimuth_span_deg(), 90.0);
  EXPECT_FALSE(arc.to_pixel({0.0, 10.0}));
  EXPECT_FALSE(arc.to_pixel({0.0, -10.0}));
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular}) {
    arc.kind = kind;
    EXPECT_FALSE(arc.to_pixel({0.0, 90.0}));
    EXPECT_FALSE(arc.to_pixel({0.0, std::numeric_limits<double>::quiet_NaN()}));
    EXPECT_FALSE(arc.to_pixel({std::numeric_limits<double>::infinity(), 0.0}));
  }
  // The horizon above the image's edge, which shows ground only.
  const PanoramaMap below = panorama::equirectangular_map(100, 100, 3600, 0.0, -50.0);
  ASSERT_EQ(check(below), "");
  EXPECT_FALSE(below.to_pixel({5.0, 0.0}));
  EXPECT_TRUE(below.to_pixel({5.0, -5.1}));
  // More than a full circle: the left of two places.
  const PanoramaMap more = panorama::cylinder_map(4000, 100, 3600, 0.0, 50.0);
  EXPECT_NEAR(more.to_pixel({39.0, 0.0})->x, 390.0, 1e-9);
  EXPECT_NEAR(more.to_direction(3990.0, 50.0).azimuth_deg, 39.0, 1e-11);
}

// Azimuth and elevation of a body-fixed direction seen from a pose.
Direction seen_from(const mars::Pose& pose, const glm::dvec3& ray) {
  const mars::Axes level =
      mars::to_camera({pose.lon_deg, pose.lat_deg, pose.alt_m, 0, 0, 0}, mars::kMarsRadius_m).axes;
  return {std::atan2(glm::dot(ray, level.right), glm::dot(ray, level.forward)) * kDegrees,
          std::asin(glm::dot(ray, level.up)) * kDegrees};
}

void expect_same(const Direction& a, const Direction& b) {
  EXPECT_NEAR(std::remainder(a.azimuth_deg - b.azimuth_deg, 360.0), 0.0, 1e-12 * kDegrees);
  EXPECT_NEAR(a.elevation_deg, b.elevation_deg, 1e-12 * kDegrees);
}

TEST(PanoramaMap, AgreesWithTheViewsThatMakeIt) {
  test_support::Random random(802);
  for (const auto projection : {vpe::core::Projection::kCylinder, vpe::core::Projection::kEquirectangular}) {
    for (int n = 0; n < 200; ++n) {
      const mars::Pose pose{
          random.uniform(-180, 180), random.uniform(-80, 80), 10.0, random.uniform(0, 360), 0, 0};
      vpe::core::View view{
          mars::to_camera(pose, mars::kMarsRadius_m), projection, 60.0, 1600, 400, {13.5, -21.25}, {}};
      if (n % 2 == 1) view.part = {200, 30, 700, 300};
      ASSERT_EQ(vpe::core::check(view), "");
      const PanoramaMap map = panorama::map_of(view);
      ASSERT_EQ(check(map), "");
      const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
      const double x = random.uniform(0.0, part.width);
      const double y = random.uniform(0.0, part.height);
      expect_same(map.to_direction(x, y), seen_from(pose, vpe::core::pixel_ray(view, x + part.x, y + part.y)));
    }
  }
}

TEST(PanoramaMap, AgreesWithThePerspectiveViewOfEachFacet) {
  test_support::Random random(803);
  for (const int facets : {3, 4, 8, 64}) {
    const PanoramaMap map = panorama::faceted_map(facets, 240, 300, 33.0, 190.0);
    ASSERT_EQ(check(map), "");
    for (int k = 0; k < facets; ++k) {
      const mars::Pose pose{137.4, -4.6, 10.0, 33.0 + 360.0 * k / facets, 0, 0};
      const double fov_deg = 2.0 * std::atan(150.0 / map.focal_px) * kDegrees;
      const vpe::core::View view{mars::to_camera(pose, mars::kMarsRadius_m),
                                 vpe::core::Projection::kPerspective,
                                 fov_deg,
                                 240,
                                 300,
                                 {0, 40},
                                 {}};
      ASSERT_EQ(vpe::core::check(view), "");
      for (int n = 0; n < 20; ++n) {
        const double x = random.uniform(0.0, 240.0);
        const double y = random.uniform(0.0, 300.0);
        expect_same(map.to_direction(240.0 * k + x, y), seen_from(pose, vpe::core::pixel_ray(view, x, y)));
      }
    }
  }
}

TEST(PanoramaMap, RefusesViewsThatAreNoPanoramas) {
  vpe::core::View view;
  view.camera = mars::to_camera({0, 0, 10, 0, 0, 0}, mars::kMarsRadius_m);
  EXPECT_THROW(panorama::map_of(view), std::invalid_argument);
  view.projection = vpe::core::Projection::kCylinder;
  EXPECT_NO_THROW(panorama::map_of(view));
  view.camera = mars::to_camera({0, 0, 10, 0, 0.5, 0}, mars::kMarsRadius_m);
  EXPECT_THROW(panorama::map_of(view), std::invalid_argument);
}

TEST(PanoramaMap, ChecksEveryField) {
  const PanoramaMap good = panorama::cylinder_map(3600, 500, 3600, 0.0, 250.0);
  EXPECT_EQ(check(good), "");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](auto change, const char* word) {
    PanoramaMap map = good;
    change(map);
    EXPECT_NE(check(map).find(word), std::string::npos) << word << ": " << check(map);
  };
  refused([](auto& m) { m.width_px = 0; }, "size");
  refused([](auto& m) { m.height_px = 1000001; }, "size");
  refused([](auto& m) { m.width_px = -5; }, "size");
  for (const double bad : {nan, 0.0, -1.0, 1799.0, 1e300})
    refused([&](auto& m) { m.turn_px = bad; }, "full circle");
  for (const double bad : {nan, -1.0, 3600.0})
    refused([&](auto& m) { m.crop_left_px = bad; }, "cut at the left");
  for (const double bad : {nan, 1e7}) refused([&](auto& m) { m.turn_azimuth_deg = bad; }, "azimuth");
  for (const double bad : {nan, 0.0, -3.0, 1e10}) refused([&](auto& m) { m.focal_px = bad; }, "focal");
  for (const double bad : {nan, 1e10}) refused([&](auto& m) { m.horizon_px = bad; }, "horizon");
  refused([](auto& m) { m.facets = 3; }, "facets");
  refused([](auto& m) { m = panorama::equirectangular_map(3600, 1803, 3600, 0.0, 900.0); }, "zenith");
  refused([](auto& m) { m = panorama::faceted_map(0, 100, 100, 0.0, 50.0); }, "0 facets");
  refused([](auto& m) { m = panorama::faceted_map(1000000, 100, 100, 0.0, 50.0); }, "1000000 facets");
  refused([](auto& m) { (m = panorama::faceted_map(8, 100, 100, 0.0, 50.0)).focal_px += 0.1; }, "focal");
  refused([](auto& m) { (m = panorama::faceted_map(8, 100, 100, 0.0, 50.0)).turn_px += 4; }, "whole columns");
}

TEST(PanoramaMap, MeasuresHowFarTwoAre) {
  const PanoramaMap a = panorama::cylinder_map(3600, 500, 3600, 0.0, 250.0);
  PanoramaMap b = a;
  EXPECT_NEAR(panorama::largest_difference_px(a, b), 0.0, 1e-9);
  b.turn_azimuth_deg = 360.0 - 0.3;
  b.horizon_px += 4.0;
  EXPECT_NEAR(panorama::largest_difference_px(a, b), 5.0, 1e-9);
  b.width_px -= 1;
  EXPECT_EQ(panorama::largest_difference_px(a, b), std::numeric_limits<double>::infinity());
}

}  // namespace
