// Poses of the flight that are dragged in the view.
//
// GLFW would include OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "vpe/window/marks/flight_marks.h"
#include "vpe/window/marks/pose_drag.h"
#include "vpe/window/panels/flight_panel.h"

namespace vpe::window {

namespace {

double radius_of_pose_m(const explore::Session& session, const scripts::Waypoint& pose, mars::LonLat place) {
  const explore::TerrainQuery& ground = session.ground();
  return ground.radius_m + pose.up_m + (pose.above_terrain ? ground.height_m(mars::direction(place)) : 0);
}

}  // namespace

bool FlightPanel::is_shown() const { return ImGui::GetFrameCount() - shown_frame_ <= 1; }

bool FlightPanel::handle(const Event& event, std::optional<glm::dvec2> xy, explore::Session& session,
                         const core::View& view) {
  switch (event.kind) {
    case Event::Kind::kPress: return xy && take_pose(event, *xy, session, view);
    case Event::Kind::kMove:
      if (held_ && xy) drag_pose(*xy, session, view);
      return held_.has_value();
    case Event::Kind::kRelease:
      return event.code == GLFW_MOUSE_BUTTON_LEFT && std::exchange(held_, std::nullopt).has_value();
    default: return false;
  }
}

bool FlightPanel::take_pose(const Event& event, glm::dvec2 xy, explore::Session& session,
                            const core::View& view) {
  const bool is_plain = (event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0;
  if (event.code != GLFW_MOUSE_BUTTON_LEFT || !is_plain || !is_shown()) return false;
  const double reach_px = static_cast<double>(ImGui::GetFontSize()) * 0.6;
  const auto pose = pose_mark_at(session, view, xy, reach_px);
  if (!pose) return false;
  waypoint_ = static_cast<int>(pose->index);
  held_ = HeldPose{pose->index, pose->xy - xy, false};
  return true;
}

void FlightPanel::drag_pose(glm::dvec2 xy, explore::Session& session, const core::View& view) {
  explore::FlightEditor* editor = session.flights().editor();
  if (editor == nullptr || held_->index >= editor->flight().waypoints.size()) return held_.reset();
  const scripts::Waypoint pose = editor->flight().waypoints[held_->index];
  const mars::LonLat place = dragged_pose(view, {pose.lon_deg, pose.lat_deg}, xy + held_->aside_px,
                                          [&](mars::LonLat at) { return radius_of_pose_m(session, pose, at); });
  std::string problem = editor->move(held_->index, place, held_->has_moved);
  if (problem.empty()) {
    held_->has_moved = true;
  } else {
    pending_.message = std::move(problem);
    pending_.message_is_error = true;
  }
}

}  // namespace vpe::window
