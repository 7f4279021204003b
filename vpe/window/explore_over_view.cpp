// What lies over the view of the explore window: modes of motion, switches of overlays, the profile, notes.
#include <algorithm>
#include <glm/vec2.hpp>
#include <string>
#include <utility>

#include "vpe/window/explore_window.h"
#include "vpe/window/panels/overlay_bar.h"

namespace vpe::window {

namespace {

constexpr double kBarsNeed_px = 250;  // width at scale 1
const ImVec4 kHintColour{1, 0.84F, 0.55F, 1};
constexpr const char* kCaught =
    "Moving the mouse looks around  \u00b7  wheel: speed  \u00b7  Esc or X lets the cursor go";

// Draws a message over the middle of a view's lower edge, whole. Returns its height.
double draw_note(const ViewArea& area, const std::string& text, const ImVec4& colour, double scale) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const double margin = 10 * scale;
  const double most = std::max(40.0, area.width - 4 * margin);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, static_cast<float>(most));
  const double wide = static_cast<double>(size.x);
  const double left = area.x + (area.width - wide) / 2;
  const double top = area.y + area.height - margin - static_cast<double>(size.y);
  list.AddRectFilled(at(left - margin, top - margin),
                     at(left + wide + margin, top + static_cast<double>(size.y)), IM_COL32(0, 0, 0, 170), 4);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at(left, top - margin / 2),
               ImGui::ColorConvertFloat4ToU32(colour), text.c_str(), nullptr, static_cast<float>(most));
  return static_cast<double>(size.y) + margin;
}

// Draws a cross where a cursor that is caught would be.
void draw_middle_mark(ImDrawList& list, glm::dvec2 middle, double scale) {
  const double size = 6 * scale;
  for (const auto& [colour, thick] :
       {std::pair{IM_COL32(0, 0, 0, 160), 3.0}, {IM_COL32(255, 255, 255, 220), 1.0}}) {
    const auto wide = static_cast<float>(thick * scale);
    list.AddLine(at(middle.x - size, middle.y), at(middle.x + size, middle.y), colour, wide);
    list.AddLine(at(middle.x, middle.y - size), at(middle.x, middle.y + size), colour, wide);
  }
}

// Draws a red dot at the upper right of the view while the session is recorded.
void draw_recording_sign(const ViewArea& area, double scale) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const double radius = 6 * scale;
  const ImVec2 middle = at(area.x + area.width - 3 * radius, area.y + 3 * radius);
  list.AddCircleFilled(middle, static_cast<float>(radius * 1.35), IM_COL32(0, 0, 0, 150));
  list.AddCircleFilled(middle, static_cast<float>(radius), IM_COL32(235, 40, 30, 255));
}

}  // namespace

// Draws what is told also without panels: messages, the sign of recording, how to free a cursor that is caught.
void ExploreWindow::draw_notes() {
  const double scale = display_.scale();
  ViewArea free = view_area_;
  if (display_.has_caught_cursor()) {
    for (int eye = 0; eye < image_layout().eyes(); ++eye) {
      const ViewArea area = image_layout().eye_area(eye);
      draw_middle_mark(*ImGui::GetForegroundDrawList(), {area.x + area.width / 2, area.y + area.height / 2},
                       scale);
    }
    free.height -= draw_note(free, kCaught, kHintColour, scale);
  }
  if (!state_.message.empty())
    draw_note(free, state_.message, state_.message_is_error ? kErrorColour : kSuccessColour, scale);
  if (recorder_.is_recording()) draw_recording_sign(view_area_, scale);
}

// Draws the windows that lie over the view: switches of overlays, the profile, the first hints.
void ExploreWindow::draw_over_view() {
  if (state_.large_map || guide_.inside() != nullptr) return;
  const double scale = display_.scale();
  // A side panel over the view leaves the rest.
  ViewArea free = view_area_;
  if (layout_.is_narrow) {
    free.x += layout_.side.width + 24 * scale;
    free.width -= layout_.side.width + 24 * scale;
  }
  if (free.width > kBarsNeed_px * scale) draw_bars(free);
  if (measure_.points().size() >= 2 && view_area_.height > 2 * MeasurePanel::kStrip_px * scale) {
    ImGui::SetNextWindowPos(
        at(view_area_.x, view_area_.y + view_area_.height - MeasurePanel::kStrip_px * scale));
    ImGui::SetNextWindowSize(at(view_area_.width, MeasurePanel::kStrip_px * scale));
    ImGui::SetNextWindowBgAlpha(0.85F);
    ImGui::Begin("profile strip", nullptr,
                 kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoFocusOnAppearing);
    const MeasureActions actions = measure_.draw_profile(widgets_);
    if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
    ImGui::End();
  } else if (!layout_.is_narrow || layout_.side.width <= 0) {
    if (const auto place = welcome_.draw(view_area_, scale, widgets_)) fly_to(*place);
  }
}

// Draws the modes at the upper left, and the switches of overlays at the upper right, below them where there is no room
// beside them.
void ExploreWindow::draw_bars(const ViewArea& area) {
  const double scale = display_.scale();
  const glm::dvec2 modes = draw_modes(area);
  ViewArea free = area;
  if (modes.x + overlay_bar_width_px(setup_.places_file, scale) > area.width) {
    free.y += modes.y;
    free.height -= modes.y;
  }
  const std::string error = draw_overlay_bar(free, scale, session_, setup_.places_file, widgets_);
  if (!error.empty()) show_message(error, true);
}

// Returns the room that they take, with the space around them.
glm::dvec2 ExploreWindow::draw_modes(const ViewArea& area) {
  const double scale = display_.scale();
  const double space = 6 * scale;
  ImGui::SetNextWindowPos(at(area.x + space, area.y + space));
  ImGui::SetNextWindowBgAlpha(0.55F);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(4 * scale, 4 * scale));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, at(3 * scale, 3 * scale));
  ImGui::Begin("modes", nullptr,
               kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  for (const explore::MotionMode mode : explore::motion_modes()) {
    if (mode != explore::motion_modes().front()) ImGui::SameLine();
    bool is_on = session_.mode() == mode;
    const std::string name(explore::to_string(mode));
    if (widgets_.toggle(name.c_str(), is_on, (std::string(explore::meaning(mode)) + " (F)").c_str()) && is_on) {
      session_.set_mode(mode);
      show_message(name + ": " + std::string(explore::meaning(mode)));
    }
  }
  ImGui::SameLine();
  ImGui::BeginDisabled(session_.mode() == explore::MotionMode::kOrbit);
  bool is_caught = display_.has_caught_cursor();
  if (widgets_.toggle("mouse", is_caught, "X: moving the mouse looks around, without a button")) {
    if (const std::string error = catch_cursor(); !error.empty()) show_message(error, true);
  }
  ImGui::EndDisabled();
  if (setup_.planet->earlier() != nullptr) {
    ImGui::SameLine();
    bool is_on = swipe_.is_on();
    if (widgets_.toggle("swipe", is_on, "B: a line with the earlier planet on its left; [ and ] move it")) {
      if (const std::string error = swipe(explore::ActionKind::kSwipe); !error.empty()) show_message(error);
    }
  }
  const ImVec2 size = ImGui::GetWindowSize();
  ImGui::End();
  ImGui::PopStyleVar(2);
  return {static_cast<double>(size.x) + 2 * space, static_cast<double>(size.y) + space};
}

}  // namespace vpe::window
