#include "vpe/window/panels/preferences_panel.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace vpe::window {

namespace {

// Draws the field of a key with its label. Returns the new value, or nullopt.
class Field {
 public:
  Field(const std::string& label, const core::KeyInfo& info, const core::KeyValue& value, Widgets& widgets)
      : label_(label.c_str()),
        tip_(std::string(info.name) + ": " + core::allowed_text(info)),
        value_(value),
        widgets_(widgets) {}

  std::optional<core::KeyValue> operator()(const core::NumberKey& key) const {
    auto number = std::get<double>(value_);
    const double step = std::abs(number) >= 10 ? 1.0 : 0.1;
    if (!widgets_.number(label_, number, key.min, key.max, step, "%.6g", tip_.c_str())) return std::nullopt;
    return number;
  }
  std::optional<core::KeyValue> operator()(const core::IntegerKey& key) const {
    double number = std::get<int>(value_);
    if (!widgets_.number(label_, number, key.min, key.max, 1, "%.0f", tip_.c_str())) return std::nullopt;
    return static_cast<int>(std::lround(number));
  }
  std::optional<core::KeyValue> operator()(const core::SwitchKey&) const {
    bool on = std::get<bool>(value_);
    if (!widgets_.check(label_, on, tip_.c_str())) return std::nullopt;
    return on;
  }
  std::optional<core::KeyValue> operator()(const core::ChoiceKey& key) const {
    std::vector<std::string> names;
    int index = 0;
    for (const core::KeyWord& word : key.words) {
      if (word.value == std::get<int>(value_)) index = static_cast<int>(names.size());
      names.emplace_back(word.text);
    }
    if (!widgets_.choose(label_, index, names, tip_.c_str())) return std::nullopt;
    return key.words[static_cast<std::size_t>(index)].value;
  }
  std::optional<core::KeyValue> operator()(const core::TextKey&) const {
    auto text = std::get<std::string>(value_);
    if (!widgets_.text(label_, text, tip_.c_str())) return std::nullopt;
    return text;
  }
  // Preferences have no keys of other types.
  template <class Other>
  std::optional<core::KeyValue> operator()(const Other&) const {
    return std::nullopt;
  }

 private:
  const char* label_;
  std::string tip_;
  const core::KeyValue& value_;
  Widgets& widgets_;
};

// Draws the field and the meaning of a key, and changes the value.
void draw_key(std::size_t key, const explore::Preferences& preferences, PreferencesActions& actions,
              Widgets& widgets) {
  const core::KeyRegistry<explore::Preferences>& keys = explore::preference_keys();
  const core::KeyInfo& info = keys.infos()[key];
  const core::KeyValue value = keys.get(key, preferences);
  const std::string label = "##" + std::string(info.name);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-1);
  const std::optional<core::KeyValue> next = std::visit(Field(label, info, value, widgets), info.type);
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextWrapped("%s", std::string(info.meaning).c_str());
  if (!next) return;
  std::string problem;
  const auto* text = std::get_if<core::TextKey>(&info.type);
  if (text != nullptr) problem = text->problem(std::get<std::string>(*next));
  if (!problem.empty() || !core::is_allowed(info, *next)) {
    if (text != nullptr) widgets.refuse(label.c_str(), std::get<std::string>(*next));
    actions.error = std::string(info.name) + ": " + (problem.empty() ? core::allowed_text(info) : problem);
    return;
  }
  actions.changed = preferences;
  keys.set(key, *actions.changed, *next);
}

}  // namespace

void draw_preference_rows(std::string_view prefix, const explore::Preferences& preferences,
                          PreferencesActions& actions, Widgets& widgets) {
  if (!ImGui::BeginTable("keys", 2)) return;
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFontSize() * 10);
  ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthStretch);
  const auto infos = explore::preference_keys().infos();
  for (std::size_t key = 0; key < infos.size(); ++key)
    if (infos[key].name.starts_with(prefix)) draw_key(key, preferences, actions, widgets);
  ImGui::EndTable();
}

PreferencesActions draw_preferences(const ViewArea& area, double scale, const explore::Preferences& preferences,
                                    Widgets& widgets) {
  PreferencesActions actions;
  const double width = std::min(area.width, 640 * scale);
  ImGui::SetNextWindowPos(
      at(area.x + (area.width - width) / 2, area.y + std::min(40 * scale, area.height / 8)));
  ImGui::SetNextWindowSize(at(width, area.height * 0.8));
  ImGui::Begin("preferences", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
  widgets.group("preferences");
  if (widgets.button("Close", "Esc")) actions.closes = true;
  ImGui::SameLine();
  if (widgets.button("As at first", "all preferences get their defaults"))
    actions.changed = explore::Preferences{};
  ImGui::Separator();
  begin_part("keys");
  draw_preference_rows("", preferences, actions, widgets);
  ImGui::EndChild();
  widgets.group("");
  ImGui::End();
  return actions;
}

}  // namespace vpe::window
