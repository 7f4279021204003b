#include "vpe/window/settings_panels.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "lod/tree/posts.h"
#include "vpe/base/number.h"
#include "vpe/window/imgui_helpers.h"

namespace vpe::window {

namespace {

// Draws rows of settings and applies changes.
class SettingRows {
 public:
  SettingRows(explore::Session& session, const DrawnImage* drawn, Widgets& widgets)
      : session_(session), drawn_(drawn), widgets_(widgets) {}

  // Draws the settings whose keys begin with `prefix` and with none of `without`.
  void group(std::string_view prefix, const std::vector<std::string_view>& without = {}) {
    for (const core::SettingInfo& info : core::Settings::list()) {
      if (!info.key.starts_with(prefix)) continue;
      const bool left_out = std::any_of(without.begin(), without.end(),
                                        [&](std::string_view p) { return info.key.starts_with(p); });
      if (!left_out) row(info);
    }
  }

  // Returns what is wrong with the last setting that could not be changed, or "".
  const std::string& error() const { return error_; }

 private:
  void row(const core::SettingInfo& info);
  double number_shown(const core::SettingInfo& info, const std::string& text) const;

  explore::Session& session_;
  const DrawnImage* drawn_;
  Widgets& widgets_;
  std::string error_;
};

// Returns the number of a setting; where a word stands for it, the one in use.
double SettingRows::number_shown(const core::SettingInfo& info, const std::string& text) const {
  if (const auto number = base::parse_number(text)) return *number;
  if (drawn_ == nullptr || !drawn_->palette) return 0;
  return info.key == "palette.low" ? drawn_->palette->low : drawn_->palette->high;
}

void SettingRows::row(const core::SettingInfo& info) {
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
    double value = number_shown(info, text);
    const double step = info.type == core::SettingType::kInteger ? 1.0 : std::abs(value) >= 10 ? 1.0 : 0.1;
    changed = widgets_.number(key.c_str(), value, info.min, info.max, step, "%.6g", meaning.c_str());
    if (changed)
      next = base::format_number(info.type == core::SettingType::kInteger ? std::round(value) : value);
    if (!info.word.empty()) {
      const std::string label = std::string(info.word) + "##" + key;
      const bool was = text == info.word;
      bool is = was && !changed;
      ImGui::SameLine();
      if (widgets_.check(label.c_str(), is, "as the view asks for once it rests")) {
        changed = true;
        next = is ? std::string(info.word) : base::format_number(value);
      }
    }
  } else {
    changed = widgets_.text(key.c_str(), next, (meaning + ": " + info.grammar).c_str());
  }
  if (!changed) return;
  if (std::string problem = session_.set(key, next); !problem.empty()) error_ = std::move(problem);
}

}  // namespace

std::string draw_appearance_panel(explore::Session& session, const DrawnImage* drawn, Widgets& widgets) {
  SettingRows rows(session, drawn, widgets);
  ImGui::BeginChild("appearance");
  if (ImGui::CollapsingHeader("Ground", ImGuiTreeNodeFlags_DefaultOpen))
    rows.group("", {"lod.", "rays.", "cull.", "overlay.", "sun", "ramp.", "samples", "edges", "inspect", "haze",
                    "background", "gamma", "shadows"});
  if (ImGui::CollapsingHeader("Light and air", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (const char* prefix : {"sun", "shadows", "haze", "gamma", "background"}) rows.group(prefix);
  }
  if (ImGui::CollapsingHeader("Over the image")) rows.group("overlay.");
  if (ImGui::CollapsingHeader("Palette from two colours")) rows.group("ramp.");
  ImGui::EndChild();
  return rows.error();
}

std::string draw_detail_panel(explore::Session& session, const DrawnImage* drawn,
                              const paging::PlanetFile& planet, Widgets& widgets) {
  SettingRows rows(session, drawn, widgets);
  ImGui::BeginChild("detail");
  if (ImGui::CollapsingHeader("Level of detail", ImGuiTreeNodeFlags_DefaultOpen)) rows.group("lod.");
  if (ImGui::CollapsingHeader("Rays", ImGuiTreeNodeFlags_DefaultOpen)) rows.group("rays.");
  if (ImGui::CollapsingHeader("Image", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (const char* prefix : {"samples", "edges", "cull.", "inspect"}) rows.group(prefix);
  }
  if (drawn != nullptr && ImGui::CollapsingHeader("Tiles by level", ImGuiTreeNodeFlags_DefaultOpen)) {
    const std::vector<int>& levels = drawn->result.stats.tiles_by_level;
    for (std::size_t n = 0; n < levels.size(); ++n) {
      if (levels[n] == 0) continue;
      const int level = static_cast<int>(n);
      const double spacing_m = lod::post_spacing_m(level, planet.meta().tile.intervals(), planet.radius_m());
      ImGui::Text("%2d   %4d tiles   posts every %s", level, levels[n], panel_length_text(spacing_m).c_str());
    }
  }
  if (!session.interest().empty()) {
    ImGui::Separator();
    ImGui::Text("Regions of interest: %d", static_cast<int>(session.interest().size()));
    ImGui::SameLine();
    if (widgets.button("Remove all")) session.set_interest({});
  } else {
    ImGui::TextDisabled("Shift + drag on the map adds a region of interest");
  }
  ImGui::EndChild();
  return rows.error();
}

}  // namespace vpe::window
