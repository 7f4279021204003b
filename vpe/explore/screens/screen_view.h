// The views of screens that stand in a room, for a head anywhere in it: perspective views whose image plane is the
// screen, with a principal point beside its middle.
//
// The room is put into the world at a scale s: its frame has the axes of the platform (right, up, backwards), and the
// platform's camera is where the head rests. So a head at rest before a screen sees what the platform's camera sees,
// through a window; at s = 1 a step of the head is a step of the walker, at s = 10^4 the ground 5 km below the camera
// lies 0.5 m below the head, on a table. A point of the world that lies in the plane of a screen keeps its place on it
// wherever the head is.
//
// All functions are pure and may be called from any thread.
//
// Typical usage:
//   const Room room{set.rest_m, set.eye_base_m, set.scale};
//   if (const auto view = screen_view(screen, head, platform, room, 0)) draw(*view);
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/core/view.h"
#include "vpe/explore/input/head_tracker.h"
#include "vpe/explore/screens/placed_screen.h"

namespace vpe::explore {

// Describes how a room lies in the world.
struct Room {
  glm::dvec3 rest_m{0, 0, 0};  // place in the room of a head at HeadPlace::position_m = 0
  double eye_base_m = 0.063;   // distance between the eyes, in the room
  double scale = 1;            // metres of the world for a metre of the room, > 0
};

// Returns the room of a set.
inline Room room_of(const ScreenSet& set) { return {set.rest_m, set.eye_base_m, set.scale}; }

// Returns -1 for a left eye, 1 for a right one, 0 for the middle between both.
int side_of(ScreenEye eye);

// Returns the sides that a screen needs images for: -1 and 1 for a pair in turn, else one. Where the driver has no pairs
// in turn, a screen for them shows the middle.
std::vector<int> sides_of(ScreenEye eye, bool has_pairs);

// Returns the place of an eye in the room: `side` times half the eye base to the right of the head's middle, as the head
// is turned.
glm::dvec3 eye_in_room(const HeadPlace& head, const Room& room, int side);

// Returns where a point of the room is in the world.
glm::dvec3 in_world(const glm::dvec3& point_m, const mars::CameraPose& platform, const Room& room);

// An eye before a screen must be farther from its plane than this part of the screen's height.
inline constexpr double kLeastEyeDistance = 0.01;

// Returns the view of a screen that check() accepts for an eye (`side` as in side_of()). Its image fills the screen; with
// a lens it is the undistorted image that lens_image() describes. Corners of a screen project to the corners of the image
// within 1e-9 of its sides, and within the bound of core::project() where the platform is far from the planet's centre.
// Returns nullopt for an eye that is behind the screen or closer to its plane than kLeastEyeDistance, or so far beside it
// that core::check() refuses the view.
std::optional<core::View> screen_view(const PlacedScreen& screen, const HeadPlace& head,
                                      const mars::CameraPose& platform, const Room& room, int side);

// Returns the platform of a pose: as it is, or with its heading alone.
mars::CameraPose screen_platform(const mars::Pose& pose, bool is_level, double radius_m);

}  // namespace vpe::explore
