#include "vpe/window/reliefs/reliefs_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/base/number.h"
#include "vpe/window/reliefs/relief_marks.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

using explore::ReliefItem;
using explore::SharedRelief;
using relief::ReliefKind;
using relief::ReliefSpec;

namespace {

constexpr std::size_t kKinds = 8;
constexpr double kLeastSlide = 0.01;  // of sizes, in metres or degrees

const std::vector<std::string>& kind_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (std::size_t kind = 0; kind < kKinds; ++kind)
      names.emplace_back(relief::kind_word(static_cast<ReliefKind>(kind)));
    return names;
  }();
  return kNames;
}

// Returns the words of a key: "rim" of "rim_m", "floor ratio" of "floor_ratio".
std::string key_words(std::string_view name) {
  for (const std::string_view unit : {"_m", "_deg"})
    if (name.ends_with(unit)) name.remove_suffix(unit.size());
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

// Returns true for keys that are seldom changed by hand.
bool is_in_more(std::string_view name) {
  return name == "lon" || name == "lat" || name == "mode" || name == "spacing_m";
}

std::string key_label(const core::KeyInfo& info) {
  if (info.name == "lon") return "Longitude";
  if (info.name == "lat") return "Latitude";
  std::string label = key_words(info.name);
  label.front() = static_cast<char>(label.front() - 'a' + 'A');
  return info.unit.empty() ? label : label + " (" + std::string(info.unit) + ")";
}

// Returns the range of a slider about a value: three decades, within the limits.
std::pair<double, double> slider_range(double value, double least, double most) {
  const double low = std::pow(10.0, std::floor(std::log10(std::max(std::abs(value), kLeastSlide))) - 1);
  return {std::max(low, least), std::min(low * 1000, most)};
}

}  // namespace

ReliefsPanel::ReliefsPanel(std::shared_ptr<const paging::Surface> surface, std::filesystem::path folder,
                           const std::filesystem::path& state)
    : surface_(std::move(surface)),
      editor_(surface_->planet_radius_m()),
      folder_(std::move(folder)),
      copy_(state.empty() ? (folder_.empty() ? std::filesystem::path(".") : folder_) : state, ".relief.toml",
            "reliefs"),
      abandoned_(copy_.abandoned()) {}

void ReliefsPanel::report(const std::string& problem) {
  if (problem.empty()) return;
  actions_.message = problem;
  actions_.message_is_error = true;
}

void ReliefsPanel::tell(const std::string& text) {
  actions_.message = text;
  actions_.message_is_error = false;
}

bool ReliefsPanel::is_shown() const { return ImGui::GetFrameCount() - shown_frame_ <= 1; }

std::shared_ptr<const std::vector<ReliefSpec>> ReliefsPanel::reliefs() {
  if (reliefs_revision_ != editor_.revision()) {
    reliefs_revision_ = editor_.revision();
    reliefs_ =
        editor_.items().empty() ? nullptr : std::make_shared<const std::vector<ReliefSpec>>(editor_.reliefs());
  }
  return reliefs_;
}

void ReliefsPanel::draw(explore::Session& session, Widgets& widgets) {
  shown_frame_ = ImGui::GetFrameCount();
  if (!ImGui::IsAnyItemActive()) {
    ranges_.clear();
    slides_.clear();
  }
  begin_part("reliefs");
  draw_tools(widgets);
  draw_list(session, widgets);
  draw_selected(widgets);
  draw_files(session, widgets);
  ImGui::EndChild();
}

void ReliefsPanel::draw_tools(Widgets& widgets) {
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4);
  widgets.choose("Kind", kind_, kind_names(), "the relief that a click places");
  if (widgets.toggle("Place##relief", is_placing_,
                     "A click on the ground places a relief, V in the middle of the view; Esc ends it."))
    held_.reset();
  ImGui::SameLine();
  if (widgets.button("Undo##reliefs", ("Ctrl+Z: " + editor_.undo_text()).c_str())) editor_.undo();
  ImGui::SameLine();
  if (widgets.button("Redo##reliefs", ("Ctrl+Shift+Z: " + editor_.redo_text()).c_str())) editor_.redo();
  ImGui::SameLine();
  ImGui::BeginDisabled(editor_.find(selected_) == nullptr);
  if (widgets.button("Delete##relief", "Delete: the selected relief")) report(editor_.remove(selected_));
  ImGui::EndDisabled();
  if (is_placing_)
    draw_hint("Click on the ground to place it.");
  else if (!editor_.items().empty())
    draw_hint("Drag the middle of a relief to move it.");
  else
    draw_hint("Choose a kind, press Place, and click on the ground; or open a file below.");
}

