// Finds where a pose of a flight goes when it is dragged in the view.
#pragma once

#include <functional>
#include <glm/vec2.hpp>

#include "mars/geodesy/sphere.h"
#include "vpe/core/view.h"

namespace vpe::window {

struct PoseDragLimits {
  static constexpr double kGrazing_deg = 3;  // of a line of sight to the level of the pose
  static constexpr double kReached_m = 1e-4;
  static constexpr int kMostSteps = 20;
};

// Returns the place over which a pose is seen at `xy` when it is moved from `from` with its altitude or height kept.
// `radius_m` returns the distance of the pose from the planet's centre over a place. Where the line of sight meets that
// level at less than kGrazing_deg, or not at all, a pixel would be kilometres: there the pose keeps its distance from
// the camera along the ground, and follows `xy` sideways. Pure but for `radius_m`.
mars::LonLat dragged_pose(const core::View& view, mars::LonLat from, glm::dvec2 xy,
                          const std::function<double(mars::LonLat)>& radius_m);

}  // namespace vpe::window
