// The panel of flights: play, scrub, edit, record.
#include <algorithm>
#include <cmath>
#include <string>

#include "vpe/explore/measure/read_out.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

void ExploreWindow::flight_panel() {
  ImGui::BeginChild("flight");
  const auto tell = [this](const std::string& trouble) {
    if (!trouble.empty()) say(trouble, true);
  };
  explore::FlightPlayer* player = session_.player();
  const bool follows = session_.follows_flight();
  const bool plays = follows && player != nullptr && player->is_playing();
  if (widgets_.button(plays ? "Pause" : "Play", "Space")) tell(session_.follow(!plays));
  ImGui::SameLine();
  if (widgets_.button("Leave", "Esc: go on by hand from here") && follows) session_.leave_flight();
  ImGui::SameLine();
  bool records = log_ != nullptr;
  if (widgets_.toggle("Record", records, "L: everything that happens, as a flight")) {
    if (records)
      start_log(new_file("log-", ".flight"));
    else
      stop_log();
  }
  if (player != nullptr) {
    double time_s = player->time_s();
    ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 3);
    if (widgets_.slide("Time", time_s, 0, std::max(player->duration_s(), 1e-3), "%.2f s", false))
      session_.scrub(time_s);
    player = session_.player();
  }
  if (player != nullptr) {
    double speed = player->speed();
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
    if (widgets_.number("Times as fast", speed, -100, 100, 0.5, "%.3g", "negative: backwards"))
      player->set_speed(speed);
    ImGui::SameLine();
    bool loops = player->loops();
    if (widgets_.check("Loop", loops)) player->set_loop(loops);
    if (player->look_offset().yaw_deg != 0 || player->look_offset().pitch_deg != 0) {
      if (widgets_.button("Look ahead", "where the flight looks")) player->look_ahead();
    }
  } else if (!session_.flights().problem().empty()) {
    ImGui::TextWrapped("%s", session_.flights().problem().c_str());
  }
  ImGui::Separator();
  if (widgets_.button("Add waypoint", "P: here, as the eye is now"))
    tell(session_.flights().add(session_.pose(), state_.ground_speed_m_s));
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
  widgets_.number("m/s to it", state_.ground_speed_m_s, 0.01, 1e6, 100, "%.6g",
                  "ground speed to waypoints that are added");
  if (explore::FlightEditor* editor = session_.flights().editor(); editor != nullptr)
    waypoint_rows(*editor);
  else
    ImGui::TextDisabled("Ctrl + click on the map adds one there");
  ImGui::EndChild();
}

void ExploreWindow::waypoint_rows(explore::FlightEditor& editor) {
  const auto tell = [this](const std::string& trouble) {
    if (!trouble.empty()) say(trouble, true);
  };
  if (widgets_.button("Undo", editor.undo_text().c_str())) editor.undo();
  ImGui::SameLine();
  if (widgets_.button("Redo", editor.redo_text().c_str())) editor.redo();
  ImGui::SameLine();
  if (widgets_.button("Even speed", "the same ground speed, of the field above, everywhere"))
    tell(editor.keep_speed(state_.ground_speed_m_s));
  ImGui::SameLine();
  if (widgets_.button("Save")) save_flight();
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 2.5F);
  widgets_.text("File", setup_.flight_file);

  const std::vector<scripts::Waypoint> waypoints = editor.flight().waypoints;
  state_.waypoint = std::clamp(state_.waypoint, 0, static_cast<int>(waypoints.size()) - 1);
  ImGui::Text("%d waypoints, %s", static_cast<int>(waypoints.size()),
              explore::length_text(editor.length_m()).c_str());
  // A log may have a hundred thousand: only the rows in sight are made.
  ImGui::BeginChild("rows", ImVec2(0, ImGui::GetTextLineHeightWithSpacing() * 6), true);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(waypoints.size()));
  while (clipper.Step()) {
    for (int n = clipper.DisplayStart; n < clipper.DisplayEnd; ++n) {
      const scripts::Waypoint& w = waypoints[static_cast<std::size_t>(n)];
      char row[160];
      std::snprintf(row, sizeof row, "%8.2f s  %9.4f° %8.4f°  %s", w.time_s, w.lon_deg, w.lat_deg,
                    explore::length_text(w.up_m).c_str());
      ImGui::PushID(n);
      if (ImGui::Selectable(row, n == state_.waypoint)) state_.waypoint = n;
      widgets_.note("waypoint " + std::to_string(n));
      ImGui::PopID();
    }
  }
  ImGui::EndChild();

  const auto index = static_cast<std::size_t>(state_.waypoint);
  scripts::Waypoint w = waypoints[index];
  if (widgets_.button("Go to it")) session_.scrub(w.time_s);
  ImGui::SameLine();
  if (widgets_.button("Insert after", "where the eye is now")) {
    scripts::Waypoint next = w;
    const mars::Pose& pose = session_.pose();
    next.lon_deg = pose.lon_deg;
    next.lat_deg = pose.lat_deg;
    next.up_m = pose.alt_m;
    next.above_terrain = false;
    next.yaw_deg = pose.yaw_deg;
    next.pitch_deg = pose.pitch_deg;
    next.roll_deg = pose.roll_deg;
    tell(editor.insert_after(index, next, state_.ground_speed_m_s));
  }
  ImGui::SameLine();
  if (widgets_.button("Delete")) {
    if (waypoints.size() == 1) {
      session_.leave_flight();
      session_.flights().clear();
      return;
    }
    tell(editor.remove(index));
  }
  widgets_.group("waypoint");
  ImGui::PushItemWidth(ImGui::GetFontSize() * 10);
  bool changed = widgets_.number("Time (s)", w.time_s, 0, 1e6, 1, "%.3f");
  changed |= widgets_.number("Longitude", w.lon_deg, -180, 180, 0.01, "%.6f");
  changed |= widgets_.number("Latitude", w.lat_deg, -90, 90, 0.01, "%.6f");
  changed |= widgets_.number(w.above_terrain ? "Height (m)" : "Altitude (m)", w.up_m, -1e7, 1e10, 100, "%.2f");
  changed |= widgets_.number("Heading", w.yaw_deg, -360, 360, 5, "%.2f");
  changed |= widgets_.number("Pitch", w.pitch_deg, -90, 90, 5, "%.2f");
  changed |= widgets_.number("Roll", w.roll_deg, -360, 360, 5, "%.2f");
  ImGui::PopItemWidth();
  widgets_.group("");
  if (changed) tell(editor.replace(index, w));
}

}  // namespace vpe::window
