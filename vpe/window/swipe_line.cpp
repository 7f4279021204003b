#include "vpe/window/swipe_line.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vpe::window {

namespace {

constexpr ImU32 kSwipeColour = IM_COL32(255, 255, 255, 235);
constexpr ImU32 kSwipeShade = IM_COL32(0, 0, 0, 160);

void draw_side_name(ImDrawList& list, const char* name, glm::dvec2 middle) {
  const ImVec2 size = ImGui::CalcTextSize(name);
  const glm::dvec2 half(0.5 * static_cast<double>(size.x), 0.5 * static_cast<double>(size.y));
  const double pad = 0.4 * half.y;
  list.AddRectFilled(at(middle.x - half.x - 2 * pad, middle.y - half.y - pad),
                     at(middle.x + half.x + 2 * pad, middle.y + half.y + pad), kSwipeShade,
                     static_cast<float>(2 * pad));
  list.AddText(at(middle.x - half.x, middle.y - half.y), kSwipeColour, name);
}

}  // namespace

void SwipeLine::set_on(bool is_on) {
  is_on_ = is_on;
  is_held_ = false;
}

double SwipeLine::x_px(const ViewArea& area) const { return area.x + share_ * area.width; }

void SwipeLine::move_by(double share) { share_ = std::clamp(share_ + share, kMargin, 1 - kMargin); }

bool SwipeLine::is_at(const ViewArea& area, glm::dvec2 cursor, double scale) const {
  if (!is_on_) return false;
  return is_held_ || (area.holds(cursor.x, cursor.y) && std::abs(cursor.x - x_px(area)) <= kReach_px * scale);
}

bool SwipeLine::press(const ViewArea& area, glm::dvec2 cursor, double scale) {
  if (!is_at(area, cursor, scale)) return false;
  is_held_ = true;
  grip_px_ = cursor.x - x_px(area);
  return true;
}

bool SwipeLine::drag(const ViewArea& area, glm::dvec2 cursor) {
  if (!is_held_) return false;
  share_ = std::clamp((cursor.x - grip_px_ - area.x) / std::max(area.width, 1.0), kMargin, 1 - kMargin);
  return true;
}

bool SwipeLine::release() { return std::exchange(is_held_, false); }

void SwipeLine::draw(ImDrawList& list, const ViewArea& area, double scale) const {
  const double x = std::round(x_px(area));
  const double middle = area.y + 0.5 * area.height;
  const double bottom = area.y + area.height;
  list.AddLine(at(x, area.y), at(x, bottom), kSwipeShade, static_cast<float>(4 * scale));
  list.AddLine(at(x, area.y), at(x, bottom), kSwipeColour, static_cast<float>(1.5 * scale));
  const double radius = 9 * scale;
  list.AddCircleFilled(at(x, middle), static_cast<float>(1.2 * radius), kSwipeShade);
  list.AddCircleFilled(at(x, middle), static_cast<float>(radius), kSwipeColour);
  for (const double side : {-1.0, 1.0}) {
    list.AddTriangleFilled(at(x + 0.7 * side * radius, middle),
                           at(x + 0.2 * side * radius, middle - 0.45 * radius),
                           at(x + 0.2 * side * radius, middle + 0.45 * radius), IM_COL32(0, 0, 0, 255));
  }
  const double name_y = bottom - 28 * scale;
  draw_side_name(list, "earlier", {x - 40 * scale, name_y});
  draw_side_name(list, "later", {x + 34 * scale, name_y});
}

}  // namespace vpe::window
