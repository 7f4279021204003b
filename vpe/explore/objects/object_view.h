// Views of an object: where the camera goes to see it, and how it follows one that moves.
#pragma once

#include <glm/vec3.hpp>

#include "mars/geodesy/pose.h"
#include "vpe/explore/objects/item_balls.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct ObjectViewLimits {
  static constexpr double kRadii = 5;  // distance of a view of an object
  static constexpr double kNearest_radii = 1.5;
  static constexpr double kFarthest_radii = 1e4;
  static constexpr double kPitch_deg = -20;  // of a view of an object
  static constexpr double kLowest_deg = 20;  // pitch: from below
  static constexpr double kHighest_deg = -89;
};

// Says from where a camera looks at the middle of an object, in the level frame of its place.
struct ObjectOffset {
  double heading_deg = 0;                           // of the line of sight, clockwise from north
  double pitch_deg = ObjectViewLimits::kPitch_deg;  // of the line of sight, up
  double distance_m = 10;
};

// Returns the offset of a view that shows the object well, with a heading.
ObjectOffset usual_offset(const ItemBall& ball, double heading_deg);

// Returns the offset of a camera that looks at the middle of the object, or would if it turned there. Within the limits.
ObjectOffset offset_of(const mars::Pose& camera, const ItemBall& ball, double planet_radius_m);

// Returns the offset turned by angles and with the distance multiplied, within the limits.
ObjectOffset turned(const ObjectOffset& offset, const ItemBall& ball, double around_deg, double up_deg,
                    double factor);

// Returns the pose that looks at the middle of an object, level. Where the ground is in the way of the camera, it is raised
// above it, and still looks at the middle.
mars::Pose pose_at(const ItemBall& ball, const ObjectOffset& offset, const TerrainQuery& ground);

}  // namespace vpe::explore
