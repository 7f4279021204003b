#include "vpe/window/ui/panel_focus.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <array>
#include <utility>

namespace vpe::window {

namespace {

// What lies over others comes first.
constexpr std::array<const char*, 9> kWindows{"help",  "preferences", "files",         "side",   "side switch",
                                              "modes", "overlays",    "profile strip", "welcome"};

bool is_window_shown(const char* name) {
  const ImGuiWindow* window = ImGui::FindWindowByName(name);
  return window != nullptr && window->WasActive && !window->Hidden;
}

}  // namespace

void PanelFocus::next() {
  for (std::size_t n = at_ ? *at_ + 1 : 0; n < kWindows.size(); ++n) {
    if (!is_window_shown(kWindows[n])) continue;
    at_ = n;
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    ImGui::SetWindowFocus(kWindows[n]);
    is_new_ = true;
    return;
  }
  leave();
}

void PanelFocus::begin_frame() {
  if (!at_ || !std::exchange(is_new_, false)) return;
  // ImGui drops such requests between frames.
  if (ImGuiWindow* window = ImGui::FindWindowByName(kWindows[*at_]); window != nullptr)
    ImGui::NavInitWindow(window, true);
  ImGui::GetCurrentContext()->NavDisableHighlight = false;
}

void PanelFocus::leave() {
  if (!at_) return;
  at_.reset();
  ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
  ImGui::SetWindowFocus(nullptr);
  ImGui::GetCurrentContext()->NavDisableHighlight = true;
}

std::optional<WidgetPlace> PanelFocus::highlight() {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  ImGuiWindow* window = context.NavWindow;
  if (window == nullptr || context.NavId == 0 || context.NavDisableHighlight) return std::nullopt;
  const ImRect rect = ImGui::WindowRectRelToAbs(window, window->NavRectRel[context.NavLayer]);
  return WidgetPlace{rect.Min.x, rect.Min.y, rect.Max.x, rect.Max.y};
}

}  // namespace vpe::window
