#include "vpe/window/ui/imgui_helpers.h"

#include <cmath>
#include <utility>

namespace vpe::window {

void coloured(const ImVec4& colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

void coloured_line(const ImVec4& colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

void draw_bordered(ImDrawList& list, const ImVec2& corner, const std::string& text, ImU32 colour,
                   ImU32 border) {
  for (const auto& [dx, dy] : {std::pair{-1.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, -1.0F}, {0.0F, 1.0F}})
    list.AddText({corner.x + dx, corner.y + dy}, border, text.c_str());
  list.AddText(corner, colour, text.c_str());
}

void draw_message(ImDrawList& list, const ViewArea& area, const std::string& text) {
  const double most = area.width * 0.8;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, static_cast<float>(most));
  const ImVec2 corner = at(area.x + (area.width - static_cast<double>(size.x)) / 2,
                           area.y + (area.height - static_cast<double>(size.y)) / 2);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), corner, IM_COL32(255, 255, 255, 235), text.c_str(),
               nullptr, static_cast<float>(most));
}

std::string panel_length_text(double length_m) {
  const double size = std::abs(length_m);
  if (size >= 1e6) return formatted("%.0f km", length_m / 1e3);
  if (size >= 1e4) return formatted("%.1f km", length_m / 1e3);
  if (size >= 100) return formatted("%.0f m", length_m);
  return formatted("%.2f m", length_m);
}

ValueTable::ValueTable(const char* id) : open_(ImGui::BeginTable(id, 2)) {
  if (!open_) return;
  ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFontSize() * 8.2F);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
}

void draw_hint(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  ImGui::TextWrapped("%s", text);
  ImGui::PopStyleColor();
}

ValueTable::~ValueTable() {
  if (open_) ImGui::EndTable();
}

void ValueTable::add(const char* label, const std::string& value) const {
  if (!open_) return;
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", label);
  ImGui::TableNextColumn();
  ImGui::TextWrapped("%s", value.c_str());
}

}  // namespace vpe::window
