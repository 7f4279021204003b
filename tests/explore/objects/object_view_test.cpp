// Tests where items are, which one a ray meets, how a camera sees them, and the time of a scene.
#include "vpe/explore/objects/object_view.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/pose.h"
#include "objects/scene/place.h"
#include "tests/explore/terrain_support.h"
#include "vpe/core/view.h"
#include "vpe/explore/objects/scene_clock.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

constexpr double kRadius_m = mars::kMarsRadius_m;
const std::vector<objects::ModelEntry> kModels{{"rover", "/rover.glb"}};

objects::Ball rover_ball(const objects::ModelEntry&) { return {{0, 0, 1.5F}, 2}; }

SceneItem object_at(std::vector<objects::Placing> places) {
  return {1, objects::ObjectEntry{"n", 0, std::move(places)}};
}

ItemBall ball_at(mars::LonLat place, double height_m, double radius_m) {
  const glm::dvec3 up = mars::direction(place);
  return {up * (kRadius_m + height_m), radius_m, up * kRadius_m};
}

TEST(ItemBalls, StandWhereTheObjectsDo) {
  const TerrainQuery ground = hills();
  objects::Placing placing;
  placing.place = {30, 40};
  placing.height_m = 7;
  placing.scale = 3;
  const auto balls = balls_of(object_at({placing}), kModels, rover_ball, ground, 0);
  ASSERT_EQ(balls.size(), 1U);
  const glm::dvec3 up = mars::direction(placing.place);
  const double ground_m = kRadius_m + ground.height_m(up);
  EXPECT_LT(glm::length(balls[0].origin_m - up * (ground_m + 7)), 1e-6);
  EXPECT_LT(glm::length(balls[0].centre_m - up * (ground_m + 7 + 3 * 1.5)), 1e-5);
  EXPECT_EQ(balls[0].radius_m, 6);
  // On its side the middle of the model lies to the right.
  placing.roll_deg = 90;
  placing.heading_deg = 0;
  const auto rolled = balls_of(object_at({placing}), kModels, rover_ball, ground, 0);
  const glm::dvec3 east = mars::local_frame(placing.place).east;
  EXPECT_LT(glm::length(rolled[0].centre_m - (rolled[0].origin_m + 4.5 * east)), 1e-5);
}

TEST(ItemBalls, AreOneForEachPlaceUpToALimit) {
  EXPECT_EQ(balls_of(object_at({{}, {}, {}}), kModels, rover_ball, ball(kRadius_m), 0).size(), 3U);
  std::vector<objects::Placing> many(ItemBallLimits::kMostOfItem + 5);
  EXPECT_EQ(balls_of(object_at(many), kModels, rover_ball, ball(kRadius_m), 0).size(),
            ItemBallLimits::kMostOfItem);
}

TEST(ItemBalls, MoveAlongPathsAndEncloseScatters) {
  const objects::PathEntry path{"p", 0, {{0, {0, 0}}, {10, {1, 0}}}};
  const TerrainQuery ground = ball(kRadius_m);
  for (const double time_s : {0.0, 2.5, 10.0}) {
    const auto balls = balls_of({1, path}, kModels, rover_ball, ground, time_s);
    ASSERT_EQ(balls.size(), 1U);
    EXPECT_LT(glm::length(balls[0].origin_m - kRadius_m * mars::direction({time_s / 10, 0})), 1e-6);
  }
  objects::ScatterEntry scatter;
  scatter.polygon = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto balls = balls_of({1, scatter}, kModels, rover_ball, ground, 0);
  ASSERT_EQ(balls.size(), 1U);
  EXPECT_NEAR(glm::length(balls[0].origin_m), kRadius_m, 1e-6);
  for (const mars::LonLat corner : scatter.polygon)
    EXPECT_LE(glm::length(kRadius_m * mars::direction(corner) - balls[0].centre_m),
              balls[0].radius_m * (1 + 1e-12));
}

