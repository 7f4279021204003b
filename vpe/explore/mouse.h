// Mouse navigation over a planet, as in common virtual globes: dragging with the left button holds the ground,
// the wheel zooms to the ground under the cursor, dragging with the right or middle button tilts and rotates
// about the ground in the middle, a double click flies there.
//
// Cursor positions are image positions of the view (vpe/core/view.h). All functions are pure. Every returned
// pose is above the ground (vpe/explore/steer.h).
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "mars/geodesy/pose.h"
#include "vpe/core/view.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct MouseLimits {
  static constexpr double kNearest_m = 2;       // distance of the ground when zooming in
  static constexpr double kLowestTilt_deg = 1;  // elevation of the camera seen from the point tilted about
};

// Describes the image that the cursor is in. The head looks straight ahead.
struct Screen {
  int width = 1280;
  int height = 720;
  double fov_deg = 60;
};
core::View view_of(const mars::Pose& pose, const Screen& screen, double radius_m);

// Returns the ground under a position, metres from the planet's centre, or nullopt for the sky.
std::optional<glm::dvec3> ground_at(const mars::Pose& pose, const Screen& screen, glm::dvec2 xy,
                                    const TerrainQuery& ground);

// Computes the pose of a drag of the ground: the one from which `held_m` is at `xy`. `begun` is the pose at the
// beginning of the drag. Altitude, pitch and roll stay. The heading stays too, if that is possible and the
// camera is farther than 10 degrees from the poles. A position beside the planet holds the nearest edge.
// `held_m` is at `xy` within 1e-6 pixels where the line of sight meets the ground's sphere at more than a
// degree.
mars::Pose dragged(const mars::Pose& begun, const Screen& screen, const glm::dvec3& held_m, glm::dvec2 xy,
                   const TerrainQuery& ground);

// Computes the pose of a drag of the sky: rotates so that the direction that was at `from` is at `to`. Roll
// stays.
mars::Pose panned(const mars::Pose& begun, const Screen& screen, glm::dvec2 from, glm::dvec2 to);

// Multiplies the distance to the ground under the cursor by `factor` (0.1 to 10). That ground stays under the
// cursor; the camera moves sideways for this, so the distance is exact within 6 % below 1000 km, within 25 %
// above. Over the sky, multiplies the altitude above the ground.
mars::Pose zoomed(const mars::Pose& pose, const Screen& screen, glm::dvec2 xy, double factor,
                  const TerrainQuery& ground);

// Orbits about the ground in the middle of the image by azimuth and elevation. Distance and the point in the
// middle stay. If the middle shows sky, rotates the camera in place.
mars::Pose tilted(const mars::Pose& pose, const Screen& screen, double around_deg, double up_deg,
                  const TerrainQuery& ground);

// Returns the pose that looks at a point on the ground from `distance_m` away with the same heading, without
// roll, from at least 20 degrees above it.
mars::Pose looking_at(const mars::Pose& pose, const glm::dvec3& point_m, double distance_m,
                      const TerrainQuery& ground);

// Returns a pose straight above a place, north up, from which the whole planet is in the image.
mars::Pose overview(mars::LonLat place, const Screen& screen, double radius_m);

}  // namespace vpe::explore
