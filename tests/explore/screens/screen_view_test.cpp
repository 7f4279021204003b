// Tests of the views of screens: corners, points of a table, eyes, what is refused.
#include "vpe/explore/screens/screen_view.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <random>

#include "mars/geodesy/sphere.h"

namespace vpe::explore {
namespace {

double number_between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 1'000'001) / 1e6;
}

glm::dvec3 point_within(double most) {
  return {number_between(-most, most), number_between(-most, most), number_between(-most, most)};
}

mars::Axes any_axes() {
  const mars::LocalFrame frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return mars::oriented_axes(frame, number_between(-180, 180), number_between(-90, 90),
                             number_between(-180, 180));
}

// Returns a screen at any place, in any attitude.
PlacedScreen any_screen() {
  PlacedScreen screen;
  screen.name = "any";
  screen.width_px = *rc::gen::inRange(200, 4000);
  screen.height_px = *rc::gen::inRange(200, 4000);
  const mars::Axes axes = any_axes();
  const double height_m = number_between(0.25, 5);
  const glm::dvec3 across = axes.right * (height_m * screen.width_px / screen.height_px);
  const glm::dvec3 corner = point_within(5);
  screen.place = ScreenCorners{corner, corner + across, corner - axes.up * height_m};
  return screen;
}

const ScreenCorners& corners_of(const PlacedScreen& screen) { return std::get<ScreenCorners>(screen.place); }

// Returns a head before the screen, also far beside it.
HeadPlace head_before(const PlacedScreen& screen, const Room& room) {
  const ScreenCorners& c = corners_of(screen);
  const glm::dvec3 across = c.upper_right_m - c.upper_left_m;
  const glm::dvec3 down = c.lower_left_m - c.upper_left_m;
  const glm::dvec3 towards = glm::normalize(glm::cross(down, across));
  const glm::dvec3 before = -towards * (glm::length(down) * number_between(0.02, 4));
  HeadPlace head;
  head.position_m =
      c.upper_left_m + across * number_between(-2, 3) + down * number_between(-2, 3) - before - room.rest_m;
  head.look = {number_between(-180, 180), number_between(-90, 90), number_between(-180, 180)};
  return head;
}

RC_GTEST_PROP(ScreenViewProperty, CornersAreTheCornersOfTheImage, ()) {
  const PlacedScreen screen = any_screen();
  RC_ASSERT(check(screen) == "");
  Room room;
  room.rest_m = point_within(2);
  room.scale = std::pow(10.0, number_between(-3, 8));
  // At the planet's centre nothing is lost to large coordinates.
  const mars::CameraPose platform{{0, 0, 0}, any_axes()};
  const HeadPlace head = head_before(screen, room);
  const auto view = screen_view(screen, head, platform, room, 0);
  RC_ASSERT(view.has_value());
  RC_ASSERT(core::check(*view) == "");
  const ScreenCorners& c = corners_of(screen);
  const glm::dvec3 lower_right_m = c.upper_right_m + c.lower_left_m - c.upper_left_m;
  const std::pair<glm::dvec3, glm::dvec2> all[] = {
      {c.upper_left_m, {0, 0}}, {c.upper_right_m, {1, 0}}, {c.lower_left_m, {0, 1}}, {lower_right_m, {1, 1}}};
  for (const auto& [corner, place] : all) {
    const core::Projected seen = core::project(*view, in_world(corner, platform, room));
    RC_ASSERT(!seen.behind);
    const glm::dvec2 off = seen.xy / glm::dvec2(view->width, view->height) - place;
    RC_ASSERT(std::abs(off.x) <= 1e-9);
    RC_ASSERT(std::abs(off.y) <= 1e-9);
  }
}

