// Marks of a scene's objects in the view.
#pragma once

#include <imgui.h>

#include <string>

#include "vpe/explore/objects/item_balls.h"
#include "vpe/window/marks/ground_view.h"

namespace vpe::window {

struct ObjectMarkLimits {
  static constexpr std::size_t kMostMarks = 100;  // each casts a ray
};

// Draws the mark of an object at its origin, with a name if there is one. A chosen object has a ring about it. What the
// ground hides is faint. Returns true if the object is in the image.
bool draw_object_mark(ImDrawList& list, const GroundView& ground, const EyeImage& eye,
                      const explore::ItemBall& ball, const std::string& name, bool is_chosen);

}  // namespace vpe::window
