// The objects of a scene as they are seen from one place: what they hide, and what they add to a skyline.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "objects/scene/scene.h"
#include "panorama/horizon/landmarks.h"
#include "panorama/horizon/skyline.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

// Any thread may call any const member.
struct HorizonObjects {
  std::shared_ptr<const objects::Scene> scene;
  panorama::Viewpoint camera;

  // Returns the distance along a ray from the camera to an object, or that of the ground where no object is nearer.
  double range_m(const glm::dvec3& ray, double ground_m) const;
  // Puts objects that rise above the ground into a skyline. Returns their names, "" where it is ground.
  std::vector<std::string> raise(std::vector<panorama::GroundPoint>& skyline, base::ThreadPool& pool) const;
  // Names the objects that hide features, where landmarks() was given range_m().
  void name_hiders(std::vector<panorama::Landmark>& landmarks) const;
};

}  // namespace vpe::app