TEST(ItemBalls, AreOnTheWaysOfAFlightOrGone) {
  const TerrainQuery ground = hills();
  const auto balls = [&](const SceneItem& item, double time_s, const std::vector<core::ObjectTrack>* tracks) {
    return balls_of(item, kModels, rover_ball, ground, time_s, track_of(item, tracks));
  };
  objects::Placing placing;
  placing.place = {30, 40};
  const SceneItem object = object_at({placing});
  const SceneItem path{2, objects::PathEntry{"p", 0, {{0, {5, 5}}, {10, {6, 5}}}}};
  const std::vector<core::ObjectTrack> tracks{{"n", {{0, {0, 0, 7}}, {10, {1, 0, 7}}}, {{20, false}}},
                                              {"p", {{0, {2, 0}}, {10, {3, 0}}}, {}}};
  const auto above = [&](mars::LonLat place, double height_m) {
    const glm::dvec3 up = mars::direction(place);
    return up * (kRadius_m + ground.height_m(up) + height_m);
  };
  for (const double time_s : {0.0, 2.5, 10.0, 19.0}) {
    const double moved_deg = std::min(time_s / 10, 1.0);
    ASSERT_EQ(balls(object, time_s, &tracks).size(), 1U);
    EXPECT_LT(glm::length(balls(object, time_s, &tracks)[0].origin_m - above({moved_deg, 0}, 7)), 1e-5);
    EXPECT_LT(glm::length(balls(path, time_s, &tracks)[0].origin_m - above({2 + moved_deg, 0}, 0)), 1e-5);
    EXPECT_LT(glm::length(balls(object, time_s, nullptr)[0].origin_m - above(placing.place, 0)), 1e-5);
  }
  EXPECT_TRUE(balls(object, 20, &tracks).empty());
  // A flight that only shows and hides an object leaves it in its place.
  const std::vector<core::ObjectTrack> hides{{"n", {}, {{20, false}}}};
  EXPECT_LT(glm::length(balls(object, 5, &hides)[0].origin_m - above(placing.place, 0)), 1e-5);
  EXPECT_TRUE(balls(object, 25, &hides).empty());
  // Ways are of paths and of objects with one place.
  EXPECT_EQ(track_of(object, &tracks), &tracks[0]);
  EXPECT_EQ(track_of(path, &tracks), &tracks[1]);
  EXPECT_EQ(track_of(object_at({placing, placing}), &tracks), nullptr);
  objects::ScatterEntry scatter;
  scatter.name = "n";
  EXPECT_EQ(track_of({3, scatter}, &tracks), nullptr);
  EXPECT_EQ(track_of(object, nullptr), nullptr);
  const std::vector<core::ObjectTrack> others{{"other", {}, {}}};
  EXPECT_EQ(track_of(object, &others), nullptr);
}

