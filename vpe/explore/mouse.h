// What a mouse does to a view of a planet, as in the globes that people know: left drag holds the ground, the
// wheel comes nearer to what is under the cursor, right or middle drag tilts and turns about what is in the
// middle, double click goes there.
//
// Cursor positions are image positions of the view (vpe/core/view.h). All functions are pure; every pose that
// is given back is clear of the ground (vpe/explore/steer.h).
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "mars/geodesy/pose.h"
#include "vpe/core/view.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct MouseLimits {
  static constexpr double kNearest_m = 2;       // of what is zoomed in to
  static constexpr double kLowestTilt_deg = 1;  // of the line of sight about the point tilted about
};

// How a pose is shown: the image that the cursor is in. The head is straight ahead.
struct Screen {
  int width = 1280;
  int height = 720;
  double fov_deg = 60;
};
core::View view_of(const mars::Pose& pose, const Screen& screen, double radius_m);

// The ground under a position, metres from the planet's centre; nothing for the sky.
std::optional<glm::dvec3> ground_at(const mars::Pose& pose, const Screen& screen, glm::dvec2 xy,
                                    const TerrainQuery& ground);

// A drag that began over the ground at `held_m` with the pose of then: the pose from which it is at `xy`. The
// planet turns under the camera: altitude, pitch and roll stay, and so does the heading where the camera is farther
// than 10 degrees from the poles and can keep it. A position beside the planet holds the nearest edge. `held_m`
// is at `xy` within 1e-6 pixels where the line of sight meets the ground's sphere at more than a degree.
mars::Pose dragged(const mars::Pose& begun, const Screen& screen, const glm::dvec3& held_m, glm::dvec2 xy,
                   const TerrainQuery& ground);

// A drag that began over the sky: turns, so that the direction that was at `from` is at `to`. Roll stays.
mars::Pose looked(const mars::Pose& begun, const Screen& screen, glm::dvec2 from, glm::dvec2 to);

// Multiplies the distance to the ground under the cursor by `factor` (0.1 to 10); that ground stays under the
// cursor, for which the camera moves aside: the distance is within 6 % of that below 1000 km, within 25 % above. Over the sky the altitude above the ground is multiplied.
mars::Pose zoomed(const mars::Pose& pose, const Screen& screen, glm::dvec2 xy, double factor,
                  const TerrainQuery& ground);

// Turns about the ground in the middle of the image: the camera goes right around it by an angle and up about
// it. Its distance stays, and it stays in the middle. When there is sky, the camera turns in its place.
mars::Pose tilted(const mars::Pose& pose, const Screen& screen, double around_deg, double up_deg,
                  const TerrainQuery& ground);

// The pose that looks at a point on the ground from `distance_m` away with the same heading, without roll, from
// at least 20 degrees above it.
mars::Pose looking_at(const mars::Pose& pose, const glm::dvec3& point_m, double distance_m,
                      const TerrainQuery& ground);

// Far enough out that the whole planet is in the image, straight above a place, north up.
mars::Pose overview(mars::LonLat place, const Screen& screen, double radius_m);

}  // namespace vpe::explore
