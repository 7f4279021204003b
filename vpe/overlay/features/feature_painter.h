// Lines and markers of features on a canvas.
#pragma once

#include <glm/vec2.hpp>

#include "mars/vector/feature_style.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/overlay/canvas.h"
#include "vpe/overlay/draped_lines.h"
#include "vpe/overlay/features/feature_scale.h"

namespace vpe::overlay {

// Returns a colour of a style at a layer's opacity.
Ink ink_of(const mars::StyleColour& colour, double opacity);

// Describes how the features of a layer are drawn in one image.
struct FeaturePainter {
  FeatureScale scale;
  double opacity = 1;
  core::HiddenLines hidden = core::HiddenLines::kLeftOut;

  // Returns the width of a line, pixels.
  double width_px(const mars::FeatureStyle& style, double distance_m) const;
  // Returns the radius of a point's marker without its rim, and the width of the rim.
  double radius_px(const mars::FeatureStyle& style, double distance_m) const;
  double rim_px() const;
  // Returns the font of a label.
  Font font(const mars::FeatureStyle& style, double distance_m) const;

  // Draws a run, whose style has a stroke, with `corner` of its image at the canvas's corner. Hidden runs are dashed or
  // left out.
  void run(Canvas& canvas, const DrapedRun& run, const mars::FeatureStyle& style, glm::dvec2 corner) const;
  // Draws the marker of a point; without a marker nothing.
  void marker(Canvas& canvas, glm::dvec2 at_px, double distance_m, const mars::FeatureStyle& style) const;
};

}  // namespace vpe::overlay
