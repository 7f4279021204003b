// The plot of a profile, drawn by Dear ImGui.
#pragma once

#include <optional>
#include <string>

#include "vpe/explore/measure/profile_plot.h"
#include "vpe/window/widgets.h"

namespace vpe::window {

struct PlotOfProfile {
  const explore::Profile& profile;
  double radius_m = mars::kMarsRadius_m;
  // Drawn over the ground, null: none. It must be of the profile's own way: two places, no more.
  const explore::LineOfSight* sight = nullptr;
  double from_height_m = 0;  // of its ends above the ground
  double to_height_m = 0;
};

// Takes so many pixels of the window. Vertical exaggeration and datum of the elevations are words above it. The
// distance under the cursor, nothing beside the ground.
std::optional<double> draw_plot(const PlotOfProfile& plot, double width, double height, Widgets& widgets);

// A, B, ... Z, AA, AB: what the points of a way are called.
std::string point_name(std::size_t index);

}  // namespace vpe::window
