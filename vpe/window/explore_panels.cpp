// The panels of the explore window.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "lod/tree/posts.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/explore/input/keyboard.h"
#include "vpe/explore/steer.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/panel_words.h"
#include "vpe/window/screen_point.h"
#include "vpe/window/words.h"

namespace vpe::window {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

template <class... Args>
std::string print(const char* format, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

// One line; what does not fit into it is told where it is pointed at.
void status_line(const std::string& words, const ImVec4& colour) {
  std::string first = words;
  std::ranges::replace(first, '\n', ' ');
  ImGui::TextColored(colour, "%s", first.c_str());
  if (ImGui::IsItemHovered() && ImGui::GetItemRectSize().x > ImGui::GetContentRegionAvail().x)
    ImGui::SetTooltip("%s", words.c_str());
}

}  // namespace

void ExploreWindow::draw_side() {
  int width = 0;
  int height = 0;
  display_.framebuffer(width, height);
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(at(view_area_.x, height));
  ImGui::Begin("side", nullptr, kFixed);
  const double inside = static_cast<double>(ImGui::GetContentRegionAvail().x);
  if (!state_.large_map) draw_map(static_cast<int>(inside), static_cast<int>(std::round(inside * 0.5)));
  bool image = state_.map_ground == explore::MapGround::kImage;
  if (widgets_.check("Imagery", image))
    state_.map_ground = image ? explore::MapGround::kImage : explore::MapGround::kRelief;
  ImGui::SameLine();
  widgets_.toggle("Large map", state_.large_map, "Tab");
  ImGui::SameLine();
  if (widgets_.button("Planet", "Home: the whole planet")) session_.show_planet();
  ImGui::SameLine();
  if (widgets_.button("Help", "F1")) state_.help = !state_.help;
  ImGui::Separator();
  if (ImGui::BeginTabBar("tabs")) {
    if (widgets_.tab("Control")) {
      control_panel();
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Flight")) {
      flight_panel();
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Measure")) {
      measure_panel();
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Appearance")) {
      appearance_panel();
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Detail")) {
      detail_panel();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void ExploreWindow::measure_panel() {
  ImGui::BeginChild("measure");
  const MeasureActions wish = measure_.draw(session_, under_cursor_, widgets_);
  if (wish.go_to) session_.go_to(*wish.go_to);
  if (!wish.message.empty()) say(wish.message, wish.message_is_trouble);
  ImGui::EndChild();
}

void ExploreWindow::draw_map(int width, int height) {
  const MapActions wish =
      map_.draw(session_, state_.map_ground, measure_.points(), guide_.hotspots(), width, height, widgets_);
  if (wish.under_cursor) under_cursor_ = wish.under_cursor;
  if (guide_.inside() != nullptr) {
    if (wish.go_to || wish.new_waypoint || wish.new_region || wish.drag)
      say("Esc steps out of the panorama first", true);
    return;
  }
  if (wish.go_to) session_.go_to(*wish.go_to);
  if (wish.new_region) {
    std::vector<core::InterestRegion> regions(session_.interest().begin(), session_.interest().end());
    regions.push_back(*wish.new_region);
    session_.set_interest(std::move(regions));
  }
  std::string trouble;
  if (wish.new_waypoint) {
    // As high above the ground there as the camera is here.
    mars::Pose pose = session_.pose();
    pose.lon_deg = wish.new_waypoint->lon_deg;
    pose.lat_deg = wish.new_waypoint->lat_deg;
    pose.alt_m = session_.ground().height_m(mars::direction(*wish.new_waypoint)) + session_.height_m();
    trouble = session_.flights().add(pose, state_.ground_speed_m_s);
  }
  if (explore::FlightEditor* editor = session_.flights().editor(); wish.drag && editor != nullptr)
    trouble = editor->move(wish.drag->waypoint, wish.drag->to, wish.drag->goes_on);
  if (!trouble.empty()) say(trouble, true);
}

// In the place of the view.
void ExploreWindow::draw_large_map() {
  ImGui::SetNextWindowPos(at(view_area_.x, view_area_.y));
  ImGui::SetNextWindowSize(at(view_area_.width, view_area_.height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(0, 0));
  ImGui::Begin("large map", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
  draw_map(static_cast<int>(view_area_.width), static_cast<int>(view_area_.height));
  ImGui::End();
  ImGui::PopStyleVar();
}

void ExploreWindow::control_panel() {
  ImGui::BeginChild("control");
  ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
  mars::Pose pose = session_.pose();
  bool changed = widgets_.number("Longitude", pose.lon_deg, -360, 360, 0.1, "%.6f");
  changed |= widgets_.number("Latitude", pose.lat_deg, -90, 90, 0.1, "%.6f");
  changed |= widgets_.number("Altitude (m)", pose.alt_m, -1e5, 1e9, 100, "%.2f", "above the sphere");
  double height = session_.height_m();
  if (widgets_.number("Height (m)", height, explore::SteerLimits::kClearance_m, 1e9, 100, "%.2f",
                      "above the ground")) {
    pose.alt_m += height - session_.height_m();
    changed = true;
  }
  changed |= widgets_.number("Heading", pose.yaw_deg, -360, 360, 5, "%.3f", "degrees clockwise from north");
  changed |= widgets_.number("Pitch", pose.pitch_deg, -90, 90, 5, "%.3f", "degrees up");
  changed |= widgets_.number("Roll", pose.roll_deg, -180, 180, 5, "%.3f", "degrees, right wing down");
  if (changed) session_.put(pose);
  double fov = session_.screen().fov_deg;
  if (widgets_.slide("Field of view", fov, 5, 120, "%.1f°", true)) session_.set_fov(fov);
  widgets_.slide("Speed", state_.speed, 0.05, 20, "%.2f x", true,
                 "of moving with keys and sticks; it also goes with the height");
  ImGui::PopItemWidth();
  if (widgets_.button("North up", "N")) session_.north_up();
  ImGui::SameLine();
  if (widgets_.button("Level", "G: no roll")) session_.level();
  ImGui::SameLine();
  if (widgets_.button("Look down", "U")) session_.look_down(false);
  ImGui::Separator();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Drawn by");
  ImGui::SameLine();
  bool polygons = state_.backend == Backend::kPolygons;
  if (widgets_.toggle("Triangles", polygons)) state_.backend = Backend::kPolygons;
  ImGui::SameLine();
  bool rays = state_.backend == Backend::kRays;
  if (widgets_.toggle("Rays", rays)) state_.backend = Backend::kRays;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Eyes");
  ImGui::SameLine();
  static const std::array<std::string, 4> kEyes{"one", "side by side", "over and under", "red and cyan"};
  int eyes = state_.stereo ? 1 + static_cast<int>(*state_.stereo) : 0;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
  if (widgets_.choose("##eyes", eyes, kEyes)) {
    state_.stereo = eyes == 0 ? std::nullopt : std::optional(static_cast<core::StereoLayout>(eyes - 1));
  }
  if (state_.stereo) {
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
    widgets_.number("Eyes apart (m)", state_.eye_base_m, 0, 1e6, 1, "%.3g",
                    "0: a thirtieth of the height above ground");
  }
  ImGui::EndChild();
}

void ExploreWindow::draw_status() {
  int width = 0;
  int height = 0;
  display_.framebuffer(width, height);
  ImGui::SetNextWindowPos(at(view_area_.x, view_area_.height));
  ImGui::SetNextWindowSize(at(view_area_.width, height - view_area_.height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(8 * display_.scale(), 5 * display_.scale()));
  ImGui::Begin("status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
  const mars::Pose& pose = session_.pose();
  const bool from_zero = setup_.preferences.longitude == explore::LongitudeRange::kPositive;
  const double lon_deg = from_zero && pose.lon_deg < 0 ? pose.lon_deg + 360 : pose.lon_deg;
  std::string place =
      print("%.5f°, %.5f°   altitude %s, %s above ground   heading %.1f°  pitch %.1f°  roll %.1f°", lon_deg,
            pose.lat_deg, metres(pose.alt_m).c_str(), metres(session_.height_m()).c_str(),
            pose.yaw_deg < 0 ? pose.yaw_deg + 360 : pose.yaw_deg, pose.pitch_deg, pose.roll_deg);
  if (const OverlookView* inside = guide_.inside(); inside != nullptr)
    place = guide_.inside_hotspot()->name + print("   azimuth %.2f°  elevation %.2f°  field of view %.1f°",
                                                  std::fmod(inside->viewer().yaw_deg() + 720.0, 360.0),
                                                  inside->viewer().pitch_deg(), inside->viewer().fov_deg());
  status_line(place, ImGui::GetStyleColorVec4(ImGuiCol_Text));
  if (!state_.message.empty()) {
    status_line(state_.message, state_.message_is_trouble ? kTrouble : kGood);
  } else if (guide_.inside() == nullptr && drawn_) {
    const core::DrawResult& r = drawn_->result;
    const bool rays = drawn_->order.backend == Backend::kRays;
    double mean_s = 0;
    for (const double s : frame_times_s_) mean_s += s / static_cast<double>(frame_times_s_.size());
    int finest = 0;
    for (std::size_t n = 0; n < r.stats.tiles_by_level.size(); ++n)
      if (r.stats.tiles_by_level[n] > 0) finest = static_cast<int>(n);
    const double spacing_m =
        lod::post_spacing_m(finest, setup_.planet->meta().tile.intervals(), setup_.planet->radius_m());
    std::string line = session_.settings().get("mode").value_or("") + (rays ? " by rays" : " by triangles") +
                       "   level " + std::to_string(core::shown_level(finest)) + " (" + metres(spacing_m) +
                       " posts)   within " + print("%.2f px", r.certificate.shift_bound_px);
    const core::View& drawn = drawn_->order.request.view;
    line += "   " + (rays ? print("%.0f k rays", drawn.width * drawn.height / 1e3)
                          : print("%.0f k triangles", static_cast<double>(r.stats.triangles) / 1e3));
    line += "   " + print("%.0f MB", static_cast<double>(r.stats.bytes_resident) / 1e6) + "   " +
            print("%.0f ms", mean_s * 1e3);
    const std::int64_t loading = r.stats.pages_wanted + r.stats.pages_loading;
    if (loading > 0 && !r.settled) line += "   loading " + std::to_string(loading);
    if (drawn_->order.request.coarsening > 1) line += "   coarser while moving";
    status_line(line, ImGui::GetStyleColorVec4(ImGuiCol_Text));
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void ExploreWindow::draw_help() {
  static const char* kMouse[][2] = {
      {"left drag", "hold the ground and move it; in a flight: look around"},
      {"wheel", "nearer to what is under the cursor, and away"},
      {"right or middle drag, Shift + left drag", "tilt, and turn about the middle"},
      {"double click", "fly there"},
      {"on the map", "click: go there; Ctrl + click: waypoint; Shift + drag: region of interest"},
  };
  ImGui::SetNextWindowPos(at(view_area_.x + view_area_.width / 2, view_area_.height / 2), ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints(at(0, 0), at(view_area_.width, view_area_.height));
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoTitleBar);
  const auto row = [](const char* what, const char* does) {
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", what);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(does);
  };
  if (ImGui::BeginTable("mouse", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& line : kMouse) row(line[0], line[1]);
    ImGui::EndTable();
  }
  ImGui::Separator();
  if (ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit)) {
    const std::vector<explore::HelpLine> lines = explore::keyboard_help();
    const std::size_t half = (lines.size() + 1) / 2;
    for (std::size_t n = 0; n < half; ++n) {
      row(lines[n].keys.c_str(), lines[n].meaning.c_str());
      if (n + half < lines.size()) row(lines[n + half].keys.c_str(), lines[n + half].meaning.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace vpe::window
