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

}  // namespace vpe::window
