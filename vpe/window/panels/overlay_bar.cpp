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

// Sizes at scale 1.
constexpr double kSign_px = 34;  // for the sign of recording, in the corner
constexpr double kSwitch_px = 26;
constexpr double kPadding_px = 4;
constexpr double kGap_px = 3;

constexpr const char* kNamesKey = "overlay.names";
constexpr std::array kSwitches{Switch{"Aa", kNamesKey, "", "Names of places"},
                               Switch{"\u2194", "overlay.scale", "off", "Scale bar"},
                               Switch{"N\u2191", "overlay.north", "off", "North arrow"},
                               Switch{"\u25a6", "overlay.graticule", "off", "Longitudes and latitudes"},
                               Switch{"\u2248", "overlay.contours", "off", "Contours"},
                               Switch{"\u25a4", "overlay.legend", "off", "Legend of the palette"},
                               Switch{"\u25ce", "overlay.compass", "off", "Compass"}};

}  // namespace

double overlay_bar_width_px(const std::string& names, double scale) {
  const auto count = static_cast<double>(kSwitches.size() - (names.empty() ? 1 : 0));
  return scale * (kSign_px + 2 * kPadding_px + count * (kSwitch_px + kGap_px));
}

std::string draw_overlay_bar(const ViewArea& area, double scale, explore::Session& session,
                             const std::string& names, Widgets& widgets) {
  std::string error;
  ImGui::SetNextWindowPos(at(area.x + area.width - kSign_px * scale, area.y + 6 * scale), ImGuiCond_Always,
                          {1, 0});
  ImGui::SetNextWindowBgAlpha(0.55F);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(kPadding_px * scale, kPadding_px * scale));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, at(kGap_px * scale, kGap_px * scale));
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
    if (!widgets.toggle(label.c_str(), is_on, one.tip, kSwitch_px * scale)) continue;
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
