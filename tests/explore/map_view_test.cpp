#include "vpe/explore/measure/map_view.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/explore/mouse.h"

namespace vpe::explore {
namespace {

TEST(MapView, TheWholePlanetFitsAndEastIsRight) {
  const MapView map = whole_map(512, 256);
  EXPECT_NEAR(map.place({256, 128})->lon_deg, 0, 1e-12);
  EXPECT_GT(map.place({300, 128})->lon_deg, 0);
  EXPECT_GT(map.place({256, 100})->lat_deg, 0);
  EXPECT_NEAR(map.position({179.9, 0}).x, 512, 0.3);
  EXPECT_NEAR(map.position({0, 90}).y, 0, 1e-9);
  EXPECT_FALSE(whole_map(512, 400).place({256, 1}).has_value());  // beyond the pole
}

RC_GTEST_PROP(MapView, PlacesComeBack, ()) {
  MapView map = whole_map(600, 300);
  for (int n = 0; n < 6; ++n) {
    const glm::dvec2 xy{*rc::gen::inRange(0, 600) + 0.5, *rc::gen::inRange(0, 300) + 0.5};
    const auto held = map.place(xy);
    const MapView next = zoomed(map, xy, *rc::gen::inRange(5, 40) / 10.0);
    RC_ASSERT(next.middle.lat_deg + 90 >= 0 && next.middle.lat_deg <= 90);
    // The place under the cursor stays there when zooming in (zooming out may meet the planet's edge).
    if (held && next.degrees_per_px < map.degrees_per_px)
      RC_ASSERT(glm::length(next.position(*held) - xy) < 1e-3 || std::abs(held->lat_deg) > 80);
    map = next;
    const auto place = map.place(xy);
    if (!place) continue;
    const glm::dvec2 back = map.position(*place);
    const double turn_px = 360.0 / map.lon_degrees_per_px();
    RC_ASSERT(std::abs(std::remainder(back.x - xy.x, turn_px)) < 1e-4 && std::abs(back.y - xy.y) < 1e-4);
  }
}

TEST(MapView, ZoomEndsAtItsLimits) {
  MapView map = whole_map(600, 300);
  for (int n = 0; n < 200; ++n) map = zoomed(map, {100, 100}, 2);
  EXPECT_EQ(map.degrees_per_px, MapLimits::kFinest_deg);
  for (int n = 0; n < 200; ++n) map = zoomed(map, {100, 100}, 0.5);
  EXPECT_EQ(map, whole_map(600, 300));
  EXPECT_EQ(zoomed(map, {1, 1}, std::nan("")), map);
}

TEST(MapView, ADragMovesThePlaceThatIsHeld) {
  const MapView map = zoomed(whole_map(600, 300), {300, 150}, 4);
  const auto held = map.place({300, 150});
  const MapView next = moved(map, {20, -10});
  EXPECT_NEAR(next.position(*held).y, 140, 1e-9);
  EXPECT_NEAR(next.position(*held).x, 320, 0.5);  // the middle's latitude changed the scale
}

TEST(MapView, FootprintsEncloseTheGroundInView) {
  const double r = mars::kMarsRadius_m;
  const Screen screen{1000, 1000, 90};
  const core::View view = view_of({20, 10, 100'000, 0, -90, 0}, screen, r);
  double north = -90;
  for (const mars::LonLat p : footprint(view, r)) north = std::max(north, p.lat_deg);
  // Straight down at 45 degrees to the upper edge: about the height, and what the ball falls away.
  EXPECT_NEAR((north - 10) * mars::kRadiansPerDegree * r, 100'000, 4000);
  // A view of the whole planet ends at its horizon.
  const core::View far = view_of(overview({20, 10}, screen, r), screen, r);
  const double cap_deg = std::acos(r / glm::length(far.camera.position_m)) / mars::kRadiansPerDegree;
  for (const mars::LonLat p : footprint(far, r))
    EXPECT_NEAR(mars::distance_rad(p, {20, 10}) / mars::kRadiansPerDegree, cap_deg, 1e-9);
}

}  // namespace
}  // namespace vpe::explore
