// Describes how an image with ranges shows the ground.
#pragma once

#include <array>

#include "vpe/overlay/features/ground_sight.h"
#include "vpe/overlay/visible_terrain.h"

namespace vpe::overlay {

// Answers from the range image: a place is hidden if all ground in the 3 x 3 pixels about it is nearer by more than
// kHiddenLineShare of the distance and the image's own errors. Refers to the terrain, which must outlive it.
class ImageSight : public GroundSight {
 public:
  explicit ImageSight(const VisibleTerrain& terrain);
  double height_m(const glm::dvec3& direction) const override { return terrain_.scene().ground_m(direction); }
  std::optional<glm::dvec2> to_image(const glm::dvec3& point_m) const override {
    return terrain_.to_image(point_m);
  }
  bool is_hidden(glm::dvec2 at_px, const glm::dvec3& point_m, double distance_m) const override;
  bool may_show(const glm::dvec3& centre_m, double radius_m) const override;

 private:
  const VisibleTerrain& terrain_;
  bool is_open_;  // the image is no pyramid
  std::array<glm::dvec3, 4> inward_{};
};

}  // namespace vpe::overlay
