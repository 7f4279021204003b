#include "vpe/window/panels/help_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include "vpe/explore/input/keyboard.h"

namespace vpe::window {

namespace {

const ImVec4 kHelpKeyColour{1, 0.84F, 0.55F, 1};
constexpr const char* kMouseHelp[][2] = {
    {"left drag", "move the ground with the cursor; in a flight: look around"},
    {"wheel", "zoom to the ground under the cursor; in a flight: field of view"},
    {"Ctrl + left drag", "look around in place; in fly and walk any left drag does"},
    {"X in fly, walk, drive",
     "the mouse looks around without a button, the wheel sets the speed; Esc or X ends it"},
    {"right or middle drag, Shift + left drag", "tilt and rotate about the middle of the view"},
    {"right click, also on the map", "what is there; viewshed, panorama, profile, measuring from there"},
    {"double click", "fly there"},
    {"with a tool of Draw",
     "click, or V in the middle of the view: vertex; double click, Enter: end; Backspace: take back; Esc: cancel"},
    {"in the panels Objects, Ground",
     "click: select; drag: move; with Place, click or V: place; Delete; while following, drag: turn; Esc: end"},
    {"Ctrl + Z, Ctrl + Shift + Z, Ctrl + S", "undo, redo, save the project, the scene, or the reliefs"},
    {"on the map",
     "click: fly there; Ctrl + click: add a waypoint; Alt + drag: turn the camera; (Ctrl +) Shift + drag: "
     "region of interest"},
};

float text_width(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; }

// Draws lines of keys and meanings in one or two pairs of columns. Longer meanings than `meaning_px` are wrapped.
void draw_lines(const char* id, const std::vector<explore::HelpLine>& lines, int pairs, float keys_px,
                float meaning_px) {
  if (!ImGui::BeginTable(id, 2 * pairs)) return;
  for (int n = 0; n < pairs; ++n) {
    ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, keys_px);
    ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthFixed, meaning_px);
  }
  const std::size_t rows =
      (lines.size() + static_cast<std::size_t>(pairs) - 1) / static_cast<std::size_t>(pairs);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t n = row; n < lines.size(); n += rows) {
      ImGui::TableNextColumn();
      coloured(kHelpKeyColour, lines[n].keys);
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", lines[n].meaning.c_str());
    }
  }
  ImGui::EndTable();
}

}  // namespace

void draw_explore_help(const ViewArea& area, bool& is_open, Widgets& widgets) {
  std::vector<explore::HelpLine> mouse;
  for (const auto& line : kMouseHelp) mouse.push_back({line[0], line[1]});
  const std::vector<explore::HelpLine> keys = explore::keyboard_help();
  const auto widest = [](const std::vector<explore::HelpLine>& lines, auto member) {
    float wide = 0;
    for (const explore::HelpLine& line : lines) wide = std::max(wide, text_width(line.*member));
    return wide;
  };
  using Line = explore::HelpLine;
  const ImGuiStyle& style = ImGui::GetStyle();
  const float gaps = 2 * style.WindowPadding.x + style.ScrollbarSize + 8 * style.CellPadding.x;
  const float room = static_cast<float>(area.width) - gaps;
  const float keys_px = widest(keys, &Line::keys);
  const float meaning_px = widest(keys, &Line::meaning);
  const float half_px = std::min(meaning_px, room / 2 - keys_px);
  const bool has_two = half_px > 0.6F * meaning_px;
  const float mouse_px = std::min(widest(mouse, &Line::keys), room * 0.4F);
  const float narrow_px = std::min(keys_px, room * 0.4F);

  ImGui::SetNextWindowPos(at(area.x + area.width / 2, area.y + area.height / 2), ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints(at(0, 0), at(area.width, area.height));
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoTitleBar);
  if (widgets.button("Close help", "Esc or F1")) is_open = false;
  draw_lines("mouse", mouse, 1, mouse_px, std::min(widest(mouse, &Line::meaning), room - mouse_px));
  ImGui::Separator();
  if (has_two)
    draw_lines("keys", keys, 2, keys_px, half_px);
  else
    draw_lines("keys", keys, 1, narrow_px, std::min(meaning_px, room - narrow_px));
  ImGui::End();
}

}  // namespace vpe::window
