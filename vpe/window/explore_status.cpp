// The status line of the explore window.
#include <algorithm>
#include <cmath>
#include <string>

#include "lod/tree/posts.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

void ExploreWindow::draw_status() {
  ImGui::SetNextWindowPos(at(layout_.status.x, layout_.status.y));
  ImGui::SetNextWindowSize(at(layout_.status.width, layout_.status.height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(8 * display_.scale(), 5 * display_.scale()));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, at(1, 1));
  ImGui::Begin("status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
  const explore::LongitudeRange range = setup_.preferences.longitude;
  std::string camera = camera_text(session_, range);
  std::string short_camera = hemisphere_text({session_.pose().lon_deg, session_.pose().lat_deg}, range);
  QualityText quality;
  if (const OverlookView* inside = guide_.inside(); inside != nullptr) {
    camera = guide_.inside_hotspot()->name +
             formatted("   azimuth %.2f\u00b0  elevation %.2f\u00b0  field of view %.1f\u00b0",
                       std::fmod(inside->viewer().yaw_deg() + 720.0, 360.0), inside->viewer().pitch_deg(),
                       inside->viewer().fov_deg());
    short_camera = camera;
    cursor_text_.clear();
  } else if (drawn_) {
    quality = quality_of_image();
  }
  if (under_cursor_) {
    try {
      cursor_text_ = "cursor  " + cursor_text(explore::read_out_at(session_.surface(), *under_cursor_), range);
    } catch (const std::exception& e) {
      cursor_text_ = std::string("cursor  ") + e.what();
    }
  } else if (!ImGui::GetIO().WantCaptureMouse) {
    cursor_text_.clear();
  }
  // From the right: the word on the image, the camera, and in what is left the cursor.
  const double gap = 2.0 * static_cast<double>(ImGui::GetFontSize());
  const double whole = static_cast<double>(ImGui::GetContentRegionMax().x);
  const auto width_of = [](const std::string& text) {
    return static_cast<double>(ImGui::CalcTextSize(text.c_str()).x);
  };
  const double quality_x = whole - std::max(width_of(quality.word), width_of("coarser while moving"));
  if (quality_x - gap - width_of(camera) - width_of(cursor_text_) < gap) camera = short_camera;
  const double camera_x = std::max(quality_x - gap - width_of(camera), gap);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect(corner, at(static_cast<double>(ImGui::GetWindowPos().x) + camera_x - gap / 2, 1e6), true);
  ImGui::TextUnformatted(fitting_parts(cursor_text_, camera_x - gap, width_of).c_str());
  widgets_.record("cursor line");
  ImGui::PopClipRect();
  ImGui::SameLine(static_cast<float>(camera_x));
  ImGui::PushClipRect(corner, at(static_cast<double>(ImGui::GetWindowPos().x) + quality_x - gap / 2, 1e6),
                      true);
  ImGui::TextUnformatted(camera.c_str());
  ImGui::PopClipRect();
  ImGui::SameLine(static_cast<float>(quality_x));
  ImGui::TextUnformatted(quality.word.c_str());
  widgets_.record("quality");
  widgets_.tip(quality.details.c_str());
  ImGui::End();
  ImGui::PopStyleVar(2);
}

QualityText ExploreWindow::quality_of_image() const {
  const core::DrawResult& r = drawn_->result;
  double mean_s = 0;
  for (const double s : image_times_s_) mean_s += s / static_cast<double>(image_times_s_.size());
  int finest = 0;
  for (std::size_t n = 0; n < r.stats.tiles_by_level.size(); ++n)
    if (r.stats.tiles_by_level[n] > 0) finest = static_cast<int>(n);
  const double spacing_m =
      lod::post_spacing_m(finest, setup_.planet->meta().tile.intervals(), setup_.planet->radius_m());
  return quality_text(*drawn_, session_.settings().get("mode").value_or(""), finest, spacing_m, mean_s);
}

}  // namespace vpe::window
