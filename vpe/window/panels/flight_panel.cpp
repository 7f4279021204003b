#include "vpe/window/panels/flight_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <utility>

#include "vpe/base/file.h"
#include "vpe/explore/measure/read_out.h"
#include "vpe/explore/steer.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

void report(FlightActions& actions, std::string error) {
  if (error.empty()) return;
  actions.message = std::move(error);
  actions.message_is_error = true;
}

}  // namespace

std::filesystem::path new_file(const std::filesystem::path& folder, const std::string& kind,
                               const std::string& extension) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
  const std::string stem = "vpe-" + kind + stamp;
  std::filesystem::path file = folder / (stem + extension);
  for (int n = 2; std::filesystem::exists(file); ++n)
    file = folder / (stem + "-" + std::to_string(n) + extension);
  return file;
}

scripts::ParsedFlight read_flight_file(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28;
  const std::vector<std::uint8_t> bytes = base::read_file(file, kMostBytes);
  return scripts::parse_flight({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
}

FlightPanel::FlightPanel(std::string file, std::filesystem::path folder)
    : file_(std::move(file)), folder_(std::move(folder)) {}

FlightActions FlightPanel::draw(explore::Session& session, bool is_recording, Widgets& widgets) {
  FlightActions actions = std::exchange(pending_, {});
  shown_frame_ = ImGui::GetFrameCount();
  begin_part("flight");
  const bool follows = session.follows_flight();
  const explore::FlightPlayer* player = session.player();
  const bool plays = follows && player != nullptr && player->is_playing();
  if (widgets.button(plays ? "Pause" : "Play", "Space")) report(actions, session.follow(!plays));
  ImGui::SameLine();
  if (widgets.button("Leave", "Esc: leave the flight and continue by hand") && follows) session.leave_flight();
  ImGui::SameLine();
  bool records = is_recording;
  if (widgets.toggle("Record", records,
                     "L: record the session as a flight, with zoom, backend, stereo and the size of the view"))
    actions.record = records;
  draw_player(session, widgets);
  ImGui::Separator();
  if (widgets.button("Add waypoint", "P: at the present pose of the camera"))
    report(actions, session.flights().append(session.pose(), ground_speed_m_s(session)));
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
  widgets.number("m/s to it", ground_speed_m_s_, 0, 1e8, 100, ground_speed_m_s_ > 0 ? "%.6g" : "by height",
                 "ground speed to waypoints that are added; 0: that of keys, which grows with the height");
  if (session.flights().editor() != nullptr)
    draw_waypoints(session, actions, widgets);
  else
    draw_empty(session, actions, widgets);
  ImGui::EndChild();
  return actions;
}

double FlightPanel::ground_speed_m_s(const explore::Session& session) const {
  return ground_speed_m_s_ > 0 ? ground_speed_m_s_ : explore::full_speed_m_s(session.pose(), session.ground());
}

void FlightPanel::draw_empty(explore::Session& session, FlightActions& actions, Widgets& widgets) {
  draw_file(session, actions, widgets);
  draw_hint("Ctrl + click on the map adds a waypoint there.");
  if (abandoned_.empty()) return;
  if (widgets.button("Restore", ("open the unsaved flight " + abandoned_.front().string()).c_str()))
    actions.restore = abandoned_.front();
}

void FlightPanel::draw_player(explore::Session& session, Widgets& widgets) {
  explore::FlightPlayer* player = session.player();
  if (player != nullptr) {
    double time_s = player->time_s();
    ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 3);
    if (widgets.slide("Time", time_s, 0, std::max(player->duration_s(), 1e-3), "%.2f s", false))
      session.scrub(time_s);
    player = session.player();
  }
  if (player != nullptr) {
    double speed = player->speed();
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
    if (widgets.number("Speed factor", speed, -100, 100, 0.5, "%.3g", "negative: backwards"))
      player->set_speed(speed);
    ImGui::SameLine();
    bool loops = player->loops();
    if (widgets.check("Loop", loops)) player->set_loop(loops);
    // The button is always there, so that those below stay at their places.
    const bool looks_aside = player->look_offset().yaw_deg != 0 || player->look_offset().pitch_deg != 0;
    ImGui::BeginDisabled(!looks_aside);
    if (widgets.button("Look ahead", "return to the flight's own direction")) player->reset_look_offset();
    ImGui::EndDisabled();
    ImGui::SameLine();
    const bool is_beside = player->platform_offset() != explore::PlatformOffset{};
    ImGui::BeginDisabled(!is_beside);
    if (widgets.button(
            "On course",
            "return to the flight's own course; the keys that move the camera leave it while the flight plays"))
      player->set_platform_offset({});
    ImGui::EndDisabled();
  } else if (!session.flights().problem().empty()) {
    ImGui::TextWrapped("%s", session.flights().problem().c_str());
  }
}

void FlightPanel::draw_waypoints(explore::Session& session, FlightActions& actions, Widgets& widgets) {
  explore::FlightEditor& editor = *session.flights().editor();
  if (widgets.button("Undo", editor.undo_text().c_str())) editor.undo();
  ImGui::SameLine();
  if (widgets.button("Redo", editor.redo_text().c_str())) editor.redo();
  ImGui::SameLine();
  if (widgets.button("Even speed", "retime the flight for the ground speed above"))
    report(actions, editor.keep_speed(ground_speed_m_s(session)));
  draw_file(session, actions, widgets);

  const std::vector<scripts::Waypoint> waypoints = editor.flight().waypoints;
  waypoint_ = std::clamp(waypoint_, 0, static_cast<int>(waypoints.size()) - 1);
  ImGui::Text("%d waypoints, %s", static_cast<int>(waypoints.size()),
              explore::measured_length_text(editor.length_m()).c_str());
  double total_s = scripts::duration_s(editor.flight());
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
  if (widgets.number("Total time (s)", total_s, 0.01, scripts::FlightLimits::kMaxTime_s, 10, "%.6g",
                     "stretches the flight") &&
      scripts::duration_s(editor.flight()) > 0)
    report(actions, editor.scale_times(total_s / scripts::duration_s(editor.flight())));
  draw_list(waypoints, widgets);

  const auto index = static_cast<std::size_t>(waypoint_);
  scripts::Waypoint w = waypoints[index];
  if (widgets.button("Go to it")) session.scrub(w.time_s);
  ImGui::SameLine();
  if (widgets.button("Insert after", "at the present pose of the camera")) {
    scripts::Waypoint next = w;
    const mars::Pose& pose = session.pose();
    next.lon_deg = pose.lon_deg;
    next.lat_deg = pose.lat_deg;
    next.up_m = pose.alt_m;
    next.above_terrain = false;
    next.yaw_deg = pose.yaw_deg;
    next.pitch_deg = pose.pitch_deg;
    next.roll_deg = pose.roll_deg;
    report(actions, editor.insert_after(index, next, ground_speed_m_s(session)));
  }
  ImGui::SameLine();
  if (widgets.button("Delete")) {
    if (waypoints.size() == 1) {
      session.leave_flight();
      session.flights().clear();
      return;
    }
    report(actions, editor.remove(index));
  }
  widgets.group("waypoint");
  ImGui::PushItemWidth(ImGui::GetFontSize() * 10);
  bool changed = widgets.number("Time (s)", w.time_s, 0, 1e6, 1, "%.3f");
  changed |= widgets.number("Longitude", w.lon_deg, -180, 180, 0.01, "%.6f");
  changed |= widgets.number("Latitude", w.lat_deg, -90, 90, 0.01, "%.6f");
  changed |= widgets.number(w.above_terrain ? "Height (m)" : "Altitude (m)", w.up_m, -1e7, 1e10, 100, "%.2f");
  changed |= widgets.number("Heading", w.yaw_deg, -360, 360, 5, "%.2f");
  changed |= widgets.number("Pitch", w.pitch_deg, -90, 90, 5, "%.2f");
  changed |= widgets.number("Roll", w.roll_deg, -360, 360, 5, "%.2f");
  ImGui::PopItemWidth();
  widgets.group("");
  if (changed) report(actions, editor.replace(index, w));
}

void FlightPanel::draw_list(const std::vector<scripts::Waypoint>& waypoints, Widgets& widgets) {
  // A log may have a hundred thousand waypoints: only visible rows are drawn.
  begin_part("rows", ImVec2(0, ImGui::GetTextLineHeightWithSpacing() * 6), true);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(waypoints.size()));
  while (clipper.Step()) {
    for (int n = clipper.DisplayStart; n < clipper.DisplayEnd; ++n) {
      const scripts::Waypoint& w = waypoints[static_cast<std::size_t>(n)];
      char row[160];
      std::snprintf(row, sizeof row, "%8.2f s  %9.4f° %8.4f°  %s", w.time_s, w.lon_deg, w.lat_deg,
                    explore::measured_length_text(w.up_m).c_str());
      ImGui::PushID(n);
      if (ImGui::Selectable(row, n == waypoint_)) waypoint_ = n;
      widgets.record("waypoint " + std::to_string(n));
      ImGui::PopID();
    }
  }
  ImGui::EndChild();
}