void ReliefsPanel::draw_list(explore::Session& session, Widgets& widgets) {
  begin_part("relief list", ImVec2(0, ImGui::GetTextLineHeightWithSpacing() * 5), true);
  const explore::ReliefEditor::Items& all = editor_.items();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(all.size()));
  while (clipper.Step()) {
    for (int n = clipper.DisplayStart; n < clipper.DisplayEnd; ++n) {
      const ReliefItem& item = *all[static_cast<std::size_t>(n)];
      const std::string title = explore::relief_title(item.relief);
      ImGui::PushID(static_cast<int>(item.id));
      if (ImGui::Selectable(title.c_str(), item.id == selected_, ImGuiSelectableFlags_AllowDoubleClick)) {
        selected_ = item.id;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) session.go_to(item.relief.place);
      }
      widgets.record("relief " + title);
      const std::string kind(relief::kind_word(item.relief.kind));
      ImGui::SameLine();
      ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(),
                                    ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(kind.c_str()).x));
      ImGui::TextDisabled("%s", kind.c_str());
      ImGui::PopID();
    }
  }
  ImGui::EndChild();
}

void ReliefsPanel::draw_selected(Widgets& widgets) {
  const SharedRelief item = editor_.find(selected_);
  if (item == nullptr) return;
  ImGui::PushID(static_cast<int>(item->id));
  widgets.group("relief");
  const float label_px = ImGui::GetFontSize() * 8;
  ImGui::PushItemWidth(std::max(ImGui::GetFontSize() * 6, ImGui::GetContentRegionAvail().x - label_px));
  ReliefSpec changed = item->relief;
  std::string what;
  const auto draw_keys = [&](bool is_more) {
    const auto& keys = relief::relief_keys();
    for (std::size_t key = 0; key < keys.infos().size(); ++key) {
      const std::string_view name = keys.infos()[key].name;
      if (name == "kind" || !relief::has_key(changed.kind, key) || is_in_more(name) != is_more) continue;
      const bool adds = changed.mode.value_or(relief::usual_mode(changed.kind)) == relief::Mode::kAdd;
      if (adds && (name == "level_m" || name == "rise_m")) continue;
      if (draw_key(changed, key, widgets)) what = "change the " + key_words(name) + " of";
    }
  };
  draw_keys(false);
  if (widgets.header("More", false)) draw_keys(true);
  ImGui::PopItemWidth();
  if (widgets.button("Earlier", "it changes the ground before the relief above it in the list"))
    report(editor_.shift(item->id, false));
  ImGui::SameLine();
  if (widgets.button("Later", "it changes the ground after the relief below it in the list"))
    report(editor_.shift(item->id, true));
  widgets.group("");
  ImGui::PopID();
  if (what.empty()) return;
  report(editor_.replace(item->id, std::move(changed), what, slides_ == what));
  slides_ = ImGui::IsAnyItemActive() ? what : "";
}

// Draws a slider of a size. Returns true if it changed the size.
bool ReliefsPanel::draw_size(const std::string& label, std::size_t key, double& size, Widgets& widgets) {
  const core::KeyInfo& info = relief::relief_keys().infos()[key];
  const auto& limits = std::get<core::NumberOrWordKey>(info.type);
  const auto range = ranges_.try_emplace(key, slider_range(size, limits.min, limits.max)).first->second;
  return widgets.slide(label.c_str(), size, range.first, range.second, std::abs(size) < 100 ? "%.3g" : "%.0f",
                       true, (std::string(info.meaning) + "; Ctrl and a click: type it").c_str());
}

