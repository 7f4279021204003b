// Places on the screen are doubles here and floats in Dear ImGui.
#pragma once

#include <imgui.h>

namespace vpe::window {

inline ImVec2 at(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

}  // namespace vpe::window
