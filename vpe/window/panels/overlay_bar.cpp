#include "vpe/window/panels/overlay_bar.h"

#include <array>

namespace vpe::window {

namespace {

struct Switch {
  const char* sign;
  const char* key;
  const char* off;
  const char* tip;
};

constexpr const char* kNamesKey = "overlay.names";
constexpr std::array kSwitches{Switch{"Aa", kNamesKey, "", "Names of places"},
                               Switch{"\u2194", "overlay.scale", "off", "Scale bar"},
                               Switch{"N\u2191", "overlay.north", "off", "North arrow"},
                               Switch{"\u25a6", "overlay.graticule", "off", "Longitudes and latitudes"},
                               Switch{"\u2248", "overlay.contours", "off", "Contours"},
                               Switch{"\u25a4", "overlay.legend", "off", "Legend of the palette"},
                               Switch{"\u25ce", "overlay.compass", "off", "Compass"}};

}  // namespace

std::string draw_overlay_bar(const ViewArea& area, double scale, explore::Session& session,
                             const std::string& names, Widgets& widgets) {
  std::string error;
  // A sign of recording is in the corner.
  ImGui::SetNextWindowPos(at(area.x + area.width - 34 * scale, area.y + 6 * scale), ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.55F);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(4 * scale, 4 * scale));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, at(3 * scale, 3 * scale));
  ImGui::Begin("overlays", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  bool is_first = true;
  for (const Switch& one : kSwitches) {
    const bool is_names = std::string_view(one.key) == kNamesKey;
    const std::string text = session.settings().get(one.key).value_or("");
    if (is_names && names.empty() && text.empty()) continue;
    if (!std::exchange(is_first, false)) ImGui::SameLine();
    bool is_on = text != one.off;
    const std::string label = std::string(one.sign) + "##" + one.key;
    if (!widgets.toggle(label.c_str(), is_on, one.tip, 26 * scale)) continue;
    const std::string next = is_on ? (is_names ? names : "on") : one.off;
    if (std::string problem = session.set(one.key, next); !problem.empty()) error = std::move(problem);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return error;
}

std::vector<std::string> overlays_on(const core::Settings& settings) {
  std::vector<std::string> on;
  for (const Switch& one : kSwitches) {
    const std::string text = settings.get(one.key).value_or("");
    if (text != one.off) on.push_back(std::string(one.key) + "=" + text);
  }
  return on;
}

}  // namespace vpe::window
