// What lies outside the image.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "cull/bounding_region.h"
#include "vpe/core/view.h"

namespace cull {

// Half-spaces through the camera whose intersection holds all that a view can show: the four sides and what is
// in front of the camera. A panorama (cylinder, equirectangular) has none.
struct Frustum {
  glm::dvec3 camera_m{0, 0, 0};
  std::array<glm::dvec3, 5> normals{};  // unit, inwards
  int count = 0;
};
Frustum make_frustum(const vpe::core::View& view);

// Bit k: plane k may cut the volume.
using PlaneMask = std::uint8_t;
PlaneMask all_planes(const Frustum& frustum);

// Nothing when the volume lies outside one of the planes of `mask`, else the planes of `mask` that it is not
// wholly inside of: all that the parts of a tile have to be tested against. Conservative: a volume with a
// point inside all planes is never given up; boxes near the frustum's edges may be kept though outside.
std::optional<PlaneMask> planes_crossed(const Frustum& frustum, const BoundingHexahedron& volume,
                                        PlaneMask mask);

}  // namespace cull
