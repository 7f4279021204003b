// Where and how a model stands on the ground of a planet.
//
// The axes of a model are x to the right, y forward, z up.
//
// Typical usage:
//   Instance instance = place_instance(placing, 0.5 * size_m, mars::kMarsRadius_m, ground);
//   instance.model = entry.model;
//   const Instance rover = path_instance(path, clock_s, ground);
#pragma once

#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "mars/geodesy/pose.h"
#include "objects/files/scene_file.h"
#include "objects/scene/instance.h"

namespace objects {

// Returns the radius of the ground as it is drawn, metres from the planet's centre, for a unit direction.
using GroundRadius = std::function<double(const glm::dvec3& direction)>;

// Returns the rotation from the axes of a model to the body-fixed frame, of which `axes` are the model's. It is
// the unit quaternion rounded to single precision; its real part is not negative.
glm::quat rotation_of(const mars::Axes& axes);

// The slope is measured at least this far from the place.
inline constexpr double kLeastFoot_m = 0.05;

// Returns the instance of a placing; its model is 0. The place of the model's origin is `height_m` above the
// ground or the sphere, along the vertical. With follows_slope, heading, pitch and roll count from the plane
// that fits best to the ground foot_radius_m ahead, behind, left and right of the place; the model's heading
// stays the same in a map.
Instance place_instance(const Placing& placing, double foot_radius_m, double planet_radius_m,
                        const GroundRadius& ground_radius_m);

// Bounds how far a wheel may be below ground whose slope is at most 3: rotations are stored in single precision.
constexpr double wheel_error_m(double wheelbase_m, double track_m) {
  return 1e-8 + 4e-7 * (wheelbase_m + track_m);
}

// Returns a placing moved to where a path is at a time: its place, heading and height above the ground. There must be a
// point.
Placing placing_at(const Placing& placing, const std::vector<PathPoint>& points, double time_s);

// Returns the instance of a path at a time. It moves at constant speed along the great circle from point to
// point, and stands at the first one before its time and at the last one after it. The heading is that of the
// point it left, or along the way; where it waits, as it came. Heights change evenly.
//
// The origin of the model is amid its four wheels, on their plane. That is the plane that fits best to the
// ground under them, lifted until no wheel is below the ground. Without wheels the model is upright, its origin
// on the ground. The height of the path lifts it along the vertical.
Instance path_instance(const PathEntry& path, double time_s, const GroundRadius& ground_radius_m);

}  // namespace objects