TEST(Pick, MeetsABallWhereItsSurfaceIs) {
  const ItemBall target{{100, 0, 0}, 5, {95, 0, 0}};
  const PickRay ray{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(meets(ray, target), 95.0);
  // Closed form: at an angle a the ray enters at d cos a - sqrt(r^2 - d^2 sin^2 a).
  const double a = 0.03;
  const auto at_m = meets({{0, 0, 0}, {std::cos(a), std::sin(a), 0}}, target);
  ASSERT_TRUE(at_m);
  EXPECT_NEAR(*at_m, 100 * std::cos(a) - std::sqrt(25 - 1e4 * std::pow(std::sin(a), 2)), 1e-9);
  EXPECT_FALSE(meets({{0, 0, 0}, {std::cos(0.051), std::sin(0.051), 0}}, target));
  EXPECT_FALSE(meets({{0, 0, 0}, {-1, 0, 0}}, target));                                     // behind
  EXPECT_FALSE(meets({{98, 0, 0}, {1, 0, 0}}, target));                                     // begins inside
  EXPECT_FALSE(meets({{0, 0, 0}, {1, 0, 0}, 94}, target));                                  // ground is nearer
  EXPECT_TRUE(meets({{0, 0, 0}, {std::cos(0.06), std::sin(0.06), 0}, 1e9, 0.07}, target));  // within reach
}

TEST(Pick, FindsTheNearestBallBeforeTheGround) {
  const std::vector<ItemBall> balls{{{200, 0, 0}, 5, {}}, {{100, 0, 0}, 5, {}}, {{150, 40, 0}, 5, {}}};
  const PickRay ray{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(first_met(ray, balls), 1U);
  EXPECT_EQ(first_met({{0, 0, 0}, {1, 0, 0}, 90}, balls), std::nullopt);
  EXPECT_EQ(first_met({{110, 0, 0}, {1, 0, 0}}, balls), 0U);
  EXPECT_EQ(first_met(ray, {}), std::nullopt);
}

// From wherever the offset is, the camera looks at the middle of the object.
RC_GTEST_PROP(ObjectViewProperty, PosesLookAtTheMiddle, ()) {
  const auto between = [](int low, int high) { return static_cast<double>(*rc::gen::inRange(low, high)); };
  const TerrainQuery ground = hills();
  const mars::LonLat place{between(-180, 180), between(-85, 85)};
  const glm::dvec3 up = mars::direction(place);
  const double radius_m = between(1, 50);
  const ItemBall target{up * (kRadius_m + ground.height_m(up) + radius_m), radius_m, {}};
  const ObjectOffset offset =
      turned(usual_offset(target, between(-180, 180)), target, 0, between(-69, 40), between(1, 40) / 4);
  const mars::Pose pose = pose_at(target, offset, ground);
  RC_ASSERT(height_above_ground_m(pose, ground) >= SteerLimits::kClearance_m * (1 - 1e-6));
  RC_ASSERT(pose.roll_deg == 0);
  const mars::CameraPose camera = mars::to_camera(pose, kRadius_m);
  const glm::dvec3 sight = glm::normalize(target.centre_m - camera.position_m);
  RC_ASSERT(glm::length(sight - camera.axes.forward) < 1e-6);
}

TEST(ObjectView, KeepsOffsets) {
  const TerrainQuery ground = ball(kRadius_m);
  const ItemBall target = ball_at({50, 60}, 2, 2);
  const ObjectOffset usual = usual_offset(target, 123);
  EXPECT_EQ(usual.distance_m, ObjectViewLimits::kRadii * 2);
  const mars::Pose pose = pose_at(target, usual, ground);
  const ObjectOffset back = offset_of(pose, target, kRadius_m);
  EXPECT_NEAR(back.heading_deg, 123, 1e-6);
  EXPECT_NEAR(back.pitch_deg, usual.pitch_deg, 1e-6);
  EXPECT_NEAR(back.distance_m, usual.distance_m, 1e-6);
  // The offset stays when the object is elsewhere.
  const ItemBall there = ball_at({-20, 10}, 2, 2);
  const ObjectOffset moved = offset_of(pose_at(there, back, ground), there, kRadius_m);
  EXPECT_NEAR(moved.heading_deg, 123, 1e-6);
  EXPECT_NEAR(moved.distance_m, usual.distance_m, 1e-6);
}

TEST(ObjectView, KeepsWithinLimits) {
  const ItemBall target = ball_at({50, 60}, 2, 2);
  const ObjectOffset near_one = turned(usual_offset(target, 0), target, 370, 200, 1e-9);
  EXPECT_NEAR(near_one.heading_deg, 10, 1e-12);
  EXPECT_EQ(near_one.pitch_deg, ObjectViewLimits::kLowest_deg);
  EXPECT_EQ(near_one.distance_m, ObjectViewLimits::kNearest_radii * 2);
  const ObjectOffset far_one = turned(usual_offset(target, 0), target, 0, -200, 1e9);
  EXPECT_EQ(far_one.pitch_deg, ObjectViewLimits::kHighest_deg);
  EXPECT_EQ(far_one.distance_m, ObjectViewLimits::kFarthest_radii * 2);
}

TEST(SceneClock, RunsToTheEndAndBeginsAgain) {
  SceneClock clock;
  EXPECT_FALSE(clock.can_play());
  clock.play(true);
  EXPECT_FALSE(clock.plays());
  clock.set_range({-5, 60});
  EXPECT_EQ(clock.begin_s(), -5);
  EXPECT_EQ(clock.end_s(), 60);
  EXPECT_EQ(clock.time_s(), 0);
  clock.advance(10);
  EXPECT_EQ(clock.time_s(), 0);
  clock.play(true);
  clock.advance(10);
  EXPECT_EQ(clock.time_s(), 10);
  clock.advance(100);
  EXPECT_EQ(clock.time_s(), 60);
  EXPECT_FALSE(clock.plays());
  clock.play(true);
  EXPECT_EQ(clock.time_s(), -5);
  clock.set(1000);
  EXPECT_EQ(clock.time_s(), 60);
  clock.set_range({0, 20});
  EXPECT_EQ(clock.time_s(), 20);
  clock.set_range({});
  EXPECT_EQ(clock.time_s(), 0);
  EXPECT_FALSE(clock.plays());
}

}  // namespace
}  // namespace vpe::explore
