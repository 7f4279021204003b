// The frames of the explore window: panels, status line, help.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "vpe/explore/places/arrival.h"
#include "vpe/explore/steer.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/panels/devices_panel.h"
#include "vpe/window/panels/help_panel.h"
#include "vpe/window/panels/settings_panels.h"

namespace vpe::window {

namespace {

constexpr float kTabLetters = 0.72F;  // of the size of others, so that ten tabs fit

// A slider that moved under the hand that holds it could not be held: the scale follows at the end.
void draw_letters(double scale, WindowState& state, Widgets& widgets) {
  double letters = state.letters_slid > 0 ? state.letters_slid : scale;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
  if (widgets.slide("Letters", letters, Display::kSmallestScale, Display::kLargestScale, "%.2f x", true,
                    "size of letters and panels; Ctrl and + or -, Ctrl+0: the usual one"))
    state.letters_slid = letters;
  if (state.letters_slid > 0 && !ImGui::IsAnyItemActive()) state.letters = std::exchange(state.letters_slid, 0);
}

void draw_control_panel(explore::Session& session, double scale, WindowState& state, Widgets& widgets) {
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
  bool orthographic = session.is_orthographic();
  ImGui::BeginDisabled(orthographic);
  if (widgets.slide("Field of view", fov, 5, 120, "%.1f°", true)) session.set_fov(fov);
  ImGui::EndDisabled();
  widgets.slide("Speed", state.speed, WindowState::kSlowest, WindowState::kFastest, "%.2f x", true,
                "factor on the speed of keys and sticks, which also grows with the height");
  ImGui::PopItemWidth();
  if (widgets.button("North up", "N")) session.north_up();
  ImGui::SameLine();
  if (widgets.button("Level", "G: no roll")) session.level();
  ImGui::SameLine();
  if (widgets.button("Look down", "U")) session.look_down(false);
  ImGui::SameLine();
  if (widgets.toggle("Orthographic", orthographic,
                     "O: parallel lines of sight, so that the view has one scale")) {
    if (const std::string problem = session.set_orthographic(orthographic); !problem.empty()) {
      state.message = problem;
      state.message_is_error = true;
    }
  }
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
  ImGui::BeginDisabled(!state.stereo);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
  widgets.number("Eye distance (m)", state.eye_base_m, 0, 1e6, 1, "%.3g",
                 "0: a thirtieth of the height above ground");
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
  widgets.number("Convergence (m)", state.convergence_m, 0, 1e12, 10, "%.4g",
                 "Distance at which the eyes' images coincide; 0: infinitely far");
  ImGui::EndDisabled();
  draw_letters(scale, state, widgets);
}

}  // namespace

void ExploreWindow::draw_frame() {
  display_.begin_frame();
  widgets_.begin_frame();
  panel_focus_.begin_frame();
  shown_devices_.reset();
  find_cursor();
  if (state_.large_map) {
    if (large_map_ == nullptr)
      large_map_ = std::make_unique<MapPanel>(setup_.planet, setup_.threads, [] { Display::wake(); });
    ImGui::SetNextWindowPos(at(view_area_.x, view_area_.y));
    ImGui::SetNextWindowSize(at(view_area_.width, view_area_.height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(0, 0));
    ImGui::Begin("large map", nullptr,
                 kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoFocusOnAppearing);
    widgets_.group("large");
    draw_map(*large_map_, static_cast<int>(view_area_.width), static_cast<int>(view_area_.height));
    widgets_.group("");
    ImGui::End();
    ImGui::PopStyleVar();
  } else if (guide_.inside() != nullptr) {
    guide_.inside()->draw();
  } else {
    draw_view();
  }
  if (state_.panels) {
    draw_over_view();
    if (layout_.side.width > 0) draw_side();
    draw_side_handle();
    draw_status();
  }
  draw_notes();
  draw_menu();
  if (state_.files) draw_files();
  if (state_.preferences) draw_preferences();
  if (state_.help) draw_explore_help(view_area_, state_.help, widgets_);
  display_.end_frame(std::exchange(capture_, nullptr));
  tip_at_s_ = widgets_.tip_due_s() ? std::optional(now_s() + *widgets_.tip_due_s()) : std::nullopt;
  if (Display::has_input_left()) frames_due_ = std::max(frames_due_, kFramesAfterChange);
  ++frames_;
}

void ExploreWindow::fly_to(const core::Place& place) {
  if (guide_.inside() != nullptr) return show_message("press Esc to leave the panorama first", true);
  welcome_.dismiss();
  state_.large_map = false;
  session_.go(explore::arrival(place, session_.screen(), session_.ground()));
  show_message(place.name);
}

void ExploreWindow::draw_side() {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(at(layout_.side.width, layout_.side.height));
  ImGui::Begin("side", nullptr, kFixed);
  const double inside = static_cast<double>(ImGui::GetContentRegionAvail().x);
  if (const auto place = search_.draw(inside, widgets_)) fly_to(*place);
  if (search_.takes_focus()) frames_due_ = kFramesAfterChange + 1;
  // In a low window the tabs need the room more than the map.
  const double map_height = std::round(std::min(inside * 0.5, layout_.side.height * 0.22));
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + static_cast<float>(std::round(inside / 2 - map_height)));
  draw_map(map_, static_cast<int>(2 * map_height), static_cast<int>(map_height));
  bool imagery = state_.map_style == explore::MapStyle::kImagery;
  if (widgets_.check("Imagery", imagery))
    state_.map_style = imagery ? explore::MapStyle::kImagery : explore::MapStyle::kElevation;
  ImGui::SameLine();
  widgets_.toggle("Large map", state_.large_map, "Tab");
  ImGui::SameLine();
  if (widgets_.button("Planet", "Home: the whole planet")) session_.show_planet();
  ImGui::SameLine();
  if (widgets_.button("File", "Ctrl+O: open, recent files, save images, make films"))
    state_.files = !state_.files;
  ImGui::SameLine();
  if (widgets_.button("Help", "F1")) state_.help = !state_.help;
  ImGui::Separator();
  draw_tabs();
  ImGui::End();
}

void ExploreWindow::draw_tabs() {
  const float scale = static_cast<float>(display_.scale());
  // Tabs stand closer than other widgets, so that all of them fit.
  const auto dense = [scale] {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {scale, 3 * scale});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemInnerSpacing, {scale, 2 * scale});
    ImGui::SetWindowFontScale(kTabLetters);
  };
  const auto usual = [] {
    ImGui::SetWindowFontScale(1);
    ImGui::PopStyleVar(2);
  };
  const auto tab = [&](const char* label) {
    dense();
    const bool is_open = widgets_.tab(label);
    usual();
    return is_open;
  };
  dense();
  const bool is_shown = ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyResizeDown);
  usual();
  if (!is_shown) return;
  if (tab("View")) {
    begin_part("control");
    draw_control_panel(session_, display_.scale(), state_, widgets_);
    draw_devices();
    ImGui::EndChild();
    ImGui::EndTabItem();
  }
  if (tab("Places")) {
    const PlacesActions actions =
        places_.draw(session_, has_project() ? &project_bookmarks_ : nullptr, widgets_);
    if (actions.go_to) {
      session_.set_fov(actions.go_to->fov_deg);
      session_.go(actions.go_to->pose);
    }
    if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
    ImGui::EndTabItem();
  }
  if (tab("Flight")) {
    const FlightActions actions = flight_.draw(session_, recorder_.is_recording(), widgets_);
    if (actions.record) set_recording(*actions.record);
    if (actions.restore) restore_flight(*actions.restore);
    if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
    ImGui::EndTabItem();
  }
  if (tab("Measure")) {
    begin_part("measure");
    const MeasureActions actions = measure_.draw(session_, under_cursor_, widgets_);
    if (actions.go_to) session_.go_to(*actions.go_to);
    if (actions.undoes || actions.redoes) drawing_.undo(actions.redoes);
    if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
    ImGui::EndChild();
    ImGui::EndTabItem();
  }
  if (tab("Draw")) {
    drawing_.draw(widgets_);
    ImGui::EndTabItem();
  }
  if (tab("Objects")) {
    objects_.draw(session_, widgets_);
    ImGui::EndTabItem();
  }
  if (tab("Ground")) {
    reliefs_.draw(session_, widgets_);
    ImGui::EndTabItem();
  }
  if (tab("Layers")) {
    draw_layers();
    ImGui::EndTabItem();
  }
  if (tab("Look")) {
    if (const std::string error =
            appearance_.draw(session_, drawn(), setup_.planet->meta().finest_image_level >= 0, widgets_);
        !error.empty())
      show_message(error, true);
    ImGui::EndTabItem();
  }
  if (tab("Detail")) {
    const std::string error = draw_detail_panel(session_, drawn(), *setup_.planet, widgets_);
    if (!error.empty()) show_message(error, true);
    ImGui::EndTabItem();
  }
  ImGui::EndTabBar();
}

