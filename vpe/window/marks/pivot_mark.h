// The ground about which a drag tilts and turns the view.
#pragma once

#include <imgui.h>

#include "vpe/window/marks/ground_view.h"

namespace vpe::window {

struct PivotMarkLimits {
  static constexpr int kRingParts = 48;
  static constexpr double kRadius = 0.03;  // of the ring, as a share of the camera's distance
};

// Draws a ring about a point, level at its place, with a dot in the middle. Hides nothing of it.
void draw_pivot_mark(ImDrawList& list, const glm::dvec3& pivot_m, const EyeImage& eye);

}  // namespace vpe::window
