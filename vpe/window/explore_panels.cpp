// The frames of the explore window: panels, status line, help.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "lod/tree/posts.h"
#include "vpe/explore/input/keyboard.h"
#include "vpe/explore/steer.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/settings_panels.h"

namespace vpe::window {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

// Draws one line. Text that is too long is shown as a tooltip too.
void status_line(const std::string& text, const ImVec4& colour) {
  std::string first = text;
  std::ranges::replace(first, '\n', ' ');
  ImGui::TextColored(colour, "%s", first.c_str());
  if (ImGui::IsItemHovered() && ImGui::GetItemRectSize().x > ImGui::GetContentRegionAvail().x)
    ImGui::SetTooltip("%s", text.c_str());
}

void draw_control_panel(explore::Session& session, WindowState& state, Widgets& widgets) {
  ImGui::BeginChild("control");
  ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
  mars::Pose pose = session.pose();
  bool changed = widgets.number("Longitude", pose.lon_deg, -360, 360, 0.1, "%.6f");
  changed |= widgets.number("Latitude", pose.lat_deg, -90, 90, 0.1, "%.6f");
  changed |= widgets.number("Altitude (m)", pose.alt_m, -1e5, 1e9, 100, "%.2f", "above the sphere");
  double height = session.height_m();
  if (widgets.number("Height (m)", height, explore::SteerLimits::kClearance_m, 1e9, 100, "%.2f",
                     "above the ground")) {
    pose.alt_m += height - session.height_m();
    changed = true;
  }
  changed |= widgets.number("Heading", pose.yaw_deg, -360, 360, 5, "%.3f", "degrees clockwise from north");
  changed |= widgets.number("Pitch", pose.pitch_deg, -90, 90, 5, "%.3f", "degrees up");
  changed |= widgets.number("Roll", pose.roll_deg, -180, 180, 5, "%.3f", "degrees, right wing down");
  if (changed) session.put(pose);
  double fov = session.screen().fov_deg;
  if (widgets.slide("Field of view", fov, 5, 120, "%.1f°", true)) session.set_fov(fov);
  widgets.slide("Speed", state.speed, 0.05, 20, "%.2f x", true,
                "factor on the speed of keys and sticks, which also grows with the height");
  ImGui::PopItemWidth();
  if (widgets.button("North up", "N")) session.north_up();
  ImGui::SameLine();
  if (widgets.button("Level", "G: no roll")) session.level();
  ImGui::SameLine();
  if (widgets.button("Look down", "U")) session.look_down(false);
  ImGui::Separator();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Drawn by");
  ImGui::SameLine();
  const auto choice = [&](const char* label, core::DrawnBy drawn_by, const char* help) {
    ImGui::SameLine();
    bool is_chosen = state.drawn_by == drawn_by;
    if (widgets.toggle(label, is_chosen, help)) state.drawn_by = drawn_by;
  };
  choice("Auto", core::DrawnBy::kAuto, "The quicker of both: rays near the ground where there is no GPU");
  choice("Triangles", core::DrawnBy::kPolygon, "By OpenGL");
  choice("Rays", core::DrawnBy::kRay, "By ray casting on the processor");
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Stereo");
  ImGui::SameLine();
  static const std::array<std::string, 4> kEyes{"off", "side by side", "over and under", "red and cyan"};
  int eyes = state.stereo ? 1 + static_cast<int>(*state.stereo) : 0;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
  if (widgets.choose("##eyes", eyes, kEyes)) {
    state.stereo = eyes == 0 ? std::nullopt : std::optional(static_cast<core::StereoLayout>(eyes - 1));
  }
  if (state.stereo) {
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
    widgets.number("Eye distance (m)", state.eye_base_m, 0, 1e6, 1, "%.3g",
                   "0: a thirtieth of the height above ground");
  }
  ImGui::EndChild();
}

void draw_explore_help(const ViewArea& area) {
  static constexpr const char* kMouse[][2] = {
      {"left drag", "move the ground with the cursor; in a flight: look around"},
      {"wheel", "zoom to the ground under the cursor; in a flight: field of view"},
      {"right or middle drag, Shift + left drag", "tilt and rotate about the middle of the view"},
      {"double click", "fly there"},
      {"on the map", "click: fly there; Ctrl + click: add a waypoint; Shift + drag: add a region of interest"},
  };
  ImGui::SetNextWindowPos(at(area.x + area.width / 2, area.height / 2), ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints(at(0, 0), at(area.width, area.height));
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

// Draws a message over the lower left of a view whose panels are hidden.
void draw_note(const ViewArea& area, const std::string& text, bool is_error, double scale) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const double margin = 10 * scale;
  const double most = std::max(40.0, area.width - 4 * margin);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, static_cast<float>(most));
  const double top = area.y + area.height - margin - static_cast<double>(size.y);
  list.AddRectFilled(at(area.x + margin, top - margin),
                     at(area.x + 3 * margin + static_cast<double>(size.x), top + static_cast<double>(size.y)),
                     IM_COL32(0, 0, 0, 170), 4);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at(area.x + 2 * margin, top - margin / 2),
               ImGui::ColorConvertFloat4ToU32(is_error ? kErrorColour : kSuccessColour), text.c_str(), nullptr,
               static_cast<float>(most));
}

