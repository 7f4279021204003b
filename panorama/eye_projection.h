// Computes where the image of one eye of a panorama shows points.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "panorama/projection.h"
#include "panorama/stereo_eyes.h"
#include "panorama/viewpoint.h"

namespace panorama {

// Projects body-fixed points into a panorama of one eye, or of one eye of a pair, whose columns have eyes of their own
// (stereo_eyes.h). Exact to rounding: the pieces that are drawn (stereo_pieces.h) are within their own bounds of it. Any thread
// may use it.
class EyeProjection {
 public:
  // The viewpoint itself is the eye.
  EyeProjection(const PanoramaMap& map, const Viewpoint& viewpoint);
  // An eye of a round map; base_m is the distance between the eyes.
  EyeProjection(const PanoramaMap& map, const Viewpoint& viewpoint, Eye eye, double base_m);

  struct Seen {
    glm::dvec2 at_px{0, 0};  // as PanoramaMap::place(), also beside the image
    glm::dvec3 seen_from_m{0, 0, 0};
  };
  // Returns nullopt for a point at an eye, or in the zenith or nadir of a map that does not show it.
  std::optional<Seen> project(const glm::dvec3& point_m) const;

  // Returns false if no point of a ball is in the image or within `margin_px` of it. May return true for others.
  bool may_show(const glm::dvec3& centre_m, double radius_m, double margin_px) const;

 private:
  PanoramaMap map_;
  Viewpoint viewpoint_;
  double side_ = 0;  // 1: right, -1: left, 0: the viewpoint
  double base_m_ = 0;
};

}  // namespace panorama