// The oracle is the frustum of OpenGL with the screen's edges on its near plane (glFrustum, as GLM has it).
RC_GTEST_PROP(ScreenViewProperty, EqualsAFrustumThroughTheEdges, ()) {
  const PlacedScreen screen = any_screen();
  const mars::CameraPose platform{{0, 0, 0}, any_axes()};
  const HeadPlace head = head_before(screen, Room{});
  const auto view = screen_view(screen, head, platform, Room{}, 0);
  RC_ASSERT(view.has_value());
  const ScreenCorners& c = corners_of(screen);
  const glm::dvec3 right = glm::normalize(c.upper_right_m - c.upper_left_m);
  const glm::dvec3 up = glm::normalize(c.upper_left_m - c.lower_left_m);
  const glm::dvec3 back = glm::cross(right, up);
  const auto edge = [&](const glm::dvec3& p, const glm::dvec3& axis) {
    return glm::dot(p - head.position_m, axis);
  };
  const double near_m = -edge(c.upper_left_m, back);
  const glm::dmat4 frustum =
      glm::frustum(edge(c.upper_left_m, right), edge(c.upper_right_m, right), edge(c.lower_left_m, up),
                   edge(c.upper_left_m, up), near_m, 1000 * near_m);
  const glm::dvec3 point = head.position_m - back * (near_m * number_between(0.5, 100)) + point_within(1);
  const double depth_m = -edge(point, back);
  RC_PRE(depth_m > 0.01 * near_m);
  const glm::dvec4 clip = frustum * glm::dvec4(edge(point, right), edge(point, up), -depth_m, 1);
  const glm::dvec2 expected{(0.5 + 0.5 * clip.x / clip.w) * screen.width_px,
                            (0.5 - 0.5 * clip.y / clip.w) * screen.height_px};
  const core::Projected seen = core::project(*view, in_world(point, platform, Room{}));
  RC_ASSERT(!seen.behind);
  RC_ASSERT(glm::length(seen.xy - expected) <= 1e-9 *
                                                   (glm::length(expected) + screen.width_px + screen.height_px +
                                                    glm::length(view->principal_offset_px)) *
                                                   std::max(1.0, near_m / depth_m));
}

PlacedScreen table_screen() {
  PlacedScreen screen;
  screen.name = "table";
  screen.width_px = 1920;
  screen.height_px = 1080;
  screen.place = ScreenCorners{{-0.3, 0, -0.2}, {0.3, 0, -0.2}, {-0.3, 0, 0.1375}};
  return screen;
}

// Returns the largest motion of points of the table's plane on the screen, pixels, and draws heads from a fixed seed.
double largest_motion_px(double scale, int heads) {
  const PlacedScreen table = table_screen();
  Room room;
  room.rest_m = {0, 0.5, 0.5};
  room.scale = scale;
  const mars::CameraPose platform =
      screen_platform({137.4, -4.6, 0.5 * scale, 40, -30, 10}, true, mars::kMarsRadius_m);
  std::mt19937 random(20261127);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double most_px = 0;
  for (int n = 0; n < heads; ++n) {
    const glm::dvec2 place{between(0, 1), between(0, 1)};
    const glm::dvec3 point_m = in_world({-0.3 + 0.6 * place.x, 0, -0.2 + 0.3375 * place.y}, platform, room);
    HeadPlace head{{between(-1, 1), between(-0.4, 0.5), between(-1.2, 0.6)},
                   {between(-180, 180), between(-90, 90), between(-90, 90)}};
    const int side = static_cast<int>(n % 3) - 1;
    const auto view = screen_view(table, head, platform, room, side);
    if (!view) return 1e9;
    const glm::dvec2 wanted = place * glm::dvec2(1920, 1080);
    most_px = std::max(most_px, glm::length(core::project(*view, point_m).xy - wanted));
  }
  return most_px;
}

