// A ray against all objects of a scene, for questions about lines of sight and heights.
//
// Typical usage:
//   const auto seen = first_object(scene, {camera_m, direction}, ground_range_m);
//   if (seen) tell(scene.names()[scene.instance(seen->instance).name]);
#pragma once

#include <optional>

#include "objects/draw/object_rays.h"

namespace objects {

struct SeenObject {
  double range_m = 0;
  std::uint32_t instance = 0;
};

// Returns the first object that a ray meets before until_m, at its finest level; nullopt if none. Semi-transparent
// surfaces count where the opacity on the way passes a half. Pure.
std::optional<SeenObject> first_object(const Scene& scene, const ObjectRay& ray, double until_m);

// Returns where a ray meets one object before until_m, metres along the ray, as first_object() does; nullopt if it does
// not. Pure.
std::optional<double> first_of(const Scene& scene, std::uint32_t instance, const ObjectRay& ray,
                               double until_m);

}  // namespace objects
