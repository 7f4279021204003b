// The panels of everything in the settings registry.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lod/tree/posts.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/words.h"

namespace vpe::window {

void ExploreWindow::setting(const core::SettingInfo& info) {
  const std::string key(info.key);
  const std::string text = session_.settings().get(key).value_or("");
  const std::string meaning =
      std::string(info.meaning) + (info.unit.empty() ? "" : " (" + std::string(info.unit) + ")");
  std::string next = text;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
  bool changed = false;
  const bool is_switch = info.type == core::SettingType::kChoice && info.choices.size() == 2 &&
                         ((info.choices[0] == "off" && info.choices[1] == "on") ||
                          (info.choices[0] == "on" && info.choices[1] == "off"));
  if (is_switch) {
    bool on = text == "on";
    changed = widgets_.check(key.c_str(), on, meaning.c_str());
    next = on ? "on" : "off";
  } else if (info.type == core::SettingType::kChoice) {
    std::vector<std::string> names(info.choices.begin(), info.choices.end());
    const auto found = std::find(names.begin(), names.end(), text);
    int index = static_cast<int>(found - names.begin());
    changed = widgets_.choose(key.c_str(), index, names, meaning.c_str());
    if (changed) next = names[static_cast<std::size_t>(index)];
  } else if (info.type == core::SettingType::kNumber || info.type == core::SettingType::kInteger) {
    double value = base::parse_number(text).value_or(0.0);
    const double step = info.type == core::SettingType::kInteger ? 1.0 : std::abs(value) >= 10 ? 1.0 : 0.1;
    changed = widgets_.number(key.c_str(), value, info.min, info.max, step, "%.6g", meaning.c_str());
    if (changed)
      next = base::format_number(info.type == core::SettingType::kInteger ? std::round(value) : value);
  } else {
    changed = widgets_.text(key.c_str(), next, (meaning + ": " + info.grammar).c_str());
  }
  if (!changed) return;
  const std::string trouble = session_.set(key, next);
  if (!trouble.empty()) say(trouble, true);
}

void ExploreWindow::settings_group(std::string_view prefix, const std::vector<std::string_view>& without) {
  for (const core::SettingInfo& info : core::Settings::list()) {
    if (!info.key.starts_with(prefix)) continue;
    const bool left_out = std::any_of(without.begin(), without.end(),
                                      [&](std::string_view p) { return info.key.starts_with(p); });
    if (!left_out) setting(info);
  }
}

void ExploreWindow::appearance_panel() {
  ImGui::BeginChild("appearance");
  if (ImGui::CollapsingHeader("Ground", ImGuiTreeNodeFlags_DefaultOpen))
    settings_group("", {"lod.", "rays.", "cull.", "overlay.", "sun", "ramp.", "samples", "edges", "inspect",
                        "haze", "background", "gamma", "shadows"});
  if (ImGui::CollapsingHeader("Light and air", ImGuiTreeNodeFlags_DefaultOpen)) {
    settings_group("sun", {});
    settings_group("shadows", {});
    settings_group("haze", {});
    settings_group("gamma", {});
    settings_group("background", {});
  }
  if (ImGui::CollapsingHeader("Over the picture")) settings_group("overlay.", {});
  if (ImGui::CollapsingHeader("Palette from two colours")) settings_group("ramp.", {});
  ImGui::EndChild();
}

void ExploreWindow::detail_panel() {
  ImGui::BeginChild("detail");
  if (ImGui::CollapsingHeader("Level of detail", ImGuiTreeNodeFlags_DefaultOpen)) settings_group("lod.", {});
  if (ImGui::CollapsingHeader("Rays", ImGuiTreeNodeFlags_DefaultOpen)) settings_group("rays.", {});
  if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen)) {
    settings_group("samples", {});
    settings_group("edges", {});
    settings_group("cull.", {});
    settings_group("inspect", {});
  }
  if (drawn_ && ImGui::CollapsingHeader("Tiles by level", ImGuiTreeNodeFlags_DefaultOpen)) {
    const std::vector<int>& levels = drawn_->result.stats.tiles_by_level;
    for (std::size_t n = 0; n < levels.size(); ++n) {
      if (levels[n] == 0) continue;
      const double spacing_m = lod::post_spacing_m(static_cast<int>(n), setup_.planet->meta().tile.intervals(),
                                                   setup_.planet->radius_m());
      ImGui::Text("%2d   %4d tiles   posts of %s", core::shown_level(static_cast<int>(n)), levels[n],
                  metres(spacing_m).c_str());
    }
  }
  if (!session_.interest().empty()) {
    ImGui::Separator();
    ImGui::Text("Regions of interest: %d", static_cast<int>(session_.interest().size()));
    ImGui::SameLine();
    if (widgets_.button("Remove all")) session_.set_interest({});
  } else {
    ImGui::TextDisabled("Shift-drag on the map: a region of interest");
  }
  ImGui::EndChild();
}

}  // namespace vpe::window
