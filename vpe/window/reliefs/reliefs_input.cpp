// Reliefs that are placed and dragged in the view.
//
// GLFW would include OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "vpe/explore/reliefs/usual_relief.h"
#include "vpe/explore/terrain_query.h"
#include "vpe/window/reliefs/reliefs_panel.h"
#include "vpe/window/ui/letter_key.h"

namespace vpe::window {

using explore::SharedRelief;

namespace {

constexpr double kReliefClick_px = 5;  // a press that moves farther is a drag

// Returns a place that is written with few digits, a tenth of a millimetre aside at most.
mars::LonLat rounded_place(mars::LonLat place) {
  constexpr double kParts = 1e9;  // of a degree
  return {std::round(place.lon_deg * kParts) / kParts, std::round(place.lat_deg * kParts) / kParts};
}

}  // namespace

bool ReliefsPanel::handle(const Event& event, std::optional<glm::dvec2> xy, bool is_typing,
                          const explore::Session& session, const core::View& view) {
  switch (event.kind) {
    case Event::Kind::kKeyPress:
    case Event::Kind::kKeyRepeat: return !is_typing && handle_key(event, session);
    case Event::Kind::kPress: return xy && handle_press(event, *xy, session, view);
    case Event::Kind::kMove:
      if (pressed_ && (!xy || glm::length(*xy - *pressed_) > kReliefClick_px)) pressed_.reset();
      if (held_ && xy) drag(*xy, session, view);
      return holds();
    case Event::Kind::kRelease: {
      if (event.code != GLFW_MOUSE_BUTTON_LEFT) return false;
      const bool held = std::exchange(held_, std::nullopt).has_value();
      if (!std::exchange(pressed_, std::nullopt) || !xy) return held;
      place(session.place_at(view, *xy), session);
      return false;  // the session ends its own drag
    }
    default: return false;
  }
}

bool ReliefsPanel::handle_press(const Event& event, glm::dvec2 xy, const explore::Session& session,
                                const core::View& view) {
  const bool is_plain = (event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0;
  if (event.code != GLFW_MOUSE_BUTTON_LEFT || !is_plain) return false;
  if (is_placing_) {
    pressed_ = xy;
    return false;
  }
  if (!is_shown()) return false;
  const std::uint64_t id = relief_at(xy, session, view);
  if (id == 0) return false;
  selected_ = id;
  const mars::LonLat middle = editor_.find(id)->relief.place;
  const explore::TerrainQuery bare = explore::ground_of(surface_, session.settings().values().exaggeration);
  const glm::dvec3 up = mars::direction(middle);
  const core::Projected foot = core::project(view, up * (bare.radius_m + bare.height_m(up)));
  held_ = Held{id, xy, foot.behind ? glm::dvec2(0, 0) : foot.xy - xy, false};
  return true;
}

// Returns the relief whose middle is seen nearest to a place of the image, within reach; 0: none.
std::uint64_t ReliefsPanel::relief_at(glm::dvec2 xy, const explore::Session& session,
                                      const core::View& view) const {
  const GroundView ground(session, view);
  double nearest_px = ReliefsPanelLimits::kReach_px;
  std::uint64_t found = 0;
  std::size_t looked_at = 0;
  for (const SharedRelief& item : editor_.items()) {
    if (++looked_at > ReliefsPanelLimits::kMostMarks && item->id != selected_) continue;
    const glm::dvec3 middle_m = ground.on_ground(mars::direction(item->relief.place));
    const core::Projected seen = ground.seen(middle_m);
    if (!ground.is_in_view(seen) || glm::length(seen.xy - xy) > nearest_px || ground.is_hidden(middle_m))
      continue;
    nearest_px = glm::length(seen.xy - xy);
    found = item->id;
  }
  return found;
}

// The ground without reliefs is what a drag moves over: their own would move under the cursor.
void ReliefsPanel::drag(glm::dvec2 xy, const explore::Session& session, const core::View& view) {
  if (editor_.find(held_->id) == nullptr) return held_.reset();
  if (!held_->has_moved && glm::length(xy - held_->press_px) <= kReliefClick_px) return;
  const explore::TerrainQuery bare = explore::ground_of(surface_, session.settings().values().exaggeration);
  const glm::dvec2 at = xy + held_->aside_px;
  const glm::dvec3 ray = core::pixel_ray(view, at.x, at.y);
  const double range_m = bare.cast_m(view.camera.position_m, ray);
  if (!std::isfinite(range_m) || range_m <= 0) return;  // over the sky, and from below, it stays
  const mars::LonLat to = mars::lon_lat(view.camera.position_m + ray * range_m);
  report(editor_.move(held_->id, rounded_place(to), held_->has_moved));
  held_->has_moved = true;
}

// Places a relief as large as a part of the image, turned as the camera is.
void ReliefsPanel::place(std::optional<mars::LonLat> at, const explore::Session& session) {
  if (!at) return report("there is no ground there");
  const glm::dvec3 up = mars::direction(*at);
  const glm::dvec3 place_m = up * (session.ground().radius_m + session.ground().height_m(up));
  const core::View view = session.view();
  const double range_m = glm::length(place_m - view.camera.position_m);
  const double size_m = ReliefsPanelLimits::kUsualShare * view.height * range_m / core::focal_px(view);
  const std::string problem = editor_.add(explore::usual_relief(
      static_cast<relief::ReliefKind>(kind_), rounded_place(*at), size_m, session.pose().yaw_deg));
  if (!problem.empty()) return report(problem);
  selected_ = editor_.newest();
}

bool ReliefsPanel::handle_key(const Event& event, const explore::Session& session) {
  const bool is_first = event.kind == Event::Kind::kKeyPress;
  if ((event.modifiers & (GLFW_MOD_ALT | GLFW_MOD_SHIFT)) != 0) return false;
  if ((event.modifiers & GLFW_MOD_CONTROL) != 0) {
    if (!is_shown() || !editor_.is_changed() || !is_letter_key(event.code, 's')) return false;
    if (is_first) save();
    return true;
  }
  switch (event.code) {
    case GLFW_KEY_ESCAPE: return is_first && std::exchange(is_placing_, false);
    case GLFW_KEY_V:
    case GLFW_KEY_INSERT:
      if (!is_placing_) return false;
      if (is_first)
        place(session.place_at({session.screen().width / 2.0, session.screen().height / 2.0}), session);
      return true;
    case GLFW_KEY_DELETE:
      if (!is_shown() || editor_.find(selected_) == nullptr) return false;
      if (is_first) report(editor_.remove(selected_));
      return true;
    default: return false;
  }
}

}  // namespace vpe::window
