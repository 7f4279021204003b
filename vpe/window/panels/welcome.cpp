#include "vpe/window/panels/welcome.h"

#include <algorithm>

namespace vpe::window {

namespace {

constexpr std::size_t kButtons = 5;

}  // namespace

Welcome::Welcome(const explore::PlaceSearch& places) {
  for (const std::string_view name : explore::kSights.first(kButtons))
    if (const core::Place* place = places.named(name)) sights_.push_back(*place);
  if (!sights_.empty()) return;
  const auto& all = places.places();
  sights_.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), kButtons)));
}

std::optional<core::Place> Welcome::draw(const ViewArea& area, double scale, Widgets& widgets) {
  std::optional<core::Place> chosen;
  if (!is_shown_) return chosen;
  ImGui::SetNextWindowPos(at(area.x + area.width / 2, area.y + area.height - 14 * scale), ImGuiCond_Always,
                          {0.5F, 1});
  ImGui::SetNextWindowSizeConstraints(at(0, 0), at(area.width, area.height));
  ImGui::SetNextWindowBgAlpha(0.72F);
  ImGui::Begin("welcome", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::TextUnformatted(
      "Drag to move  \u00b7  wheel to come nearer  \u00b7  right drag to tilt  \u00b7  F1 for all");
  const float right = ImGui::GetWindowPos().x + static_cast<float>(area.width) * 0.9F;
  for (std::size_t n = 0; n < sights_.size(); ++n) {
    const float wide = ImGui::CalcTextSize(sights_[n].name.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (n > 0) {
      ImGui::SameLine();
      if (ImGui::GetCursorScreenPos().x + wide > right) ImGui::NewLine();
    }
    if (widgets.button(sights_[n].name.c_str())) chosen = sights_[n];
  }
  ImGui::End();
  return chosen;
}

}  // namespace vpe::window
