// A ray against all objects of a scene, for questions about lines of sight and heights.
//
// Typical usage:
//   const auto seen = first_object(scene, {camera_m, direction}, ground_range_m);
//   if (seen) tell(scene.names()[scene.instance(seen->instance).name]);
#pragma once

#include <optional>
#include <span>

#include "objects/draw/object_rays.h"

namespace objects {

struct SeenObject {
  double range_m = 0;
  std::uint32_t instance = 0;
};

// Returns the first object that a ray meets before until_m, at its finest level; nullopt if none. Semi-transparent
// surfaces count where the opacity on the way passes a half. Pure.
std::optional<SeenObject> first_object(const Scene& scene, const ObjectRay& ray, double until_m);

// Returns the first object of a list that a ray meets, as first_object() does. The list is sorted from near to far, as
// ObjectRays::in_cone() sorts it; of its objects those count that are drawn by rays. Pure.
std::optional<SeenObject> first_among(std::span<const PlacedObject> objects, const ObjectRay& ray,
                                      double until_m);

}  // namespace objects
