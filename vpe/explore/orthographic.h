// The orthographic camera: a perspective camera so far away that its lines of sight are nearly parallel.
//
// Every part of the program then works as with other cameras: level of detail, culling, both backends, flights, bookmarks.
#pragma once

#include <optional>

#include "mars/geodesy/pose.h"
#include "vpe/explore/mouse.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

// The field of view of the orthographic camera. Smaller: lines of sight are closer to parallel, while rounding of depths grows
// in proportion.
inline constexpr double kOrthographicFov_deg = 0.1;

// Returns true for a field of view of the orthographic camera or a smaller one.
inline bool is_orthographic(double fov_deg) { return fov_deg <= kOrthographicFov_deg; }

// Returns the highest altitude of a camera in radii of the planet: SteerLimits::kHighest_radii, and for the orthographic camera
// the one from which as much is seen as from there with a field of view of 50 degrees.
double highest_radii(double fov_deg);

// Returns the pose on the present line of sight from which a camera with another field of view shows the ground in the middle of
// the image as large as it is now; nullopt if the middle shows sky. Pure.
std::optional<mars::Pose> at_same_size(const mars::Pose& pose, const Screen& screen, double fov_deg,
                                       const TerrainQuery& ground);

// Returns the height of what the image shows at the distance of the ground in its middle, metres; nullopt for the sky.
std::optional<double> shown_height_m(const mars::Pose& pose, const Screen& screen, const TerrainQuery& ground);

// Returns an upper bound of the distance in the image, in pixels, between where the camera shows a point and where parallel
// lines of sight show it. `depth_m` is how far the point lies before or behind the middle along the line of sight, and
// `shown_m` what shown_height_m() returns. Infinity for points behind the camera.
double parallel_shift_px(const Screen& screen, double shown_m, double depth_m);

}  // namespace vpe::explore
