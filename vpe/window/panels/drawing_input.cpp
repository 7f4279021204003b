// Drawing by hand, in the view and on the map.
//
// GLFW would include OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/window/marks/ground_view.h"
#include "vpe/window/panels/drawing_panel.h"
#include "vpe/window/ui/letter_key.h"

namespace vpe::window {

namespace {

constexpr double kClick_px = 5;  // a press that moves farther is a drag
constexpr double kSecondClick_s = 0.35;
constexpr double kSecondClick_px = 6;

double reach_px() { return static_cast<double>(ImGui::GetFontSize()) * 0.6; }

}  // namespace

bool DrawingPanel::is_shown() const { return ImGui::GetFrameCount() - shown_frame_ <= 1; }

void DrawingPanel::undo(bool again) {
  // While something is drawn, its vertices are the last edits.
  if (again ? sketch_.place_again() : sketch_.take_back()) return;
  if (!sketch_.unfinished().empty()) return;
  const std::string what = again ? history_.redo() : history_.undo();
  if (what.empty())
    tell(again ? "there is nothing to redo" : "there is nothing to undo");
  else
    tell((again ? "done again: " : "undone: ") + what);
}

bool DrawingPanel::handle(const Event& event, std::optional<glm::dvec2> xy, bool is_typing,
                          const explore::Session& session, const core::View& view) {
  switch (event.kind) {
    case Event::Kind::kKeyPress:
    case Event::Kind::kKeyRepeat: return !is_typing && handle_key(event, session);
    case Event::Kind::kPress: return xy && handle_press(event, *xy, session, view);
    case Event::Kind::kMove:
      if (pressed_ && (!xy || glm::length(*xy - *pressed_) > kClick_px)) pressed_.reset();
      if (!sketch_.held() || !xy) return false;
      if (const auto place = session.place_at(view, *xy)) report(sketch_.drag(*place));
      return true;
    case Event::Kind::kRelease: {
      if (event.code != GLFW_MOUSE_BUTTON_LEFT) return false;
      const bool held = sketch_.held().has_value();
      sketch_.release();
      if (!std::exchange(pressed_, std::nullopt) || !xy) return held;
      last_click_ = {event.time_s, *xy};
      if (const auto place = session.place_at(view, *xy))
        place_vertex(*place);
      else
        report("there is no ground under the cursor");
      return false;  // the session ends its own drag
    }
    default: return false;
  }
}

bool DrawingPanel::handle_press(const Event& event, glm::dvec2 xy, const explore::Session& session,
                                const core::View& view) {
  if (event.code != GLFW_MOUSE_BUTTON_LEFT || (event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL)) != 0)
    return false;
  if (sketch_.tool()) {
    const bool again = last_click_ && event.time_s - last_click_->first < kSecondClick_s &&
                       glm::length(last_click_->second - xy) < kSecondClick_px;
    last_click_.reset();
    if (again) {
      // The first click has placed the last vertex.
      if (!sketch_.unfinished().empty()) report(sketch_.finish());
      return true;
    }
    pressed_ = xy;
  }
  if (!is_shown() || !sketch_.unfinished().empty()) return false;
  const GroundView ground(session, view);
  const auto position = [&](mars::LonLat place) -> std::optional<glm::dvec2> {
    const glm::dvec3 point_m = ground.on_ground(mars::direction(place));
    const core::Projected seen = ground.seen(point_m);
    if (!ground.is_in_view(seen)) return std::nullopt;
    if (glm::length(seen.xy - xy) <= reach_px() && ground.is_hidden(point_m)) return std::nullopt;
    return seen.xy;
  };
  const auto vertex = explore::nearest_vertex(drawings_.all(), position, xy, reach_px());
  if (!vertex) return false;
  sketch_.press(*vertex);
  pressed_.reset();
  return true;
}

void DrawingPanel::place_vertex(mars::LonLat place) { report(sketch_.click(place)); }

bool DrawingPanel::handle_key(const Event& event, const explore::Session& session) {
  const bool ctrl = (event.modifiers & GLFW_MOD_CONTROL) != 0;
  const bool shift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
  if ((event.modifiers & GLFW_MOD_ALT) != 0) return false;
  if (ctrl) {
    if (is_letter_key(event.code, 'z')) {
      undo(shift);
    } else if (is_letter_key(event.code, 'y') && !shift) {
      undo(true);
    } else if (is_letter_key(event.code, 's') && !shift) {
      if (event.kind == Event::Kind::kKeyPress) actions_.saves_project = true;
    } else {
      return false;
    }
    return true;
  }
  if (shift || !sketch_.tool()) return false;
  const bool is_first = event.kind == Event::Kind::kKeyPress;
  switch (event.code) {
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      if (sketch_.unfinished().empty()) return false;
      if (is_first) report(sketch_.finish());
      return true;
    case GLFW_KEY_V:
    case GLFW_KEY_INSERT:
      if (!is_first) return true;
      if (const auto place = session.place_at({session.screen().width / 2.0, session.screen().height / 2.0}))
        place_vertex(*place);
      else
        report("there is no ground in the middle of the view");
      return true;
    case GLFW_KEY_BACKSPACE: return sketch_.take_back();
    case GLFW_KEY_ESCAPE: return is_first && sketch_.cancel();
    default: return false;
  }
}

bool DrawingPanel::press_on_map(const explore::MapView& map, glm::dvec2 xy) {
  if (!is_shown() || !sketch_.unfinished().empty()) return false;
  const auto vertex = explore::nearest_vertex(
      drawings_.all(), [&map](mars::LonLat place) { return std::optional(map.position(place)); }, xy,
      reach_px());
  if (vertex) sketch_.press(*vertex);
  return vertex.has_value();
}

void DrawingPanel::drag_on_map(mars::LonLat to) {
  if (sketch_.held()) report(sketch_.drag(to));
}

bool DrawingPanel::click_on_map(const explore::MapView& map, glm::dvec2 xy, double time_s) {
  if (!sketch_.tool()) return false;
  const bool again = last_map_click_ && time_s - last_map_click_->first < kSecondClick_s &&
                     glm::length(last_map_click_->second - xy) < kSecondClick_px;
  last_map_click_ = again ? std::nullopt : std::optional(std::pair{time_s, xy});
  if (again && !sketch_.unfinished().empty()) report(sketch_.finish());
  if (const auto place = map.place(xy); place && !again) place_vertex(*place);
  return true;
}

DrawingScene DrawingPanel::scene() const {
  return {drawings_.all(),      sketch_.selected(),
          sketch_.unfinished(), sketch_.tool() == explore::DrawingKind::kPolygon,
          sketch_.colour(),     cursor_};
}

void DrawingPanel::draw_marks(ImDrawList& list, const explore::Session& session,
                              std::optional<mars::LonLat> cursor, const EyeImage& eye) {
  cursor_ = cursor;
  marks_.draw(list, session, scene(), eye);
}

void DrawingPanel::draw_on_map(ImDrawList& list, const explore::MapView& map, double x0, double y0) {
  window::draw_on_map(list, map, scene(), x0, y0);
}

}  // namespace vpe::window
