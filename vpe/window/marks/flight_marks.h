// The flight in the view: its course and its numbered poses.
#pragma once

#include <imgui.h>

#include <optional>

#include "vpe/explore/session.h"
#include "vpe/window/marks/ground_view.h"

namespace vpe::window {

// Draws the course of the session's flight over the image of an eye. What the ground hides is faint. Poses are numbered from 1; `selected` is marked. Draws nothing while the flight is followed, since the
// camera is on it. Casts at most some 250 rays.
void draw_flight_marks(ImDrawList& list, explore::Session& session, std::optional<std::size_t> selected,
                       const EyeImage& eye);

// Describes a pose whose mark is seen.
struct PoseMark {
  std::size_t index = 0;
  glm::dvec2 xy{0, 0};  // in the image of the view
};

// Returns the pose whose mark is nearest to a position in the image of a view and within `reach_px`, or nullopt. Poses
// without a mark, and those that the ground hides, are not found.
std::optional<PoseMark> pose_mark_at(explore::Session& session, const core::View& view, glm::dvec2 xy,
                                     double reach_px);

}  // namespace vpe::window
