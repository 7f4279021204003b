// Stretches of a line in the solid objects of a scene: their tops and undersides along a vertical.
//
// Typical usage:
//   // From the planet's centre upwards t is the radius.
//   for (const ObjectSpan& s : object_spans(scene, {{0, 0, 0}, up}, infinity)) tell(s.end_m - radius_m);
#pragma once

#include <optional>
#include <vector>

#include "objects/draw/object_rays.h"

namespace objects {

// Holds a stretch of a ray in one object. A sheet without thickness begins and ends at one place.
struct ObjectSpan {
  std::uint32_t instance = 0;
  double begin_m = 0;  // along the unit ray, where it enters the object
  double end_m = 0;    // where it leaves it
  // Bounds the distance of both ends from the surface that the model stands for: for sticks a voxel's diagonal
  // and for all models rounding. Along a ray that grazes a surface the ends may be further off. For volumes it is
  // the spacing of posts and rounding, and no bound: posts hold extinction to half of a 255th of the largest one,
  // which moves a surface by as much over the gradient there, without limit where the field is flat. On an edge
  // of the lattice one of whose posts is above the threshold by more than that and the other below it, the surface
  // lies within the spacing.
  double geometric_error_m = 0;
};

// Returns the stretches of a ray in the solid objects of a scene at their finest levels, sorted by begin, end
// and instance. Those that reach into [0, until_m] are returned whole, so the first one may begin behind the
// origin. The stretches of one object neither overlap nor touch each other; those of different objects may.
// mesh_spans() (objects/model/solid_spans.h), stick_spans() (objects/sticks/stick_spans.h) and volume_spans()
// (objects/volumes/volume_spans.h) say what is solid; notches between the steps of tilted sticks are closed up to
// kStickStep_voxels. Volumes have no surface and are left out without a threshold. It is one of extinction at an
// object's scale of 1, so a scaled object keeps its shape; 0 or less: default_threshold_per_m() of each model.
// Throws std::invalid_argument for a threshold that is not finite. Any thread may call it. Pure.
std::vector<ObjectSpan> object_spans(const Scene& scene, const ObjectRay& ray, double until_m,
                                     std::optional<double> volume_threshold_per_m = std::nullopt);

}  // namespace objects
