#include "vpe/window/panels/search_box.h"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>

#include "mars/geodesy/place_text.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

bool has_digit(const std::string& text) {
  return std::ranges::any_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

void SearchBox::find() {
  found_.clear();
  fault_.clear();
  marked_ = 0;
  std::string fault;
  if (const auto place = mars::parse_place(text_, fault); place && has_digit(text_)) {
    const std::string name = mars::place_text(*place);
    found_.push_back({{name, place->lon_deg, place->lat_deg, 0}, "coordinates"});
  }
  for (const core::Place* place : places_.find(text_, kMostFound))
    found_.push_back({*place, place->diameter_m > 0 ? panel_length_text(place->diameter_m) : ""});
  if (!found_.empty() || text_.empty()) return;
  fault_ = has_digit(text_)           ? fault
           : places_.places().empty() ? "no names are known for this body; coordinates are understood"
                                      : "no such name; coordinates are understood too: 137.44 E 4.59 S";
}

bool SearchBox::completes() const {
  return is_open_ && !found_.empty() && found_[static_cast<std::size_t>(marked_)].place.name != text_;
}

// Up and down move the mark, and leave the text alone. Tab makes it the marked name.
int SearchBox::on_edit(ImGuiInputTextCallbackData* data) {
  auto& box = *static_cast<SearchBox*>(data->UserData);
  const int count = static_cast<int>(box.found_.size());
  if (count == 0) return 0;
  if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, box.found_[static_cast<std::size_t>(box.marked_)].place.name.c_str());
    return 0;
  }
  if (data->EventFlag != ImGuiInputTextFlags_CallbackHistory) return 0;
  box.marked_ = (box.marked_ + (data->EventKey == ImGuiKey_UpArrow ? count - 1 : 1)) % count;
  return 0;
}

std::optional<core::Place> SearchBox::draw(double width_px, Widgets& widgets) {
  std::optional<core::Place> chosen;
  // A window that appears takes the keyboard itself.
  if (takes_focus_ && !ImGui::IsWindowAppearing()) {
    takes_focus_ = false;
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(static_cast<float>(width_px));
  std::string typed = text_;
  // With nothing to complete, Tab goes on to the next widget.
  const ImGuiInputTextFlags completion = completes() ? ImGuiInputTextFlags_CallbackCompletion : 0;
  const bool entered =
      ImGui::InputTextWithHint("##search", "Search: a name or coordinates  ( / )", &typed,
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory |
                                   ImGuiInputTextFlags_AutoSelectAll | completion,
                               on_edit, this);
  widgets.record("search");
  const bool is_active = ImGui::IsItemActive();
  const bool is_left = ImGui::IsItemDeactivated();
  const ImVec2 corner{ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y};
  if (typed != text_) {
    text_ = typed;
    find();
    is_open_ = !text_.empty();
  }
  if (entered && !found_.empty()) {
    chosen = found_[static_cast<std::size_t>(marked_)].place;
    text_ = chosen->name;
    is_open_ = false;
  }
  if (ImGui::IsItemActivated() && !text_.empty()) is_open_ = true;
  // ImGui gives Tab to a field at its activation only, and else moves on to the next widget.
  constexpr ImU64 kTab = ImU64{1} << ImGuiKey_Tab;
  ImU64& keys = ImGui::GetCurrentContext()->ActiveIdUsingKeyInputMask;
  if (is_active) keys = completes() ? keys | kTab : keys & ~kTab;
  bool is_over_list = false;
  if (is_open_) {
    if (const auto clicked = draw_list(corner, width_px, widgets)) {
      chosen = clicked;
      text_ = chosen->name;
      is_open_ = false;
    }
    is_over_list = ImGui::IsMouseHoveringRect(corner, at(static_cast<double>(corner.x) + width_px, 1e6), false);
  }
  // A press on the list takes the keyboard from the field before it chooses.
  if (is_left && !entered && !(is_over_list && ImGui::IsMouseDown(ImGuiMouseButton_Left))) is_open_ = false;
  if (!is_active && is_open_ && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !is_over_list) is_open_ = false;
  return chosen;
}

std::optional<core::Place> SearchBox::draw_list(ImVec2 corner, double width_px, Widgets& widgets) {
  std::optional<core::Place> chosen;
  ImGui::SetNextWindowPos(corner);
  ImGui::SetNextWindowSize(at(width_px, 0));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyle().Colors[ImGuiCol_PopupBg]);
  ImGui::Begin("found", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
  for (std::size_t n = 0; n < found_.size(); ++n) {
    ImGui::PushID(static_cast<int>(n));
    if (ImGui::Selectable("##found", static_cast<int>(n) == marked_)) chosen = found_[n].place;
    widgets.record("found " + std::to_string(n));
    ImGui::SameLine(0, 0);
    ImGui::TextUnformatted(found_[n].place.name.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("%s", found_[n].detail.c_str());
    ImGui::PopID();
  }
  if (!fault_.empty()) coloured(kErrorColour, fault_);
  ImGui::End();
  ImGui::PopStyleColor();
  return chosen;
}

}  // namespace vpe::window
