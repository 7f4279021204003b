#include "vpe/window/objects/object_marks.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr ImU32 kObjectMark = IM_COL32(140, 220, 255, 255);
constexpr ImU32 kObjectChosen = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kObjectDark = IM_COL32(0, 0, 0, 190);

}  // namespace

bool draw_object_mark(ImDrawList& list, const GroundView& ground, const EyeImage& eye,
                      const explore::ItemBall& ball, const std::string& name, bool is_chosen) {
  const core::Projected foot = ground.seen(ball.origin_m);
  const core::Projected middle = ground.seen(ball.centre_m);
  if (foot.behind || middle.behind || (!ground.is_in_view(foot) && !ground.is_in_view(middle))) return false;
  // The foot of an object is often behind a rise of its own size.
  const bool is_hidden = ground.is_hidden(ball.centre_m);
  const auto shown = [is_hidden](ImU32 colour) { return is_hidden ? faint(colour) : colour; };
  const float size = ImGui::GetFontSize();
  const ImU32 colour = shown(is_chosen ? kObjectChosen : kObjectMark);
  const double range_m = glm::length(ball.centre_m - ground.view().camera.position_m);
  const double radius_px = core::focal_px(ground.view()) * ball.radius_m / std::max(range_m, 1e-6);
  const ImVec2 at_middle = at(eye.x0 + middle.xy.x, eye.y0 + middle.xy.y);
  if (is_chosen) {
    const float ring = static_cast<float>(std::max(radius_px, 0.6 * static_cast<double>(size)));
    list.AddCircle(at_middle, ring, shown(kObjectDark), 0, 3.5F);
    list.AddCircle(at_middle, ring, colour, 0, 1.5F);
  }
  // A dot would hide a near object's own foot.
  const float dot = size * 0.16F;
  if (radius_px < static_cast<double>(size)) {
    list.AddCircleFilled(at_middle, dot + 1.5F, shown(kObjectDark));
    list.AddCircleFilled(at_middle, dot, colour);
  }
  if (name.empty()) return true;
  const float above = static_cast<float>(std::max(radius_px, 0.4 * static_cast<double>(size)));
  const ImVec2 extent = ImGui::CalcTextSize(name.c_str());
  const ImVec2 text{at_middle.x - extent.x / 2, at_middle.y - above - extent.y - 2};
  draw_bordered(list, text, name, colour, shown(kObjectDark));
  return true;
}

}  // namespace vpe::window
