// Tests of compass marks: selection, labels, positions in views.
#include "vpe/overlay/compass.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "tests/overlay/ball.h"

namespace overlay_test {
namespace {

using vpe::overlay::compass_horizon;
using vpe::overlay::compass_marks;
using vpe::overlay::compass_row;
using vpe::overlay::compass_steps;
using vpe::overlay::CompassMark;
using vpe::overlay::CompassRank;
using vpe::overlay::CompassSteps;
using vpe::overlay::horizon_line;
using vpe::overlay::PlacedMark;

std::map<double, std::string> labels(const std::vector<CompassMark>& marks) {
  std::map<double, std::string> out;
  for (const CompassMark& m : marks) {
    EXPECT_EQ(m.label.empty(), m.rank == CompassRank::kTick);
    if (!m.label.empty()) out[m.azimuth_deg] = m.label;
  }
  return out;
}

TEST(Compass, StepsFitTheImage) {
  for (double px_per_deg = 0.2; px_per_deg < 1e5; px_per_deg *= 1.3) {
    const CompassSteps steps = compass_steps(px_per_deg, 40);
    EXPECT_TRUE(steps.figure_deg == 90 || steps.figure_deg * px_per_deg >= 80) << px_per_deg;
    EXPECT_GE(steps.figure_deg / steps.tick_deg, 1.9);
    EXPECT_LE(steps.figure_deg / steps.tick_deg, 6.1);
    EXPECT_NEAR(steps.room_deg * px_per_deg, 40, 1e-9);
    // The steps are not needlessly coarse.
    if (px_per_deg < 5e4 && px_per_deg > 1) {
      EXPECT_LT(steps.figure_deg * px_per_deg, 80 * 3.1) << px_per_deg;
    }
  }
  EXPECT_EQ(compass_steps(0.1, 40).figure_deg, 90);
  EXPECT_EQ(compass_steps(1e9, 40).figure_deg, 0.001);
  EXPECT_EQ(compass_steps(8, 40).figure_deg, 10);
}

TEST(Compass, WindsAndFigures) {
  const auto whole = labels(compass_marks(0, 360, {5, 30, 4}));
  EXPECT_EQ(whole.at(0), "N");
  EXPECT_EQ(whole.at(45), "NE");
  EXPECT_EQ(whole.at(315), "NW");
  EXPECT_EQ(whole.at(30), "30\u00b0");
  EXPECT_EQ(whole.at(360), "N");
  EXPECT_EQ(whole.size(), 17U);  // 9 winds with both ends, 8 figures
  // Four winds where eight have no room.
  const auto few = labels(compass_marks(0, 359, {15, 90, 60}));
  EXPECT_EQ(few.size(), 4U);
  // Figures give way to winds.
  const auto tens = labels(compass_marks(30, 30, {2, 10, 6}));
  EXPECT_EQ(tens, (std::map<double, std::string>{{30, "30\u00b0"}, {45, "NE"}, {60, "60\u00b0"}}));
  // Across north, beyond one full circle, with the decimals that the step needs.
  const auto north = labels(compass_marks(-0.25, 0.5, {0.02, 0.1, 0.01}));
  EXPECT_EQ(north.size(), 5U);
  EXPECT_EQ(north.begin()->second, "359.8\u00b0");
  EXPECT_EQ(labels(compass_marks(719.5, 1, {0.1, 0.5, 0.1})).at(720), "N");
  EXPECT_EQ(labels(compass_marks(359.9, 0.05, {0.1, 0.5, 0.1})).size(), 0U);
}

TEST(Compass, AzimuthsAscendAndNoneIsTwice) {
  for (const CompassSteps& steps :
       {CompassSteps{10, 30, 5}, CompassSteps{2, 10, 3}, CompassSteps{15, 45, 20}}) {
    const auto marks = compass_marks(-37, 360, steps);
    for (std::size_t n = 1; n < marks.size(); ++n)
      ASSERT_GT(marks[n].azimuth_deg, marks[n - 1].azimuth_deg + 1e-6) << n;
    ASSERT_GE(marks.front().azimuth_deg, -37 - 1e-6);
    ASSERT_LE(marks.back().azimuth_deg, 323 + 1e-6);
  }
}

double azimuth_at(const View& view, const mars::LocalFrame& frame, glm::dvec2 at) {
  const auto part = vpe::core::drawn_part(view);
  const glm::dvec3 ray = vpe::core::pixel_ray(view, part.x + at.x, part.y + at.y);
  return std::atan2(glm::dot(ray, frame.east), glm::dot(ray, frame.north)) / mars::kRadiansPerDegree;
}

double elevation_at(const View& view, const mars::LocalFrame& frame, glm::dvec2 at) {
  const auto part = vpe::core::drawn_part(view);
  return std::asin(glm::dot(vpe::core::pixel_ray(view, part.x + at.x, part.y + at.y), frame.up)) /
         mars::kRadiansPerDegree;
}

TEST(Compass, MarksOfViewsAreAtTheirAzimuths) {
  const mars::LocalFrame frame = mars::local_frame({50, 30});
  for (const mars::Pose& pose :
       {mars::Pose{50, 30, 1000, 10, 0, 0}, mars::Pose{50, 30, 1000, 170, -35, 20},
        mars::Pose{50, 30, 1000, 359, 60, -75}, mars::Pose{50, 30, 1000, 200, -20, 180}}) {
    View view = view_at(pose, 1280, 720, 50);
    for (const bool has_part : {false, true}) {
      if (has_part) view.part = {300, 100, 701, 431};
      if (has_part) view.principal_offset_px = {40, -30};
      const glm::ivec2 size = vpe::core::drawn_size(view);
      const auto row = compass_row(view, frame, 50);
      ASSERT_GE(row.size(), 3U);
      for (const PlacedMark& m : row) {
        ASSERT_NEAR(m.at.y, 0.5 * size.y, 1e-9);
        ASSERT_GE(m.at.x, 0);
        ASSERT_LE(m.at.x, size.x);
        ASSERT_NEAR(std::remainder(azimuth_at(view, frame, m.at) - m.mark.azimuth_deg, 360), 0, 1e-9);
      }
      const auto line = horizon_line(view, frame);
      const auto horizon = compass_horizon(view, frame, 50);
      ASSERT_EQ(line.has_value(), !horizon.empty());
      for (const PlacedMark& m : horizon) {
        ASSERT_NEAR(elevation_at(view, frame, m.at), 0, 1e-9);
        ASSERT_NEAR(std::remainder(azimuth_at(view, frame, m.at) - m.mark.azimuth_deg, 360), 0, 1e-9);
        ASSERT_TRUE(m.at.x >= -1e-9 && m.at.y >= -1e-9 && m.at.x <= size.x + 1e-9 && m.at.y <= size.y + 1e-9);
      }
      if (!line) continue;
      ASSERT_NEAR(elevation_at(view, frame, line->left), 0, 1e-9);
      ASSERT_NEAR(elevation_at(view, frame, line->right), 0, 1e-9);
      ASSERT_LE(line->left.x, line->right.x);
    }
  }
}

TEST(Compass, CylindricalViewsAndViewsWithoutOrder) {
  const mars::LocalFrame frame = mars::local_frame({50, 30});
  View view = view_at({50, 30, 1000, 75, 0, 0}, 2000, 500, 60);
  view.projection = vpe::core::Projection::kCylinder;
  view.part = {500, 100, 900, 300};
  for (const PlacedMark& m : compass_row(view, frame, 50))
    ASSERT_NEAR(std::remainder(azimuth_at(view, frame, m.at) - m.mark.azimuth_deg, 360), 0, 1e-9);
  EXPECT_GE(compass_row(view, frame, 50).size(), 10U);
  ASSERT_FALSE(compass_horizon(view, frame, 50).empty());
  EXPECT_NEAR(compass_horizon(view, frame, 50).front().at.y, 150, 1e-9);
  view.camera = mars::to_camera({50, 30, 1000, 75, 3, 0}, kRadius_m);
  EXPECT_TRUE(compass_row(view, frame, 50).empty());
  // Straight up and down.
  for (const double pitch_deg : {90.0, -89.0})
    EXPECT_TRUE(compass_row(view_at({50, 30, 1000, 75, pitch_deg, 0}), frame, 50).empty());
  EXPECT_FALSE(compass_row(view_at({50, 30, 1000, 75, -80, 0}), frame, 50).empty());
  EXPECT_FALSE(horizon_line(view_at({50, 30, 1000, 75, -80, 0}), frame));
}

}  // namespace
}  // namespace overlay_test