void FlightPanel::draw_file(explore::Session& session, FlightActions& actions, Widgets& widgets) {
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 8.5F);
  widgets.text("##file", file_, "flight file");
  ImGui::SameLine();
  if (widgets.button("Open", "reads the flight from this file")) open(session, actions);
  ImGui::SameLine();
  ImGui::BeginDisabled(session.flights().editor() == nullptr);
  if (widgets.button("Save", "writes the flight to this file") && session.flights().editor() != nullptr)
    save(*session.flights().editor(), actions);
  ImGui::EndDisabled();
}

void FlightPanel::open(explore::Session& session, FlightActions& actions) {
  const explore::FlightEditor* editor = session.flights().editor();
  if (file_.empty()) return report(actions, "enter the name of a flight file");
  if (editor != nullptr && editor->is_changed())
    return report(actions, "the present flight has unsaved changes; save it under another name, or undo them");
  try {
    const scripts::ParsedFlight parsed = read_flight_file(file_);
    if (!parsed.flight) return report(actions, scripts::to_string(parsed.errors.front()));
    if (std::string error = session.flights().load(*parsed.flight); !error.empty())
      return report(actions, file_ + ": " + error);
    actions.message = "flight: " + file_;
  } catch (const std::exception& e) {
    report(actions, e.what());
  }
}

FlightActions FlightPanel::open_file(const std::string& file, explore::Session& session) {
  FlightActions actions;
  const std::string before = std::exchange(file_, file);
  open(session, actions);
  if (actions.message_is_error) file_ = before;
  return actions;
}

void FlightPanel::save(explore::FlightEditor& editor, FlightActions& actions) {
  if (file_.empty()) file_ = new_file(folder_, "", ".flight").string();
  try {
    base::write_file(file_, editor.to_text());
    editor.mark_saved();
    actions.message = "flight: " + file_;
    actions.message_is_error = false;
  } catch (const std::exception& e) {
    report(actions, e.what());
  }
}

}  // namespace vpe::window
