// Describes how an image shows the ground: what lines are draped with.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "vpe/overlay/features/feature_scale.h"

namespace vpe::overlay {

// Answers where an image shows places on the ground. Points are body-fixed, metres from the planet's centre.
class GroundSight {
 public:
  struct Frame {
    glm::dvec3 camera_m{0, 0, 1};
    double radius_m = 1;  // of the sphere that heights count from
    double exaggeration = 1;
    glm::dvec2 size_px{1, 1};
    double turn_px = 0;  // columns after which the image repeats; 0: it does not
    FeatureScale scale;
  };

  explicit GroundSight(const Frame& frame) : frame_(frame) {}
  virtual ~GroundSight() = default;
  GroundSight(const GroundSight&) = delete;
  GroundSight& operator=(const GroundSight&) = delete;

  const Frame& frame() const { return frame_; }
  // Returns the height of the ground in a unit direction, metres, without exaggeration.
  virtual double height_m(const glm::dvec3& direction) const = 0;
  // Returns the position of a point, which may lie beside the image; nullopt if it has none.
  virtual std::optional<glm::dvec2> to_image(const glm::dvec3& point_m) const = 0;
  // Returns whether ground or an object hides a point at a position.
  virtual bool is_hidden(glm::dvec2 at_px, const glm::dvec3& point_m, double distance_m) const = 0;
  // Returns false if no point of a ball can be in the image or near it.
  virtual bool may_show(const glm::dvec3& centre_m, double radius_m) const = 0;

 private:
  Frame frame_;
};

}  // namespace vpe::overlay
