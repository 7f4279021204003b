// The highest objects in a vertical plane: what they add to a skyline of ground.
//
// Typical usage:
//   const ObjectSkyline tops(scene, camera_m, mars::local_frame(place));
//   const auto top = tops.above(azimuth_deg, ground_elevation_deg);
#pragma once

#include <cstdint>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "objects/scene/scene.h"

namespace objects {

struct ObjectTop {
  double elevation_deg = 0;
  double range_m = 0;  // of the object there
  std::uint32_t instance = 0;
};

// Searches objects by rays from one place. Any thread may call any member.
class ObjectSkyline {
 public:
  // The scene must outlive this.
  ObjectSkyline(const Scene& scene, const glm::dvec3& camera_m, const mars::LocalFrame& frame)
      : scene_(scene), camera_m_(camera_m), frame_(frame) {}

  // Returns the highest direction at an azimuth (clockwise from north) in which a ray meets an object, if that is higher
  // than an elevation above which there is no ground. The ray meets it, and none above does that belongs to a search in
  // kSteps steps over the object's ball: parts that are thinner than a step and lie apart from the rest may be missed.
  // The border is found to kTop_deg.
  std::optional<ObjectTop> above(double azimuth_deg, double elevation_deg) const;
  static constexpr int kSteps = 512;
  static constexpr double kTop_deg = 1e-9;

 private:
  const Scene& scene_;
  glm::dvec3 camera_m_;
  mars::LocalFrame frame_;
};

}  // namespace objects
