// Sizes, boxes and drawing of compass marks, for images of any size.
#pragma once

#include <algorithm>

#include "vpe/overlay/compass.h"
#include "vpe/overlay/label_layout.h"

namespace vpe::overlay {

// Computes sizes of marks in pixels and draws them. Each mark stands on a point of the compass line.
struct CompassStyle {
  double unit = 1;     // pixels for each pixel of an image with 720 rows
  bool is_up = false;  // ticks and labels are above their line instead of below

  Font font(CompassRank rank) const { return {std::max(14 * unit, 9.8), rank == CompassRank::kWind}; }
  double line_px() const { return std::max(1.3 * unit, 1.0); }
  double tick_px(CompassRank rank) const {
    return (rank == CompassRank::kTick ? 0.3 : 0.55) * font(CompassRank::kFigure).size_px;
  }
  // Returns the height of line, ticks and labels, including the space between them.
  double height_px() const { return 2.0 * font(CompassRank::kFigure).size_px; }

  // Returns the width of a label and the space beside it, in an image with this many pixels per degree.
  double label_px(const Canvas& canvas, double px_per_deg) const;
  // Returns the box of the label of the mark that stands on `at`. Its width is 0 for ticks.
  Box label_box(const Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const;
  Box tick_box(glm::dvec2 at, const CompassMark& mark) const;

  void draw_tick(Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const;
  void draw_label(Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const;

 private:
  glm::dvec2 label_centre(glm::dvec2 at) const;
};

// Background of marks along an edge of the image.
inline constexpr Ink kCompassBand{0, 0, 0, 0.45};

}  // namespace vpe::overlay
