#include "vpe/explore/screens/screen_view.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace vpe::explore {

namespace {

// Turns a vector of the room (right, up, backwards) into one of the world.
glm::dvec3 turned(const glm::dvec3& v, const mars::Axes& axes) {
  return axes.right * v.x + axes.up * v.y - axes.forward * v.z;
}

mars::Axes head_axes(const mars::HeadAngles& look) {
  const mars::LocalFrame room{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  return mars::oriented_axes(room, look.yaw_deg, look.pitch_deg, look.roll_deg);
}

double fov_of(double height_px, double focal_px) {
  return 2 * std::atan(0.5 * height_px / focal_px) / mars::kRadiansPerDegree;
}

// The image plane is the screen: the foot of the eye on it is the principal point, and the distance to it in pixels is
// the focal length.
std::optional<core::View> corner_view(const ScreenCorners& corners, const glm::dvec3& eye_room_m, int width_px,
                                      int height_px, const mars::Axes& platform) {
  const glm::dvec3 across = corners.upper_right_m - corners.upper_left_m;
  const glm::dvec3 down = corners.lower_left_m - corners.upper_left_m;
  const double width_m = glm::length(across);
  const double height_m = glm::length(down);
  const glm::dvec3 right = across / width_m;
  const glm::dvec3 up = -down / height_m;
  const glm::dvec3 forward = glm::cross(up, right);
  const glm::dvec3 to_corner = corners.upper_left_m - eye_room_m;
  const double distance_m = glm::dot(to_corner, forward);
  if (!(distance_m >= kLeastEyeDistance * height_m)) return std::nullopt;
  core::View view;
  view.width = width_px;
  view.height = height_px;
  view.fov_deg = fov_of(height_m, distance_m);
  view.principal_offset_px = {(-glm::dot(to_corner, right) / width_m - 0.5) * width_px,
                              (glm::dot(to_corner, up) / height_m - 0.5) * height_px};
  view.camera.axes = {turned(right, platform), turned(up, platform), turned(forward, platform)};
  return view;
}

core::View behind_lens(const ScreenLens& lens, const mars::HeadAngles& look, int width_px, int height_px,
                       int side, const mars::Axes& platform) {
  const LensImage image = lens_image(lens, width_px, height_px, side);
  core::View view;
  view.width = image.width_px;
  view.height = image.height_px;
  view.fov_deg = fov_of(image.height_px, image.focal_px);
  view.principal_offset_px = image.axis_px - 0.5 * glm::dvec2(image.width_px, image.height_px);
  const mars::Axes head = head_axes(look);
  view.camera.axes = {turned(head.right, platform), turned(head.up, platform), turned(head.forward, platform)};
  return view;
}

}  // namespace

int side_of(ScreenEye eye) { return eye == ScreenEye::kLeft ? -1 : eye == ScreenEye::kRight ? 1 : 0; }

std::vector<int> sides_of(ScreenEye eye, bool has_pairs) {
  if (eye == ScreenEye::kBoth && has_pairs) return {-1, 1};
  return {side_of(eye)};
}

glm::dvec3 eye_in_room(const HeadPlace& head, const Room& room, int side) {
  return room.rest_m + head.position_m + head_axes(head.look).right * (0.5 * side * room.eye_base_m);
}

glm::dvec3 in_world(const glm::dvec3& point_m, const mars::CameraPose& platform, const Room& room) {
  return platform.position_m + turned(point_m - room.rest_m, platform.axes) * room.scale;
}

std::optional<core::View> screen_view(const PlacedScreen& screen, const HeadPlace& head,
                                      const mars::CameraPose& platform, const Room& room, int side) {
  const glm::dvec3 eye_room_m = eye_in_room(head, room, side);
  std::optional<core::View> view;
  if (const auto* corners = std::get_if<ScreenCorners>(&screen.place))
    view = corner_view(*corners, eye_room_m, screen.width_px, screen.height_px, platform.axes);
  else
    view = behind_lens(std::get<ScreenLens>(screen.place), head.look, screen.width_px, screen.height_px, side,
                       platform.axes);
  if (!view) return std::nullopt;
  view->camera.position_m = in_world(eye_room_m, platform, room);
  return core::check(*view).empty() ? view : std::nullopt;
}

mars::CameraPose screen_platform(const mars::Pose& pose, bool is_level, double radius_m) {
  mars::Pose platform = pose;
  if (is_level) platform.pitch_deg = platform.roll_deg = 0;
  return mars::to_camera(platform, radius_m);
}

}  // namespace vpe::explore
