// What is measured, drawn over the view: points, and the way over the ground.
#pragma once

#include <imgui.h>

#include <optional>
#include <span>

#include "vpe/explore/measure/profile.h"
#include "vpe/explore/session.h"

namespace vpe::window {

struct MeasureMarks {
  std::span<const mars::LonLat> points;
  const explore::Profile* profile = nullptr;  // null: the points alone
  std::optional<mars::LonLat> marked;         // one more place, as of a cursor on the plot
};

struct MarkLimits {
  static constexpr int kLinePoints = 240;  // at most, of the part that is in the view
  static constexpr int kCasts = 60;        // at most, to find what nearer ground hides of the line
};

// Over a view whose upper left corner is at (x0, y0) of the list. What nearer ground hides of the line is
// faint, hidden points are hollow. On the ground as it is drawn, with its exaggeration.
void draw_measure_marks(ImDrawList& list, const explore::Session& session, const MeasureMarks& marks, double x0,
                        double y0);

}  // namespace vpe::window
