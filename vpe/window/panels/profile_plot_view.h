// Drawing of a profile's plot with Dear ImGui.
#pragma once

#include <optional>

#include "vpe/explore/measure/profile_plot.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

struct ProfilePlot {
  const explore::Profile& profile;
  double radius_m = mars::kMarsRadius_m;
  // Drawn over the ground; null: none. Must belong to the profile's path, which has two places then.
  const explore::LineOfSight* sight = nullptr;
  double from_height_m = 0;  // of its ends above the ground
  double to_height_m = 0;
};

// Draws a plot of this size in pixels, with the vertical exaggeration above it. Returns the distance under the
// cursor, or nullopt beside the ground.
std::optional<double> draw_profile_plot(const ProfilePlot& plot, double width, double height, Widgets& widgets);

}  // namespace vpe::window
