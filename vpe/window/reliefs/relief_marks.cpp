#include "vpe/window/reliefs/relief_marks.h"

#include <utility>
#include <vector>

#include "vpe/explore/reliefs/relief_editor.h"
#include "vpe/explore/reliefs/usual_relief.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr ImU32 kReliefMark = IM_COL32(255, 170, 110, 255);
constexpr ImU32 kReliefChosen = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kReliefDark = IM_COL32(0, 0, 0, 190);

// Draws the parts of the outline that are in front of the camera.
void draw_outline(ImDrawList& list, const GroundView& ground, const EyeImage& eye,
                  const relief::ReliefSpec& relief, double radius_m) {
  std::vector<core::Projected> points;
  for (const glm::dvec3& direction : explore::relief_outline(relief, radius_m))
    points.push_back(ground.seen(ground.on_ground(direction)));
  for (const auto& [colour, width] : {std::pair{kReliefDark, 3.5F}, {kReliefChosen, 1.5F}}) {
    for (std::size_t n = 0; n < points.size(); ++n) {
      const core::Projected& a = points[n];
      const core::Projected& b = points[(n + 1) % points.size()];
      if (a.behind || b.behind || (!ground.is_in_view(a) && !ground.is_in_view(b))) continue;
      list.AddLine(at(eye.x0 + a.xy.x, eye.y0 + a.xy.y), at(eye.x0 + b.xy.x, eye.y0 + b.xy.y), colour, width);
    }
  }
}

}  // namespace

void draw_relief_mark(ImDrawList& list, const GroundView& ground, const EyeImage& eye,
                      const relief::ReliefSpec& relief, bool is_chosen) {
  const glm::dvec3 up = mars::direction(relief.place);
  const glm::dvec3 middle_m = ground.on_ground(up);
  if (is_chosen) draw_outline(list, ground, eye, relief, ground.radius_m());
  const core::Projected middle = ground.seen(middle_m);
  if (!ground.is_in_view(middle)) return;
  const bool is_hidden = ground.is_hidden(middle_m);
  const auto shown = [is_hidden](ImU32 colour) { return is_hidden ? faint(colour) : colour; };
  const float arm = ImGui::GetFontSize() * 0.4F;
  const ImVec2 p = at(eye.x0 + middle.xy.x, eye.y0 + middle.xy.y);
  const ImU32 colour = is_chosen ? kReliefChosen : kReliefMark;
  for (const auto& [line, width] : {std::pair{kReliefDark, 4.0F}, {colour, 2.0F}}) {
    list.AddLine({p.x - arm, p.y}, {p.x + arm, p.y}, shown(line), width);
    list.AddLine({p.x, p.y - arm}, {p.x, p.y + arm}, shown(line), width);
  }
  if (!is_chosen) return;
  const std::string name = explore::relief_title(relief);
  const ImVec2 extent = ImGui::CalcTextSize(name.c_str());
  const ImVec2 text{p.x - extent.x / 2, p.y - arm - extent.y - 2};
  draw_bordered(list, text, name, shown(colour), shown(kReliefDark));
}

}  // namespace vpe::window