// Draws the value of a key. Returns true if it was changed.
bool ReliefsPanel::draw_key(ReliefSpec& relief, std::size_t key, Widgets& widgets) {
  const auto& keys = relief::relief_keys();
  const core::KeyInfo& info = keys.infos()[key];
  const core::KeyValue value = keys.get(key, relief);
  const std::string label = key_label(info);
  const std::string meaning(info.meaning);
  if (const auto* number = std::get_if<double>(&value)) {
    const auto& limits = std::get<core::NumberKey>(info.type);
    double next = *number;
    const bool is_share = limits.min == 0 && limits.max == 1;
    const bool has_changed =
        is_share ? widgets.slide(label.c_str(), next, 0, 1, "%.2f", false, meaning.c_str())
                 : widgets.number(label.c_str(), next, limits.min, limits.max, info.unit == "deg" ? 1e-3 : 1,
                                  info.name == "lon" || info.name == "lat" ? "%.6f" : "%.6g", meaning.c_str());
    if (has_changed) keys.set(key, relief, next);
    return has_changed;
  }
  if (const auto* size = std::get_if<core::NumberOrWord>(&value); size != nullptr && size->number) {
    double next = *size->number;
    const bool may_be_auto = !relief::needs_key(relief.kind, key);
    bool has_changed = draw_size(label, key, next, widgets);
    if (has_changed) keys.set(key, relief, core::NumberOrWord(next));
    if (may_be_auto) {
      ImGui::SameLine();
      if (widgets.button(("x##" + label).c_str(), "as it follows from the other sizes")) {
        keys.set(key, relief, core::NumberOrWord());
        has_changed = true;
      }
    }
    return has_changed;
  }
  if (const auto* whole = std::get_if<int>(&value)) {
    if (const auto* choice = std::get_if<core::ChoiceKey>(&info.type)) {
      std::vector<std::string> words;
      int index = 0;
      for (const core::KeyWord& word : choice->words) {
        if (word.value == *whole) index = static_cast<int>(words.size());
        words.emplace_back(word.text);
      }
      if (!widgets.choose(label.c_str(), index, words, meaning.c_str())) return false;
      keys.set(key, relief, choice->words[static_cast<std::size_t>(index)].value);
      return true;
    }
    const auto& limits = std::get<core::IntegerKey>(info.type);
    double next = *whole;
    if (!widgets.number(label.c_str(), next, limits.min, limits.max, 1, "%.0f", meaning.c_str())) return false;
    keys.set(key, relief, static_cast<int>(std::lround(next)));
    return true;
  }
  // A text, or a size that follows from the others until a number is typed.
  const bool is_auto = std::holds_alternative<core::NumberOrWord>(value);
  const std::string shown = is_auto ? "" : core::print_value(info, value);
  std::string typed = shown;
  if (!widgets.text(label.c_str(), typed, meaning.c_str(), is_auto ? "auto" : "") || typed == shown)
    return false;
  const std::string problem = relief::set_key(relief, key, typed);
  if (!problem.empty()) widgets.refuse(label.c_str(), typed);
  report(problem);
  return problem.empty();
}

void ReliefsPanel::draw_files(const explore::Session& session, Widgets& widgets) {
  ImGui::Separator();
  ImGui::SetNextItemWidth(-1);
  widgets.text("##relief file", file_, "file of reliefs to write or to open; ~/ is the home folder",
               "new.relief.toml");
  if (widgets.button("Save##reliefs", "Ctrl+S: writes the reliefs to this file")) save();
  ImGui::SameLine();
  if (widgets.button("Open##reliefs", "reads the reliefs of this file")) open(typed_file());
  ImGui::SameLine();
  if (widgets.button("Close##reliefs", "shows the planet without reliefs")) open({});
  if (editor_.is_changed()) {
    ImGui::SameLine();
    ImGui::TextDisabled("not saved");
  }
  const bool can_restore = !editor_.is_changed() && !abandoned_.empty();
  if (can_restore &&
      widgets.button("Restore##reliefs", ("open the unsaved reliefs " + abandoned_.front().string()).c_str()))
    restore(std::filesystem::path(abandoned_.front()));
  ImGui::BeginDisabled(editor_.items().empty());
  if (widgets.button("Save as a flight",
                     "writes a flight in which the reliefs form: the one that is open, or "
                     "one in which the camera stays here"))
    save_flight(session);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 7);
  widgets.number("in seconds##forming", forming_s_, 0.1, 1e5, 1, "%.4g", "how long the reliefs take to form");
  if (widgets.button("Put into a planet", "saves the reliefs, and makes a planet file with them by vpe patch"))
    patch();
  ImGui::EndDisabled();
}

void ReliefsPanel::draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye) {
  if (!is_shown()) return;
  const GroundView ground(session, eye.view);
  const auto& items = editor_.items();
  const std::size_t shown = std::min(items.size(), ReliefsPanelLimits::kMostMarks);
  for (std::size_t n = 0; n < shown; ++n) {
    const bool is_chosen = items[n]->id == selected_;
    if (!is_chosen) draw_relief_mark(list, ground, eye, items[n]->relief, false);
  }
  if (const SharedRelief chosen = editor_.find(selected_); chosen != nullptr)
    draw_relief_mark(list, ground, eye, chosen->relief, true);
}

}  // namespace vpe::window
