// Marks of measurements over the view: points, and the path on the ground.
#pragma once

#include <imgui.h>

#include <optional>
#include <span>

#include "vpe/explore/measure/profile.h"
#include "vpe/explore/session.h"
#include "vpe/window/marks/ground_view.h"

namespace vpe::window {

struct MeasureMarks {
  std::span<const mars::LonLat> points;
  const explore::Profile* profile = nullptr;  // null: the points alone
  std::optional<mars::LonLat> marked;         // one more place, for example of a cursor on the plot
};

struct MarkLimits {
  static constexpr int kLinePoints = 240;  // of the section of the path in the view
  static constexpr int kCasts = 60;        // that find sections hidden by nearer ground
};

// Draws marks over the image of an eye, on the ground as drawn, with its exaggeration. Sections of the path that nearer ground hides are faint, hidden points are hollow.
void draw_measure_marks(ImDrawList& list, const explore::Session& session, const MeasureMarks& marks,
                        const EyeImage& eye);

}  // namespace vpe::window
