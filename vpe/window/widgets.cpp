#include "vpe/window/widgets.h"

#include <imgui_stdlib.h>

#include <algorithm>

namespace vpe::window {

void Widgets::record(std::string_view label) {
  const ImVec2 a = ImGui::GetItemRectMin();
  const ImVec2 b = ImGui::GetItemRectMax();
  places_[name_of(label)] = {a.x, a.y, b.x, b.y};
}

std::string Widgets::name_of(std::string_view label) const {
  return group_.empty() ? std::string(label) : group_ + "/" + std::string(label);
}

void Widgets::show_tip(const char* text) const {
  if (text == nullptr || !ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
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

bool Widgets::toggle(const char* label, bool& on, const char* tip) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const bool was_on = on;
  const bool pressed = ImGui::Button(label);
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

bool Widgets::tab(const char* label) {
  const bool open = ImGui::BeginTabItem(label);
  record(label);
  return open;
}

bool Widgets::choose(const char* label, int& index, std::span<const std::string> names, const char* tip) {
  const auto count = static_cast<int>(names.size());
  const char* shown = index >= 0 && index < count ? names[static_cast<std::size_t>(index)].c_str() : "";
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
  double edited = is_typed ? typed_->second : value;
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

bool Widgets::text(const char* label, std::string& value, const char* tip) {
  std::string& draft = drafts_[ImGui::GetID(label)];
  if (editing_ != ImGui::GetID(label)) draft = value;
  const bool entered =
      ImGui::InputText(label, &draft, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  record(label);
  show_tip(tip);
  if (ImGui::IsItemActive()) {
    editing_ = ImGui::GetID(label);
  } else if (editing_ == ImGui::GetID(label)) {
    editing_ = 0;
  }
  if (!entered && !ImGui::IsItemDeactivatedAfterEdit()) return false;
  if (draft == value) return false;
  value = draft;
  return true;
}

}  // namespace vpe::window
