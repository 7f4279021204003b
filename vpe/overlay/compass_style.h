// How the compass looks, in images of any size.
#pragma once

#include <algorithm>

#include "vpe/overlay/compass.h"
#include "vpe/overlay/label_layout.h"

namespace vpe::overlay {

// Pixels.
struct CompassStyle {
  double unit = 1;     // pixels at 720 rows
  bool is_up = false;  // ticks and labels are above their line, not below

  Font font(CompassRank rank) const { return {std::max(14 * unit, 9.8), rank == CompassRank::kWind}; }
  double line_px() const { return std::max(1.3 * unit, 1.0); }
  double tick_px(CompassRank rank) const {
    return (rank == CompassRank::kTick ? 0.3 : 0.55) * font(CompassRank::kFigure).size_px;
  }
  // Of line, ticks, labels and what keeps them apart.
  double height_px() const { return 2.0 * font(CompassRank::kFigure).size_px; }

  // That a label and the space beside it take, at so many pixels a degree.
  double label_px(const Canvas& canvas, double px_per_deg) const;
  // Where a mark's label is, its tick standing on a point of the line; without width for ticks.
  Box label_box(const Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const;
  Box tick_box(glm::dvec2 at, const CompassMark& mark) const;

  void draw_tick(Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const;
  void draw_label(Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const;

 private:
  glm::dvec2 label_centre(glm::dvec2 at) const;
};

// Under marks along an edge.
inline constexpr Ink kCompassBand{0, 0, 0, 0.45};

}  // namespace vpe::overlay
