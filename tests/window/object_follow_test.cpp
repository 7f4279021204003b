// Tests views of objects in the window, the camera that follows one, the time of a scene, and lines of sight in it.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "tests/window/objects_fixture.h"
#include "vpe/explore/objects/item_balls.h"

namespace vpe::window {
namespace {

using ObjectFollowTest = ObjectsPanelTest;

TEST_F(ObjectFollowTest, TheCameraGoesToAnObjectAndFollowsOneThatMoves) {
  open_above(file());
  const double radius_m = window_->session().ground().radius_m;
  // Returns the camera's distance from the driver, and how far it looks past its middle, radians.
  const auto sight = [&] {
    const auto balls = explore::balls_of(*item("Driver"), editor().models(), app::model_ball,
                                         window_->session().ground(), window_->objects().time_s());
    const mars::CameraPose camera = mars::to_camera(window_->session().pose(), radius_m);
    const glm::dvec3 to = balls.at(0).centre_m - camera.position_m;
    return std::pair{glm::length(to), glm::length(glm::normalize(to) - camera.axes.forward)};
  };
  click("object Driver");
  click("Go to##object");
  settle();
  EXPECT_LT(sight().second, 1e-6);
  const double there_m = sight().first;
  EXPECT_NEAR(there_m, 5 * 20000 * std::sqrt(3), 20000);
  click("Follow");
  iterate(3);
  EXPECT_EQ(window_->objects().followed(), item("Driver")->id);
  click("Play##objects");
  const double lon_deg = window_->session().pose().lon_deg;
  for (int n = 0; n < 5000 && window_->objects().time_s() < 1; ++n) iterate(1);
  EXPECT_GE(window_->objects().time_s(), 1);
  EXPECT_GT(window_->session().pose().lon_deg, lon_deg + 0.03);
  EXPECT_LT(sight().second, 1e-6);
  EXPECT_NEAR(sight().first, there_m, 1);
  // An image of that time is drawn once those before it are.
  for (int n = 0; n < 5000 && window_->drawn()->request.flight_time_s <= 0.5; ++n) iterate(1);
  EXPECT_GT(window_->drawn()->request.flight_time_s, 0.5);
  click("Pause##objects");
  settle();
  // A drag turns about it, and the wheel changes the distance.
  const double yaw_deg = window_->session().pose().yaw_deg;
  drag({700, 300}, {60, 0});
  EXPECT_GT(std::remainder(window_->session().pose().yaw_deg - yaw_deg, 360.0), 5);
  EXPECT_LT(sight().second, 1e-6);
  EXPECT_NEAR(sight().first, there_m, 1);
  robot_->wheel(2);
  iterate(5);
  EXPECT_NEAR(sight().first, there_m / (1.35 * 1.35), 1);
  EXPECT_EQ(editor().undo_text(), "");
  key("Escape");
  EXPECT_EQ(window_->objects().followed(), 0U);
  const mars::Pose left_at = window_->session().pose();
  click("Play##objects");
  iterate(30);
  EXPECT_EQ(window_->session().pose().lon_deg, left_at.lon_deg);
  click("Pause##objects");
  settle();
}

TEST_F(ObjectFollowTest, AFlightGivesTheTime) {
  open_above(file());
  scripts::Flight flight;
  flight.waypoints.resize(2);
  for (scripts::Waypoint& w : flight.waypoints) {
    w.lon_deg = 20;
    w.lat_deg = 10;
    w.up_m = 600'000;
    w.pitch_deg = -90;
  }
  flight.waypoints[1].time_s = 60;
  ASSERT_EQ(window_->session().flights().load(flight), "");
  window_->session().scrub(25);
  settle();
  EXPECT_EQ(window_->objects().time_s(), 25);
  EXPECT_EQ(window_->drawn()->request.flight_time_s, 25);
  // The camera stands still, and the driver does not.
  window_->session().scrub(50);
  settle();
  EXPECT_EQ(window_->drawn()->request.flight_time_s, 50);
}

TEST_F(ObjectFollowTest, AClickFindsAnObjectWhereAFlightHasIt) {
  open_above(file());
  scripts::Flight flight;
  flight.waypoints.resize(2);
  for (scripts::Waypoint& w : flight.waypoints) {
    w.lon_deg = 20;
    w.lat_deg = 10;
    w.up_m = 600'000;
    w.pitch_deg = -90;
  }
  flight.waypoints[1].time_s = 60;
  flight.objects = {{0, "One", core::ObjectPlace{20, 10}, {}}, {60, "One", core::ObjectPlace{24, 10}, {}}};
  ASSERT_EQ(window_->session().flights().load(flight), "");
  window_->session().scrub(30);
  settle();
  ASSERT_TRUE(window_->session().follows_flight());
  const glm::dvec2 former = seen({20, 10});
  const glm::dvec2 now = seen({22, 10});
  click(former.x, former.y);
  EXPECT_EQ(window_->objects().selected(), 0U);
  click(now.x, now.y);
  EXPECT_EQ(window_->objects().selected(), item("One")->id);
  // It is the flight that moves it.
  drag(now, {60, 0});
  EXPECT_EQ(placing("One").place.lon_deg, 20);
  EXPECT_FALSE(editor().is_changed());
  // The camera goes to where it is without the flight.
  click("Go to##object");
  settle();
  EXPECT_FALSE(window_->session().follows_flight());
  const auto balls =
      explore::balls_of(*item("One"), editor().models(), app::model_ball, window_->session().ground(), 0);
  const mars::CameraPose camera =
      mars::to_camera(window_->session().pose(), window_->session().ground().radius_m);
  const glm::dvec3 to = glm::normalize(balls.at(0).centre_m - camera.position_m);
  EXPECT_LT(glm::length(to - camera.axes.forward), 1e-6);
}

TEST_F(ObjectFollowTest, LinesOfSightMeetTheObjectsThatAreShown) {
  open_above(file());
  for (const double lon_deg : {18.5, 21.5}) {
    const glm::dvec2 at = seen({lon_deg, 10});
    move(at.x, at.y);
    key("m");
  }
  ASSERT_EQ(window_->measure().points().size(), 2U);
  click("Measure");
  enter("A (m)##from", "15000");
  enter("B (m)##to", "15000");
  const auto sight = [this] {
    const Measured* measured = window_->measure().measured();
    if (measured == nullptr || !measured->sight) throw std::runtime_error("nothing was measured");
    return *measured->sight;
  };
  ASSERT_TRUE(sight().obstruction);
  EXPECT_EQ(sight().obstruction->object, "One");
  EXPECT_NEAR(sight().obstruction->distance_m, 0.5 * sight().distance_m - 20'000, 1000);
  // Moved aside, though not saved, it does not obstruct.
  click("Objects");
  drag(seen({20, 10}), {0, -250});
  settle();
  ASSERT_EQ(copies().size(), 1U);
  EXPECT_EQ(window_->measure().measured()->request.scene.file, copies()[0].string());
  EXPECT_TRUE(sight().visible);
  with_control("z");
  settle();
  EXPECT_EQ(window_->measure().measured()->request.scene.file, file().string());
  ASSERT_TRUE(sight().obstruction);
  EXPECT_EQ(sight().obstruction->object, "One");
}

}  // namespace
}  // namespace vpe::window
