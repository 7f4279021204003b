// Words in panels and over views: good news and trouble in their colours, figures behind their labels.
#pragma once

#include <imgui.h>

#include <string>

#include "vpe/window/screen_point.h"
#include "vpe/window/view_area.h"

namespace vpe::window {

inline const ImVec4 kTrouble{1, 0.5F, 0.4F, 1};
inline const ImVec4 kGood{0.7F, 0.9F, 0.7F, 1};

inline void coloured(const ImVec4& colour, const std::string& words) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopStyleColor();
}

// In the middle of a view that has no image, in lines as wide as most of it.
inline void draw_words(ImDrawList& list, const ViewArea& area, const std::string& words) {
  const double most = area.width * 0.8;
  const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, static_cast<float>(most));
  const ImVec2 corner = at(area.x + (area.width - static_cast<double>(size.x)) / 2,
                           area.y + (area.height - static_cast<double>(size.y)) / 2);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), corner, IM_COL32(255, 255, 255, 235), words.c_str(),
               nullptr, static_cast<float>(most));
}

// Two columns, words behind a label.
class Figures {
 public:
  explicit Figures(const char* id) : open_(ImGui::BeginTable(id, 2)) {
    if (!open_) return;
    ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFontSize() * 8.2F);
    ImGui::TableSetupColumn("words", ImGuiTableColumnFlags_WidthStretch);
  }
  ~Figures() {
    if (open_) ImGui::EndTable();
  }
  Figures(const Figures&) = delete;
  Figures& operator=(const Figures&) = delete;

  void add(const char* label, const std::string& words) const {
    if (!open_) return;
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", label);
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", words.c_str());
  }

 private:
  bool open_;
};

}  // namespace vpe::window
