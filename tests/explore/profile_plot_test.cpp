#include "vpe/explore/measure/profile_plot.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/explore/terrain_fixture.h"

namespace vpe::explore {
namespace {

class PlotOfRidge : public test_support::GroundTest<test_support::RidgeGround> {};

TEST_F(PlotOfRidge, NoPeakIsLostInAnyNumberOfColumns) {
  const std::vector<mars::LonLat> places{{-35.2, 20}, {-34.8, 20.1}};
  for (const double step_m : {0.0, 3000.0, 30000.0}) {
    const Profile profile = make_profile(surface(), places, {.step_m = step_m});
    for (const int count : {1, 7, 260, 5000}) {
      const std::vector<PlotColumn> columns = plot_columns(profile, count);
      ASSERT_EQ(columns.size(), static_cast<std::size_t>(count));
      double low = 1e9;
      double high = -1e9;
      for (const PlotColumn& c : columns) {
        EXPECT_LE(c.low_m, std::min(c.begin_m, c.end_m));
        EXPECT_GE(c.high_m, std::max(c.begin_m, c.end_m));
        low = std::min(low, c.low_m);
        high = std::max(high, c.high_m);
      }
      EXPECT_NEAR(low, profile.lowest_m, 1e-9);
      EXPECT_NEAR(high, profile.highest_m, 1e-9);
      EXPECT_EQ(columns.front().begin_m, profile.points.front().height_m);
      EXPECT_EQ(columns.back().end_m, profile.points.back().height_m);
    }
  }
}

TEST_F(PlotOfRidge, ColumnsWithNodataAreMarked) {
  Profile profile = make_profile(surface(), std::vector<mars::LonLat>{{-36, 20}, {-34, 20}}, {.step_m = 2000});
  ASSERT_GT(profile.points.size(), 20U);
  profile.points[10].nodata = true;
  const int count = static_cast<int>(profile.points.size()) - 1;
  int nodata = 0;
  for (const PlotColumn& c : plot_columns(profile, count * 4)) nodata += c.nodata ? 1 : 0;
  EXPECT_GE(nodata, 8);  // both steps that end there
  EXPECT_LE(nodata, 10);
}

TEST_F(PlotOfRidge, AGivenDistanceFindsItsPoint) {
  const Profile profile =
      make_profile(surface(), std::vector<mars::LonLat>{{-36, 20}, {-34, 20}}, {.step_m = 2000});
  EXPECT_EQ(&nearest_point(profile, -5), &profile.points.front());
  EXPECT_EQ(&nearest_point(profile, 1e9), &profile.points.back());
  EXPECT_EQ(&nearest_point(profile, profile.points[7].distance_m + 1), &profile.points[7]);
  EXPECT_EQ(&nearest_point(profile, profile.points[7].distance_m - 1), &profile.points[7]);
  EXPECT_NEAR(ground_at_distance_m(profile, profile.points[7].distance_m), profile.points[7].height_m, 1e-9);
}

// Computes the same line in space, without the formula.
RC_GTEST_PROP(SightHeight, IsTheStraightLine, ()) {
  const double radius_m = 3396190;
  const double arc = *rc::gen::inRange(1, 30000) / 1e4;
  const double from_m = *rc::gen::inRange(-8000, 400000);
  const double to_m = *rc::gen::inRange(-8000, 400000);
  const glm::dvec3 a{radius_m + from_m, 0, 0};
  const glm::dvec3 b = (radius_m + to_m) * glm::dvec3{std::cos(arc), std::sin(arc), 0};
  const glm::dvec3 p = glm::mix(a, b, *rc::gen::inRange(0, 1001) / 1e3);
  const double t = std::atan2(p.y, p.x) / arc;
  RC_ASSERT(std::abs(sight_height_m(radius_m, from_m, to_m, arc, t) - (glm::length(p) - radius_m)) < 1e-6);
}

}  // namespace
}  // namespace vpe::explore