// Draws a red dot at the upper right of the view while the session is recorded.
void draw_recording_sign(const ViewArea& area, double scale) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const double radius = 6 * scale;
  const ImVec2 middle = at(area.x + area.width - 3 * radius, area.y + 3 * radius);
  list.AddCircleFilled(middle, static_cast<float>(radius * 1.35), IM_COL32(0, 0, 0, 150));
  list.AddCircleFilled(middle, static_cast<float>(radius), IM_COL32(235, 40, 30, 255));
}

}  // namespace

void ExploreWindow::draw_frame() {
  display_.begin_frame();
  widgets_.begin_frame();
  find_cursor();
  if (state_.large_map) {
    ImGui::SetNextWindowPos(at(view_area_.x, view_area_.y));
    ImGui::SetNextWindowSize(at(view_area_.width, view_area_.height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(0, 0));
    ImGui::Begin("large map", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
    draw_map(static_cast<int>(view_area_.width), static_cast<int>(view_area_.height));
    ImGui::End();
    ImGui::PopStyleVar();
  } else if (guide_.inside() != nullptr) {
    guide_.inside()->draw();
  } else {
    draw_view();
  }
  if (state_.panels) {
    draw_side();
    draw_status();
  } else if (!state_.message.empty()) {
    draw_note(view_area_, state_.message, state_.message_is_error, display_.scale());
  }
  if (recorder_.is_recording()) draw_recording_sign(view_area_, display_.scale());
  if (state_.help) draw_explore_help(view_area_);
  display_.end_frame(std::exchange(capture_, nullptr));
  if (Display::has_input_left()) frames_due_ = std::max(frames_due_, kFramesAfterChange);
  ++frames_;
}

void ExploreWindow::draw_side() {
  int width = 0;
  int height = 0;
  display_.framebuffer(width, height);
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(at(view_area_.x, height));
  ImGui::Begin("side", nullptr, kFixed);
  const double inside = static_cast<double>(ImGui::GetContentRegionAvail().x);
  if (!state_.large_map) draw_map(static_cast<int>(inside), static_cast<int>(std::round(inside * 0.5)));
  bool imagery = state_.map_style == explore::MapStyle::kImagery;
  if (widgets_.check("Imagery", imagery))
    state_.map_style = imagery ? explore::MapStyle::kImagery : explore::MapStyle::kElevation;
  ImGui::SameLine();
  widgets_.toggle("Large map", state_.large_map, "Tab");
  ImGui::SameLine();
  if (widgets_.button("Planet", "Home: the whole planet")) session_.show_planet();
  ImGui::SameLine();
  if (widgets_.button("Help", "F1")) state_.help = !state_.help;
  ImGui::Separator();
  if (ImGui::BeginTabBar("tabs")) {
    if (widgets_.tab("Control")) {
      draw_control_panel(session_, state_, widgets_);
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Flight")) {
      const FlightActions actions = flight_.draw(session_, recorder_.is_recording(), widgets_);
      if (actions.record) set_recording(*actions.record);
      if (actions.restore) restore_flight(*actions.restore);
      if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Measure")) {
      ImGui::BeginChild("measure");
      const MeasureActions actions = measure_.draw(session_, under_cursor_, widgets_);
      if (actions.go_to) session_.go_to(*actions.go_to);
      if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Appearance")) {
      if (const std::string error = draw_appearance_panel(session_, drawn(), widgets_); !error.empty())
        show_message(error, true);
      ImGui::EndTabItem();
    }
    if (widgets_.tab("Detail")) {
      const std::string error = draw_detail_panel(session_, drawn(), *setup_.planet, widgets_);
      if (!error.empty()) show_message(error, true);
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void ExploreWindow::draw_map(int width, int height) {
  const MapActions actions =
      map_.draw(session_, state_.map_style, measure_.points(), guide_.hotspots(), width, height, widgets_);
  if (actions.under_cursor) under_cursor_ = actions.under_cursor;
  if (guide_.inside() != nullptr) {
    if (actions.go_to || actions.new_waypoint || actions.new_region || actions.drag)
      show_message("press Esc to leave the panorama first", true);
    return;
  }
  if (actions.go_to) session_.go_to(*actions.go_to);
  if (actions.new_region) {
    std::vector<core::InterestRegion> regions(session_.interest().begin(), session_.interest().end());
    regions.push_back(*actions.new_region);
    session_.set_interest(std::move(regions));
  }
  std::string error;
  if (actions.new_waypoint) {
    // The waypoint gets the camera's present height above ground.
    mars::Pose pose = session_.pose();
    pose.lon_deg = actions.new_waypoint->lon_deg;
    pose.lat_deg = actions.new_waypoint->lat_deg;
    pose.alt_m = session_.ground().height_m(mars::direction(*actions.new_waypoint)) + session_.height_m();
    error = session_.flights().append(pose, flight_.ground_speed_m_s());
  }
  if (explore::FlightEditor* editor = session_.flights().editor(); actions.drag && editor != nullptr)
    error = editor->move(actions.drag->waypoint, actions.drag->to, actions.drag->continues);
  if (!error.empty()) show_message(error, true);
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
  std::string place = formatted(
      "%.5f°, %.5f°   altitude %s, %s above ground   heading %.1f°  pitch %.1f°  roll %.1f°", lon_deg,
      pose.lat_deg, panel_length_text(pose.alt_m).c_str(), panel_length_text(session_.height_m()).c_str(),
      pose.yaw_deg < 0 ? pose.yaw_deg + 360 : pose.yaw_deg, pose.pitch_deg, pose.roll_deg);
  if (const OverlookView* inside = guide_.inside(); inside != nullptr)
    place = guide_.inside_hotspot()->name + formatted("   azimuth %.2f°  elevation %.2f°  field of view %.1f°",
                                                      std::fmod(inside->viewer().yaw_deg() + 720.0, 360.0),
                                                      inside->viewer().pitch_deg(), inside->viewer().fov_deg());
  status_line(place, ImGui::GetStyleColorVec4(ImGuiCol_Text));
  if (!state_.message.empty()) {
    status_line(state_.message, state_.message_is_error ? kErrorColour : kSuccessColour);
  } else if (guide_.inside() == nullptr && drawn_) {
    const core::DrawResult& r = drawn_->result;
    const bool rays = drawn_->request.backend == core::Backend::kRay;
    double mean_s = 0;
    for (const double s : image_times_s_) mean_s += s / static_cast<double>(image_times_s_.size());
    int finest = 0;
    for (std::size_t n = 0; n < r.stats.tiles_by_level.size(); ++n)
      if (r.stats.tiles_by_level[n] > 0) finest = static_cast<int>(n);
    const double spacing_m =
        lod::post_spacing_m(finest, setup_.planet->meta().tile.intervals(), setup_.planet->radius_m());
    std::string line = session_.settings().get("mode").value_or("") + (rays ? " by rays" : " by triangles") +
                       "   level " + std::to_string(finest) + " (" + panel_length_text(spacing_m) +
                       " posts)   error below " +
                       formatted("%.2f px", r.certificate.shift_bound_px / drawn_->request.px_per_screen_px);
    const core::View& drawn = drawn_->request.draw.view;
    line += "   " + (rays ? formatted("%.0f k rays", drawn.width * drawn.height / 1e3)
                          : formatted("%.0f k triangles", static_cast<double>(r.stats.triangles) / 1e3));
    line += "   " + formatted("%.0f MB", static_cast<double>(r.stats.bytes_resident) / 1e6) + "   " +
            formatted("%.0f ms", mean_s * 1e3);
    const std::int64_t loading = r.stats.pages_wanted + r.stats.pages_loading;
    if (loading > 0 && !r.settled) line += "   loading " + std::to_string(loading);
    if (!drawn_->request.is_full) line += "   coarser while moving";
    if (drawn_->request.stereo) line += "   (left eye)";
    status_line(line, ImGui::GetStyleColorVec4(ImGuiCol_Text));
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace vpe::window
