// Magnification of a radial displacement at a tile, relative to the image centre.
//
// A displacement of e metres at range r covers e f / r pixels at the principal point of a flat image, and up to
// 1 / cos^2 times that at an angle off its axis: at range r its depth is r cos, and its component along the
// view axis is visible too. Selection multiplies errors by the bound below for tiles that may stand against the
// sky, so that in the corners of wide images too no outline is off by more pixels than the tolerance. Pure
// functions.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "cull/bounding_region.h"
#include "vpe/core/view.h"

namespace lod {

// The axes of a flat image, body-fixed, and the tangents at the sides of its drawn part, up and right positive.
// Panoramas are not flat.
struct ImagePlane {
  bool flat = false;
  glm::dvec3 camera_m{0, 0, 0};
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 up{0, 1, 0};
  glm::dvec3 forward{0, 0, 1};
  glm::dvec2 low{0, 0};
  glm::dvec2 high{0, 0};
};
ImagePlane image_plane(const vpe::core::View& view);

// Returns an upper bound, over the points of the volume that are in the image and over both ends of the
// displacement to first order, of
//   length in the image of a radial displacement / (displacement * focal length / range).
// The result is at least 1, which is the measure of a pixel's shift (vpe/core/metrics.h), and 1 for images that
// are not flat. It is at most 1 / cos^2 of the angle to the farthest corner of the image or of the volume. For
// volumes of a third of a degree that are wholly in the image it is on average within 5 % of the least such
// bound (tested).
double off_axis_magnification(const ImagePlane& plane, const cull::BoundingHexahedron& volume);

}  // namespace lod
