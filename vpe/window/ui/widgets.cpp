#include "vpe/window/ui/widgets.h"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vpe::window {

namespace {

// Returns 0 for a number of which only the sign of zero would be seen.
double without_negative_zero(double value, const char* format) {
  if (!(value < 0) && !std::signbit(value)) return value;
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return std::string_view(text).find_first_of("123456789") == std::string_view::npos ? 0.0 : value;
}

}  // namespace

void Widgets::record(std::string_view label) {
  const ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low = list.GetClipRectMin();
  const ImVec2 high = list.GetClipRectMax();
  const ImVec2 a = ImGui::GetItemRectMin();
  const ImVec2 b = ImGui::GetItemRectMax();
  const WidgetPlace seen{std::max(a.x, low.x), std::max(a.y, low.y), std::min(b.x, high.x),
                         std::min(b.y, high.y)};
  if (seen.x0 < seen.x1 && seen.y0 < seen.y1) places_[name_of(label)] = seen;
}

std::string Widgets::name_of(std::string_view label) const {
  return group_.empty() ? std::string(label) : group_ + "/" + std::string(label);
}

void Widgets::begin_frame() {
  places_.clear();
  tip_due_s_.reset();
}

// Draws a tooltip beside the panel, where it covers no other field.
void Widgets::show_tip(const char* text) {
  if (text == nullptr || *text == '\0' || !ImGui::IsItemHovered()) return;
  const double rested_s = static_cast<double>(ImGui::GetCurrentContext()->HoveredIdTimer);
  if (rested_s < kTip_s) {
    tip_due_s_ = kTip_s - rested_s;
    return;
  }
  const ImGuiWindow& panel = *ImGui::GetCurrentWindow()->RootWindow;
  const float wide = ImGui::GetFontSize() * 24;
  const float right = panel.Pos.x + panel.Size.x + ImGui::GetStyle().ItemSpacing.x;
  if (right + wide < ImGui::GetIO().DisplaySize.x) ImGui::SetNextWindowPos({right, ImGui::GetItemRectMin().y});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(wide);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool Widgets::button(const char* label, const char* tip) {
  const bool pressed = ImGui::Button(label);
  record(label);
  show_tip(tip);
  return pressed;
}

bool Widgets::toggle(const char* label, bool& on, const char* tip, double width) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const bool was_on = on;
  const bool pressed = ImGui::Button(label, {static_cast<float>(width), 0});
  record(label);
  if (was_on) ImGui::PopStyleColor();
  show_tip(tip);
  if (pressed) on = !on;
  return pressed;
}

bool Widgets::check(const char* label, bool& on, const char* tip) {
  const bool changed = ImGui::Checkbox(label, &on);
  record(label);
  show_tip(tip);
  return changed;
}

bool Widgets::header(const char* label, bool is_open) {
  const bool open = ImGui::CollapsingHeader(label, is_open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  record(label);
  return open;
}

bool Widgets::tab(const char* label) {
  const bool open = ImGui::BeginTabItem(label);
  record(label);
  return open;
}

bool Widgets::choose(const char* label, int& index, std::span<const std::string> names, const char* tip,
                     const char* hint) {
  const auto count = static_cast<int>(names.size());
  const char* shown = index >= 0 && index < count ? names[static_cast<std::size_t>(index)].c_str() : hint;
  bool changed = false;
  const bool open = ImGui::BeginCombo(label, shown);
  record(label);
  if (!open) {
    show_tip(tip);
    return false;
  }
  for (int n = 0; n < count; ++n) {
    const std::string& name = names[static_cast<std::size_t>(n)];
    if (ImGui::Selectable(name.c_str(), n == index)) {
      changed = n != index;
      index = n;
    }
    record(std::string(label) + "=" + name);
  }
  ImGui::EndCombo();
  return changed;
}

bool Widgets::number(const char* label, double& value, double low, double high, double step, const char* format,
                     const char* tip) {
  // GetID() would tell ImGui 1.86 that the field is not part of the group that InputDouble() makes.
  const std::string name = name_of(label);
  const bool is_typed = typed_ && typed_->first == name;
  double edited = is_typed ? typed_->second : without_negative_zero(value, format);
  const bool changed =
      ImGui::InputDouble(label, &edited, step, step * 10, format, ImGuiInputTextFlags_AutoSelectAll);
  const bool is_active = ImGui::IsItemActive();
  record(label);
  show_tip(tip);
  // Without text input the change is a step.
  if (is_active && (ImGui::GetIO().WantTextInput || is_typed)) {
    if (changed) typed_ = std::pair{name, edited};
    return false;
  }
  if (is_typed) typed_.reset();
  if ((!changed && !is_typed) || !(edited == edited)) return false;
  edited = std::clamp(edited, low, high);
  if (edited == value) return false;
  value = edited;
  return true;
}

bool Widgets::slide(const char* label, double& value, double low, double high, const char* format,
                    bool logarithmic, const char* tip) {
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool changed = ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format, flags);
  record(label);
  show_tip(tip);
  return changed;
}

bool Widgets::text(const char* label, std::string& value, const char* tip, const char* hint) {
  std::string& draft = drafts_[ImGui::GetID(label)];
  auto refused = refused_.find(name_of(label));
  if (refused != refused_.end() && refused->second.instead.value_or(value) != value) {
    refused_.erase(refused);
    refused = refused_.end();
  }
  const bool is_refused = refused != refused_.end();
  if (is_refused) refused->second.instead = value;
  if (editing_ != ImGui::GetID(label)) draft = is_refused ? refused->second.text : value;
  if (is_refused) ImGui::PushStyleColor(ImGuiCol_Text, {1, 0.5F, 0.4F, 1});
  const bool entered = ImGui::InputTextWithHint(
      label, hint, &draft, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  if (is_refused) ImGui::PopStyleColor();
  record(label);
  show_tip(tip);
  if (ImGui::IsItemActive()) {
    editing_ = ImGui::GetID(label);
  } else if (editing_ == ImGui::GetID(label)) {
    editing_ = 0;
  }
  if (!entered && !ImGui::IsItemDeactivatedAfterEdit()) return false;
  refused_.erase(name_of(label));
  if (draft == value) return false;
  value = draft;
  return true;
}

}  // namespace vpe::window
