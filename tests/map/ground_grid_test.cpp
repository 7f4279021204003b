// The ground of a planet on grids of local maps, against Surface and query().
#include "vpe/map/ground_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>

#include "paging/surface/query.h"
#include "tests/paging/surface_fixture.h"

namespace vpe::map {
namespace {

constexpr double kGridSphere_m = 3396190;

std::vector<glm::dvec3> directions_to(const std::vector<mars::LonLat>& places) {
  std::vector<glm::dvec3> directions;
  for (const mars::LonLat& place : places) directions.push_back(mars::direction(place));
  return directions;
}

// Bumps, with nodata around 10 E, 5 N.
double bumps_with_a_gap(const glm::dvec3& d) {
  const double off = mars::angle_between_rad(d, mars::direction({10, 5}));
  return off < 0.03 ? std::nan("") : test_support::bumpy_height(d);
}

class GroundGridTest : public test_support::SurfaceTest<bumps_with_a_gap> {};

TEST_F(GroundGridTest, HasTheValuesOfQuery) {
  const GridFrame frame = frame_around(directions_to({{2, -6}, {14, 9}}), 12000, 20000, kGridSphere_m);
  const GroundGrid grid = sample_ground(*surface_, frame, 2, nullptr);
  ASSERT_EQ(grid.heights.columns, frame.columns);
  ASSERT_EQ(grid.heights.rows, frame.rows);
  EXPECT_EQ(grid.heights.spacing_m, 12000);
  std::int64_t nodata = 0;
  double finest_m = std::numeric_limits<double>::infinity();
  double coarsest_m = 0;
  double difference_m = -1;
  for (int row = 0; row < frame.rows; ++row)
    for (int column = 0; column < frame.columns; ++column) {
      const paging::PlaceAnswer answer = paging::query(*surface_, frame.to_place({column, row}));
      const float height_m = grid.heights.at(column, row);
      ASSERT_EQ(std::isnan(height_m), answer.nodata);
      if (!answer.nodata) {
        EXPECT_NEAR(height_m, answer.elevation_m, 1e-3 + 1e-6 * std::abs(answer.elevation_m));
      }
      nodata += answer.nodata ? 1 : 0;
      finest_m = std::min(finest_m, answer.spacing_m);
      coarsest_m = std::max(coarsest_m, answer.spacing_m);
      if (answer.resampling.posts > 0) difference_m = std::max(difference_m, double{answer.resampling.max_m});
    }
  EXPECT_GT(nodata, 0);
  EXPECT_EQ(grid.ground.pixels, std::int64_t{frame.columns} * frame.rows);
  EXPECT_EQ(grid.ground.nodata, nodata);
  EXPECT_EQ(grid.ground.synthetic, 0);
  EXPECT_EQ(grid.ground.finest_spacing_m, finest_m);
  EXPECT_EQ(grid.ground.coarsest_spacing_m, coarsest_m);
  EXPECT_EQ(grid.ground.error_max_m, difference_m);
  EXPECT_EQ(grid.ground.sources, (std::set<int>{0}));
}

TEST_F(GroundGridTest, ThreadsDoNotShowAndProgressMayThrow) {
  const GridFrame frame = frame_around(directions_to({{0, 0}}), 9000, 500000, kGridSphere_m);
  double share = 0;
  const GroundGrid one = sample_ground(*surface_, frame, 1, [&](double done) {
    EXPECT_GT(done, share);
    share = done;
  });
  EXPECT_EQ(share, 1);
  const GroundGrid many = sample_ground(*surface_, frame, 5, nullptr);
  const std::vector<float>& heights_m = one.heights.heights_m;
  ASSERT_EQ(heights_m.size(), many.heights.heights_m.size());
  EXPECT_EQ(std::memcmp(heights_m.data(), many.heights.heights_m.data(), heights_m.size() * sizeof(float)), 0);
  EXPECT_EQ(one.ground.error_max_m, many.ground.error_max_m);
  EXPECT_THROW(sample_ground(*surface_, frame, 2, [](double) { throw std::runtime_error("stop"); }),
               std::runtime_error);
}

TEST(GridFrameTest, HoldsAllPlacesAndTheMargin) {
  test_support::Random random(61);
  for (int n = 0; n < 200; ++n) {
    const glm::dvec3 middle = random.direction();
    std::vector<glm::dvec3> directions;
    const int count = random.integer(1, 6);
    for (int k = 0; k < count; ++k) directions.push_back(glm::normalize(middle + 0.1 * random.direction()));
    const double spacing_m = random.log_uniform(500, 20000);
    const double margin_m = random.uniform(0, 50000);
    const GridFrame frame = frame_around(directions, spacing_m, margin_m, kGridSphere_m);
    EXPECT_EQ(static_cast<double>(frame.columns) * frame.rows,
              posts_around(directions, spacing_m, margin_m, kGridSphere_m));
    const glm::dvec2 first = frame.to_grid(mars::lon_lat(directions[0]));
    EXPECT_NEAR(first.x, std::round(first.x), 1e-6);
    EXPECT_NEAR(first.y, std::round(first.y), 1e-6);
    const double margin = margin_m / spacing_m - 1e-5;
    for (const glm::dvec3& direction : directions) {
      const glm::dvec2 at = frame.to_grid(mars::lon_lat(direction));
      EXPECT_GE(std::min(at.x, at.y), margin);
      EXPECT_LE(at.x, frame.columns - 1 - margin);
      EXPECT_LE(at.y, frame.rows - 1 - margin);
      const mars::LonLat back = frame.to_place(at);
      EXPECT_LT(mars::distance_rad(back, mars::lon_lat(direction)), 1e-13);
    }
    EXPECT_GE(frame.scale_error(), 0);
    EXPECT_LT(frame.scale_error(), 0.01);
  }
}

TEST(GridFrameTest, NorthIsUp) {
  const GridFrame frame = frame_around(directions_to({{40, 10}, {41, 11}}), 1000, 0, kGridSphere_m);
  EXPECT_GT(frame.to_place({5, 2}).lat_deg, frame.to_place({5, 9}).lat_deg);
  EXPECT_LT(frame.to_place({2, 5}).lon_deg, frame.to_place({9, 5}).lon_deg);
}

TEST(GridFrameTest, RefusesBadInput) {
  const std::vector<glm::dvec3> ends = directions_to({{0, 0}, {10, 10}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(frame_around({}, 1, 0, kGridSphere_m), std::invalid_argument);
  EXPECT_THROW(frame_around(ends, 0, 0, kGridSphere_m), std::invalid_argument);
  EXPECT_THROW(frame_around(ends, nan, 0, kGridSphere_m), std::invalid_argument);
  EXPECT_THROW(frame_around(ends, 1000, -1, kGridSphere_m), std::invalid_argument);
  EXPECT_THROW(frame_around(ends, 1000, nan, kGridSphere_m), std::invalid_argument);
  EXPECT_THROW(frame_around(ends, 1, 0, kGridSphere_m), std::invalid_argument);  // 3.5e11 posts
  EXPECT_THROW(frame_around(ends, 1000, 0, 0), std::invalid_argument);
  EXPECT_NO_THROW(frame_around(directions_to({{0, 0}, {180, 0}}), 1e6, 0, kGridSphere_m));
}

TEST(PlacesOfLine, StayWithinTheTolerance) {
  for (const double lat_deg : {0.0, 60.0, 89.9}) {
    const GridFrame frame =
        frame_around(directions_to({{175, lat_deg}, {-175, lat_deg}}), 1000, 50000, kGridSphere_m);
    const std::vector<glm::dvec2> line{{0, 3}, {frame.columns - 1.0, frame.rows - 1.0}, {4, 60}};
    for (const double tolerance_m : {1.0, 100.0}) {
      const std::vector<glm::dvec2> places = places_of_line(frame, line, false, tolerance_m);
      for (std::size_t n = 0; n + 1 < places.size(); ++n) {
        EXPECT_LE(std::abs(places[n + 1].x - places[n].x), 180);
        for (const double share : {0.25, 0.5, 0.75}) {
          const glm::dvec2 at = places[n] + share * (places[n + 1] - places[n]);
          const glm::dvec2 grid = frame.to_grid({at.x, at.y});
          double off = std::numeric_limits<double>::infinity();
          for (std::size_t k = 0; k < 2; ++k) {
            const glm::dvec2 along = line[k + 1] - line[k];
            const double t = std::clamp(glm::dot(grid - line[k], along) / glm::dot(along, along), 0.0, 1.0);
            off = std::min(off, glm::length(grid - line[k] - t * along));
          }
          EXPECT_LE(off * 1000, 1.3 * tolerance_m) << lat_deg;
        }
      }
    }
  }
}

TEST(PlacesOfLine, RingsClose) {
  const GridFrame pole = frame_around(directions_to({{0, 90}}), 1000, 30000, kGridSphere_m);
  const std::vector<glm::dvec2> around{{10, 10}, {50, 10}, {50, 50}, {10, 50}};
  const std::vector<glm::dvec2> turn = places_of_line(pole, around, true, 10);
  EXPECT_EQ(turn.front().y, turn.back().y);
  EXPECT_NEAR(std::abs(turn.back().x - turn.front().x), 360, 1e-9);
  const GridFrame here = frame_around(directions_to({{179.9, 10}}), 1000, 30000, kGridSphere_m);
  const std::vector<glm::dvec2> ring = places_of_line(here, around, true, 10);
  EXPECT_EQ(ring.front(), ring.back());
  EXPECT_GE(ring.size(), 5U);
  EXPECT_TRUE(places_of_line(here, {}, false, 10).empty());
}

TEST(PlacesOfLine, GoesOverAPole) {
  const GridFrame pole = frame_around(directions_to({{0, 90}}), 1000, 30000, kGridSphere_m);
  const std::vector<glm::dvec2> places =
      places_of_line(pole, std::vector<glm::dvec2>{{30, 10}, {30, 30}, {50, 30}}, false, 10);
  double highest_deg = 0;
  for (const glm::dvec2& place : places) highest_deg = std::max(highest_deg, place.y);
  EXPECT_NEAR(highest_deg, 90, 1e-9);
  EXPECT_NEAR(std::abs(places.front().x - places.back().x), 90, 1e-6);
}

}  // namespace
}  // namespace vpe::map
