// Drawing of an overlook view: its image, and the compass strip.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "vpe/window/overlook_view.h"

namespace vpe::window {

namespace {

constexpr ImU32 kBand = IM_COL32(0, 0, 0, 120);
constexpr ImU32 kInk = IM_COL32(255, 255, 255, 235);
constexpr ImU32 kWindInk = IM_COL32(255, 190, 130, 255);
constexpr double kWidest_em = 4.2;  // width of a label with decimals, and of the space beside it

// Returns an azimuth as "90°". Replaces the names of winds if north is not known.
std::string azimuth_text(double azimuth_deg) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g°", azimuth_deg - 360.0 * std::floor(azimuth_deg / 360.0));
  return text;
}

}  // namespace

void OverlookView::draw() {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(at(area_.x, area_.y), at(area_.x + area_.width, area_.y + area_.height));
  const glm::ivec2 eye = eye_size();
  const int across = stereo_ == core::StereoLayout::kSideBySide ? 2 : 1;
  const int down = stereo_ == core::StereoLayout::kOverUnder ? 2 : 1;
  if (drawn_) {
    list.AddImage(texture_.id(), at(area_.x, area_.y), at(area_.x + eye.x * across, area_.y + eye.y * down));
    for (int right = 0; right < across; ++right) {
      for (int below = 0; below < down; ++below) draw_strip({area_.x + right * eye.x, area_.y + below * eye.y});
    }
  } else if (shown_copying_ >= 0) {
    draw_message(list, area_,
                 formatted("copying %s once, in tiles: %.0f %%", setup_.panorama.image.filename().c_str(),
                           100 * shown_copying_));
  } else if (message_is_error_) {
    draw_message(list, area_, message_);
  }
  list.PopClipRect();
}

void OverlookView::draw_strip(const glm::dvec2& corner) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto letters = static_cast<double>(ImGui::GetFontSize());
  const double height = std::round(letters * 1.9);
  const double tick = std::round(letters * 0.55);
  const double thick = std::max(1.0, std::round(letters / 14));
  const glm::ivec2 size = viewer_.size();
  // The strip belongs to the image that is shown, which may be older than the viewer's direction.
  core::View view = drawn_->request.draw.view;
  view.width = size.x;
  view.height = size.y;
  marks_ = overlay::compass_row(view, panorama::kViewerFrame, kWidest_em * letters);
  if (marks_.empty()) return;
  list.AddRectFilled(at(corner.x, corner.y), at(corner.x + size.x, corner.y + height), kBand);
  for (overlay::PlacedMark& placed : marks_) {
    overlay::CompassMark& mark = placed.mark;
    const bool is_wind = mark.rank == overlay::CompassRank::kWind;
    if (is_wind && !setup_.panorama.heading_is_known) mark.label = azimuth_text(mark.azimuth_deg);
    const ImU32 ink = is_wind && setup_.panorama.heading_is_known ? kWindInk : kInk;
    const double x = corner.x + placed.at.x;
    const double length = mark.rank == overlay::CompassRank::kTick ? 0.55 * tick : tick;
    list.AddRectFilled(at(x - thick / 2, corner.y), at(x + thick / 2, corner.y + length), ink);
    if (mark.label.empty()) continue;
    const auto width = static_cast<double>(ImGui::CalcTextSize(mark.label.c_str()).x);
    // A label cut by the edge could be misread.
    if (placed.at.x < width / 2 || placed.at.x > size.x - width / 2) continue;
    list.AddText(at(std::round(x - width / 2), corner.y + tick + std::round(letters * 0.1)), ink,
                 mark.label.c_str());
  }
}

}  // namespace vpe::window