void ExploreWindow::draw_layers() {
  std::vector<std::string> names;
  for (const paging::ImageLayer& layer : setup_.planet->meta().image_layers) names.push_back(layer.name);
  layers_.draw(session_, names, widgets_);
}

void ExploreWindow::update_layers() {
  if (layers_.update(session_)) frames_due_ = kFramesAfterChange;
  for (MapPanel* map : {&map_, large_map_.get()}) {
    if (map != nullptr && map->layers_revision() != layers_.revision())
      map->set_layers(layers_.map_layers(), layers_.revision());
  }
  const LayersActions actions = layers_.take_actions();
  if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
}

void ExploreWindow::draw_devices() {
  if (!widgets_.header("Devices", false)) return;
  shown_devices_ = devices_.states(now_s());
  take(draw_devices_panel(*shown_devices_, setup_.preferences, widgets_));
}

// Draws what changes the side panel's width: its edge, or a button in a narrow window.
void ExploreWindow::draw_side_handle() {
  const double scale = display_.scale();
  const double edge = layout_.side.width;
  if (layout_.is_narrow) {
    ImGui::SetNextWindowPos(at(edge + 4 * scale, 4 * scale));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(0, 0));
    ImGui::Begin("side switch", nullptr,
                 kFixed | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_AlwaysAutoResize);
    widgets_.toggle("\u2261##side", state_.side_is_open, "show or hide the panel");
    ImGui::End();
    ImGui::PopStyleVar();
    return;
  }
  ImGui::SetNextWindowPos(at(edge - 3 * scale, 0));
  ImGui::SetNextWindowSize(at(6 * scale, layout_.side.height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, at(1, 1));
  ImGui::Begin("side edge", nullptr,
               (kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoScrollbar);
  ImGui::InvisibleButton("edge", at(6 * scale, layout_.side.height));
  widgets_.record("side edge");
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
    state_.side_px = std::clamp(static_cast<double>(ImGui::GetIO().MousePos.x) / scale,
                                LayoutLimits::kNarrowest_px, LayoutLimits::kWidest_px);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void ExploreWindow::draw_map(MapPanel& map, int width, int height) {
  const MapActions actions =
      map.draw(session_, state_.map_style, measure_.points(), guide_.hotspots(), width, height, widgets_);
  if (actions.under_cursor) under_cursor_ = actions.under_cursor;
  if (actions.menu_at) open_menu(*actions.menu_at);
  if (guide_.inside() != nullptr) {
    if (actions.go_to || actions.new_waypoint || actions.new_region || actions.drag)
      show_message("press Esc to leave the panorama first", true);
    return;
  }
  if (actions.go_to && !layers_.pick_on_map(map.map(), *actions.go_to)) session_.go_to(*actions.go_to);
  if (actions.aim_at) {
    mars::Pose pose = session_.pose();
    pose.yaw_deg = mars::initial_bearing_deg({pose.lon_deg, pose.lat_deg}, *actions.aim_at);
    session_.put(pose);
  }
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
    error = session_.flights().append(pose, flight_.ground_speed_m_s(session_));
  }
  if (explore::FlightEditor* editor = session_.flights().editor(); actions.drag && editor != nullptr)
    error = editor->move(actions.drag->waypoint, actions.drag->to, actions.drag->continues);
  if (!error.empty()) show_message(error, true);
}

}  // namespace vpe::window
