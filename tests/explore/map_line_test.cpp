#include "vpe/explore/measure/map_line.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::explore {
namespace {

double half_turn_px(const MapView& map) { return 180.0 / map.lon_degrees_per_px(); }

TEST(MapLine, AlongTheEquatorItIsStraight) {
  const MapView map = whole_map(720, 360);
  const std::vector<mars::LonLat> places{{-20, 0}, {50, 0}};
  const MapLine line = map_line(map, places);
  ASSERT_EQ(line.size(), 1U);
  EXPECT_NEAR(line[0].front().x, 320, 1e-9);
  EXPECT_NEAR(line[0].back().x, 460, 1e-9);
  for (const glm::dvec2& xy : line[0]) EXPECT_NEAR(xy.y, 180, 1e-9);
  EXPECT_TRUE(map_line(map, std::span(places).first(1)).empty());
}

TEST(MapLine, ItBendsTowardsThePole) {
  const MapView map = whole_map(720, 360);
  const std::vector<mars::LonLat> places{{-60, 50}, {60, 50}};
  const MapLine line = map_line(map, places);
  ASSERT_EQ(line.size(), 1U);
  double highest = 360;
  for (const glm::dvec2& xy : line[0]) highest = std::min(highest, xy.y);
  // Its northernmost latitude, by the right triangle at the middle: tan(50) / cos(60).
  const double top_deg = std::atan(std::tan(50 * mars::kRadiansPerDegree) / 0.5) / mars::kRadiansPerDegree;
  EXPECT_NEAR(highest, 180 - 2 * top_deg, 0.5);
}

TEST(MapLine, IsCutAtTheEdgeAndContinuesAtTheOther) {
  MapView map = whole_map(720, 360);
  map.middle.lon_deg = 30;  // the edges are at 150 W
  const std::vector<mars::LonLat> places{{-170, 10}, {-120, -20}, {-179, 0}};
  const MapLine line = map_line(map, places);
  ASSERT_EQ(line.size(), 3U);
  EXPECT_NEAR(line[0].back().x, 720, 1e-6);
  EXPECT_NEAR(line[1].front().x, 0, 1e-6);
  EXPECT_NEAR(line[0].back().y, line[1].front().y, 1e-9);
  EXPECT_NEAR(line[1].back().x, 0, 1e-6);
  EXPECT_NEAR(line[2].front().x, 720, 1e-6);
}

TEST(MapLine, OverThePoleAndAlongTheEdge) {
  const MapView map = whole_map(720, 360);
  const std::vector<mars::LonLat> over{{0, 60}, {180, 60}};
  for (const auto& piece : map_line(map, over))
    for (const glm::dvec2& xy : piece) EXPECT_TRUE(std::isfinite(xy.x) && xy.y < 61 && xy.y > -1e-9);
  const std::vector<mars::LonLat> edge{{180, -60}, {180, 60}};
  for (const auto& piece : map_line(map, edge))
    for (const glm::dvec2& xy : piece) EXPECT_NEAR(std::abs(xy.x - 360), 360, 1e-6);
}

// Every place of the great circle is on the line, and no piece runs across the map.
RC_GTEST_PROP(MapLine, FollowsTheGreatCircle, ()) {
  MapView map = whole_map(720, 360);
  map.middle.lon_deg = *rc::gen::inRange(-179, 180);
  const auto place = [] {
    return mars::LonLat{*rc::gen::inRange(-1800, 1800) / 10.0, *rc::gen::inRange(-890, 890) / 10.0};
  };
  const std::vector<mars::LonLat> places{place(), place()};
  const glm::dvec3 a = mars::direction(places[0]);
  const glm::dvec3 b = mars::direction(places[1]);
  RC_PRE(mars::angle_between_rad(a, b) < 3.1);
  const MapLine line = map_line(map, places);
  RC_ASSERT(line.size() <= 2U);
  for (const auto& piece : line) {
    for (const glm::dvec2& xy : piece) RC_ASSERT(std::abs(xy.x - 360) <= half_turn_px(map) + 1e-6);
    for (std::size_t k = 1; k < piece.size(); ++k) {
      const bool is_at_pole = std::min(piece[k].y, 360 - piece[k].y) < 1;
      RC_ASSERT(is_at_pole || std::abs(piece[k].x - piece[k - 1].x) < half_turn_px(map));
    }
  }
  for (int n = 0; n <= 40; ++n) {
    const mars::LonLat on = mars::lon_lat(mars::slerp(a, b, n / 40.0));
    if (std::abs(on.lat_deg) > 89.4) continue;
    const glm::dvec2 xy = map.position(on);
    double nearest = 1e9;
    for (const auto& piece : line) {
      for (std::size_t k = 1; k < piece.size(); ++k) {
        const glm::dvec2 way = piece[k] - piece[k - 1];
        const double t =
            std::clamp(glm::dot(xy - piece[k - 1], way) / std::max(1e-12, glm::dot(way, way)), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(piece[k - 1] + t * way - xy));
      }
    }
    RC_ASSERT(nearest < 0.6);
  }
}

}  // namespace
}  // namespace vpe::explore
