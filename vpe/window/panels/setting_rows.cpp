#include "vpe/window/panels/setting_rows.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "vpe/base/number.h"
#include "vpe/explore/places/place_search.h"

namespace vpe::window {

namespace {

std::string default_of(const std::string& key) {
  static const core::Settings defaults;
  return defaults.get(key).value_or("");
}

}  // namespace

void SettingRows::group(std::string_view prefix, const std::vector<std::string_view>& without) {
  for (const core::SettingInfo& info : core::Settings::list()) {
    if (!info.key.starts_with(prefix)) continue;
    const bool left_out = std::any_of(without.begin(), without.end(),
                                      [&](std::string_view p) { return info.key.starts_with(p); });
    if (!left_out) row(info);
  }
}

void SettingRows::matching(std::string_view text) {
  const std::string wanted = explore::folded(text);
  for (const core::SettingInfo& info : core::Settings::list()) {
    const std::string all = explore::folded(std::string(info.key) + " " + std::string(info.meaning));
    if (all.find(wanted) != std::string::npos) row(info);
  }
}

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
  bool is_text = false;
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
    is_text = true;
    changed = widgets_.text(key.c_str(), next, (meaning + ": " + info.grammar).c_str());
  }
  if (const std::string fallback = default_of(key); !changed && fallback != text) {
    ImGui::SameLine();
    // The text of a setting may contain what separates a label from an id.
    if (widgets_.button(("\u21ba##" + key).c_str(),
                        ("as at first: " + (fallback.empty() ? "nothing" : fallback)).c_str())) {
      changed = true;
      next = fallback;
    }
  }
  if (!changed) return;
  if (std::string problem = session_.set(key, next); !problem.empty()) {
    if (is_text) widgets_.refuse(key.c_str(), next);
    error_ = std::move(problem);
  }
}

}  // namespace vpe::window
