// Frustum culling: finds volumes outside the image.
//
// Typical usage, down a quadtree:
//   const Frustum frustum = make_frustum(view);
//   const auto planes = planes_crossed(frustum, bounding_hexahedron(region), all_planes(frustum));
//   if (!planes) return;                        // invisible
//   for (child : children) test(child, *planes);  // fewer planes to test
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "cull/bounding_region.h"
#include "vpe/core/view.h"

namespace cull {

// Half-spaces through the camera whose intersection contains everything that a view can show: the four sides of
// the image and the space in front of the camera. A panorama (cylinder, equirectangular) has none.
struct Frustum {
  glm::dvec3 camera_m{0, 0, 0};
  std::array<glm::dvec3, 5> normals{};  // unit, inwards
  int count = 0;
};
Frustum make_frustum(const vpe::core::View& view);

// Bit k: plane k may intersect the volume.
using PlaneMask = std::uint8_t;

// Returns the mask of all planes.
PlaneMask all_planes(const Frustum& frustum);

// Returns the planes of `mask` that intersect the volume, or nullopt if the volume lies outside any of them.
// Test children against the returned planes only. Conservative: a volume with a point inside all planes is
// never rejected; volumes near the frustum's edges may be kept although they lie outside.
std::optional<PlaneMask> planes_crossed(const Frustum& frustum, const BoundingHexahedron& volume,
                                        PlaneMask mask);

}  // namespace cull
