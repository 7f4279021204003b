// Words in panels: good news and trouble in their colours, figures behind their labels.
#pragma once

#include <imgui.h>

#include <string>

namespace vpe::window {

inline const ImVec4 kTrouble{1, 0.5F, 0.4F, 1};
inline const ImVec4 kGood{0.7F, 0.9F, 0.7F, 1};

inline void coloured(const ImVec4& colour, const std::string& words) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopStyleColor();
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
