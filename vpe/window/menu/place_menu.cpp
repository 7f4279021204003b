#include "vpe/window/menu/place_menu.h"

#include <imgui.h>

#include <utility>

#include "vpe/explore/results/path_results.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr const char* kPopup = "place menu";
constexpr float kMostWidth_letters = 30;  // of the lines, before they are wrapped

bool item(const char* label, const char* tip, Widgets& widgets, bool is_enabled = true) {
  const bool is_chosen = ImGui::MenuItem(label, nullptr, false, is_enabled);
  widgets.record(label);
  widgets.tip(tip);
  return is_chosen;
}

void draw_report(const std::vector<explore::ReadOutLine>& lines) {
  const float indent = ImGui::GetFontSize() * 5;
  for (const explore::ReadOutLine& line : lines) {
    ImGui::TextDisabled("%s", line.label.c_str());
    ImGui::SameLine(indent);
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * kMostWidth_letters);
    ImGui::TextUnformatted(line.text.c_str());
    ImGui::PopTextWrapPos();
  }
}

}  // namespace

void PlaceMenu::open(mars::LonLat place, const explore::PlaceReport& report, double reach_m) {
  place_ = place;
  lines_ = explore::place_lines(report);
  reach_m_ = reach_m;
  opens_ = true;
  closes_ = false;
  is_open_ = true;
}

bool PlaceMenu::close() {
  closes_ = is_open_;
  return closes_;
}

std::string PlaceMenu::text() const { return explore::text_of_lines(lines_); }

std::optional<PlaceChoice> PlaceMenu::draw(const PlaceOffer& offer, Widgets& widgets) {
  if (std::exchange(opens_, false)) ImGui::OpenPopup(kPopup);
  is_open_ = ImGui::BeginPopup(kPopup);
  if (!is_open_) return std::nullopt;
  std::optional<PlaceChoice> choice;
  widgets.group("menu");
  ImGui::TextUnformatted("What is here");
  ImGui::Separator();
  draw_report(lines_);
  const auto offers = [&](const char* label, PlaceChoice chosen, const char* tip, bool is_enabled = true) {
    if (item(label, tip, widgets, is_enabled)) choice = chosen;
  };
  offers("Copy", PlaceChoice::kCopy, "these lines as text");
  ImGui::Separator();
  offers("Measure from here", PlaceChoice::kMeasureFrom, "begins a new path with this point");
  offers("Profile to here", PlaceChoice::kProfileTo, ("from " + offer.profile_from).c_str());
  ImGui::Separator();
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
  widgets.number("Eye height (m)", height_m_, 0.01, kMostHeight_m, 0, "%.6g",
                 "above the ground, of viewshed and panorama");
  const bool can_make = offer.can_make && offer.why_not.empty();
  const std::string reach = explore::measured_length_text(reach_m_);
  offers("Viewshed from here", PlaceChoice::kViewshedFrom,
         ("a map (GeoTIFF) of the ground within " + reach + " that is seen from here").c_str(), can_make);
  offers("Panorama from here", PlaceChoice::kPanoramaFrom, "an image of all around, with what it shows",
         can_make);
  if (!offer.why_not.empty()) {
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * kMostWidth_letters);
    ImGui::TextDisabled("%s", offer.why_not.c_str());
    ImGui::PopTextWrapPos();
  }
  widgets.group("");
  if (choice || std::exchange(closes_, false)) {
    ImGui::CloseCurrentPopup();
    is_open_ = false;
  }
  ImGui::EndPopup();
  return choice;
}

}  // namespace vpe::window