// Positions from the planet's centre are rounded to 5e-10 m: of a pixel of the table, 3e-4 m at the scale 1.
TEST(ScreenView, APointOfTheTableStaysForTenThousandHeads) {
  EXPECT_LE(largest_motion_px(1e4, 10'000), 1e-7);
  EXPECT_LE(largest_motion_px(1, 10'000), 1e-4);
}

TEST(ScreenView, AHeadAtRestSeesWhatThePlatformSees) {
  PlacedScreen wall;
  wall.width_px = 800;
  wall.height_px = 600;
  wall.place = ScreenCorners{{-0.4, 0.3, -1}, {0.4, 0.3, -1}, {-0.4, -0.3, -1}};
  const mars::CameraPose platform = mars::to_camera({10, 20, 3000, 30, -20, 5}, mars::kMarsRadius_m);
  const auto view = screen_view(wall, {}, platform, Room{}, 0);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->camera.position_m, platform.position_m);
  EXPECT_LT(glm::length(view->camera.axes.forward - platform.axes.forward), 1e-15);
  EXPECT_LT(glm::length(view->principal_offset_px), 1e-9);
  EXPECT_NEAR(view->fov_deg, 2 * std::atan(0.3) / mars::kRadiansPerDegree, 1e-12);
}

TEST(ScreenView, EyesAreBesideTheHeadAsItIsTurned) {
  Room room;
  room.rest_m = {1, 2, 3};
  room.eye_base_m = 0.06;
  HeadPlace head;
  EXPECT_LT(glm::length(eye_in_room(head, room, 1) - glm::dvec3(1.03, 2, 3)), 1e-15);
  EXPECT_LT(glm::length(eye_in_room(head, room, 0) - glm::dvec3(1, 2, 3)), 1e-15);
  head.look.yaw_deg = 90;  // to the right: the right eye is nearer to the viewer's back
  EXPECT_LT(glm::length(eye_in_room(head, room, 1) - glm::dvec3(1, 2, 3.03)), 1e-15);
  head.look = {0, 0, 90};  // onto the right shoulder: the right eye is below
  EXPECT_LT(glm::length(eye_in_room(head, room, 1) - glm::dvec3(1, 1.97, 3)), 1e-15);
  head.position_m = {0.1, 0.2, -0.3};
  EXPECT_LT(glm::length(eye_in_room(head, room, -1) - glm::dvec3(1.1, 2.23, 2.7)), 1e-15);
}

TEST(ScreenView, SidesFollowTheEye) {
  EXPECT_EQ(sides_of(ScreenEye::kMiddle, true), std::vector<int>{0});
  EXPECT_EQ(sides_of(ScreenEye::kLeft, true), std::vector<int>{-1});
  EXPECT_EQ(sides_of(ScreenEye::kRight, false), std::vector<int>{1});
  EXPECT_EQ(sides_of(ScreenEye::kBoth, true), (std::vector<int>{-1, 1}));
  EXPECT_EQ(sides_of(ScreenEye::kBoth, false), std::vector<int>{0});
  EXPECT_EQ(side_of(ScreenEye::kBoth), 0);
}

TEST(ScreenView, AHeadBehindTheScreenHasNoView) {
  const mars::CameraPose platform = mars::to_camera({0, 0, 1000, 0, 0, 0}, mars::kMarsRadius_m);
  const Room room{{0, 0, 0}, 0.063, 1};
  EXPECT_TRUE(screen_view(table_screen(), {{0, 0.5, 0}, {}}, platform, room, 0));
  EXPECT_FALSE(screen_view(table_screen(), {{0, -0.5, 0}, {}}, platform, room, 0));
  EXPECT_FALSE(screen_view(table_screen(), {{0, 0, 0}, {}}, platform, room, 0));
  EXPECT_FALSE(screen_view(table_screen(), {{0, 0.9 * kLeastEyeDistance * 0.3375, 0}, {}}, platform, room, 0));
  EXPECT_FALSE(screen_view(table_screen(), {{1e9, 0.5, 0}, {}}, platform, room, 0));
  EXPECT_FALSE(screen_view(table_screen(), {{0, NAN, 0}, {}}, platform, room, 0));
}

TEST(ScreenView, APlatformMayHaveItsHeadingAlone) {
  const mars::Pose pose{10, 20, 3000, 70, -60, 15};
  const mars::CameraPose level = screen_platform(pose, true, 1000);
  const glm::dvec3 up = mars::direction({10, 20});
  EXPECT_LT(glm::length(level.axes.up - up), 1e-14);
  EXPECT_NEAR(mars::to_pose(level, 1000).yaw_deg, 70, 1e-9);
  const mars::CameraPose same = screen_platform(pose, false, 1000);
  EXPECT_EQ(same.axes.forward, mars::to_camera(pose, 1000).axes.forward);
}

TEST(ScreenView, ALensGoesWithTheHead) {
  PlacedScreen screen;
  screen.eye = ScreenEye::kLeft;
  screen.width_px = 960;
  screen.height_px = 1080;
  ScreenLens lens;
  lens.distortion = {0.2, 0.1, 0, 0};
  lens.width_m = 0.075;
  screen.place = lens;
  ASSERT_EQ(check(screen), "");
  const mars::Pose pose{10, 20, 3000, 30, -20, 5};
  const mars::CameraPose platform = mars::to_camera(pose, mars::kMarsRadius_m);
  HeadPlace head;
  head.look = {25, 10, -15};
  const auto view = screen_view(screen, head, platform, Room{}, -1);
  ASSERT_TRUE(view);
  const mars::CameraPose turned = mars::to_camera(pose, head.look, mars::kMarsRadius_m);
  EXPECT_LT(glm::length(view->camera.axes.forward - turned.axes.forward), 1e-14);
  EXPECT_LT(glm::length(view->camera.axes.up - turned.axes.up), 1e-14);
  const LensImage image = lens_image(lens, 960, 1080, -1);
  EXPECT_EQ(view->width, image.width_px);
  EXPECT_NEAR(core::focal_px(*view), image.focal_px, 1e-9 * image.focal_px);
  const core::Projected axis = core::project(*view, view->camera.position_m + 1e6 * view->camera.axes.forward);
  EXPECT_LT(glm::length(axis.xy - image.axis_px), 1e-6);
  EXPECT_LT(glm::length(view->camera.position_m - (platform.position_m - 0.0315 * turned.axes.right)), 2e-9);
}

}  // namespace
}  // namespace vpe::explore
