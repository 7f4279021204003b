// Mouse and keys of the explore window, and the cursor that is caught for looking around.
//
// GLFW would include OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "mars/vector/vector_file.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

namespace {

constexpr double kDoubleClick_s = 0.35;
constexpr double kDoubleClick_px = 6;

}  // namespace

void ExploreWindow::handle(const Event& event) {
  if (display_.has_caught_cursor()) {
    if (handle_caught(event)) return;
  } else {
    cursor_ = {event.x, event.y};
  }
  const ImGuiIO& io = ImGui::GetIO();
  const bool is_key = event.kind == Event::Kind::kKeyPress || event.kind == Event::Kind::kKeyRepeat ||
                      event.kind == Event::Kind::kKeyRelease;
  if (event.kind == Event::Kind::kDrop) {
    // Of several files those of vectors become layers together; else the first one counts.
    for (const std::string& file : event.files) {
      open_file(file);
      if (!mars::has_vector_extension(file)) break;
    }
    return;
  }
  if (guide_.inside() != nullptr && !is_key) {
    if (event.kind == Event::Kind::kRelease) session_.release();
    guide_.inside()->handle(event, io.WantCaptureMouse);
    return;
  }
  watch_menu_click(event);
  if (handle_panel_keys(event) || handle_swipe(event) || handle_marks(event)) return;
  switch (event.kind) {
    case Event::Kind::kKeyPress:
    case Event::Kind::kKeyRepeat:
    case Event::Kind::kKeyRelease: devices_.key(event); break;
    case Event::Kind::kPress:
    case Event::Kind::kRelease: handle_button(event); break;
    case Event::Kind::kMove:
      if (session_.mouse_use() != explore::MouseUse::kNone) drag(event.time_s);
      break;
    case Event::Kind::kScroll:
      if (const auto xy = image_layout().camera_xy(cursor_); xy && !state_.large_map && !io.WantCaptureMouse)
        scroll(middle_xy(image_layout().eye_at(cursor_), *xy), event.scroll);
      break;
    case Event::Kind::kFocusLost:
    case Event::Kind::kDrop: break;  // handled above
  }
}

// Returns true if the event belongs to the line between two planets.
bool ExploreWindow::handle_swipe(const Event& event) {
  const ViewArea area = image_layout().image_area();
  bool is_taken = false;
  switch (event.kind) {
    case Event::Kind::kPress:
      is_taken = swipes() && !state_.large_map && !ImGui::GetIO().WantCaptureMouse &&
                 event.code == GLFW_MOUSE_BUTTON_LEFT && swipe_.press(area, cursor_, display_.scale());
      break;
    case Event::Kind::kMove: is_taken = swipe_.drag(area, cursor_); break;
    case Event::Kind::kRelease: is_taken = swipe_.release(); break;
    case Event::Kind::kFocusLost: swipe_.release(); break;
    default: break;
  }
  if (is_taken) frames_due_ = std::max(frames_due_, 1);
  return is_taken;
}

// Returns true if the event was a key that leads from panel to panel.
bool ExploreWindow::handle_panel_keys(const Event& event) {
  if (!panel_focus_.is_on() || event.kind != Event::Kind::kKeyPress) return false;
  if (event.code == GLFW_KEY_F6) {
    panel_focus_.next();
    return true;
  }
  const bool is_used = ImGui::GetIO().WantTextInput || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
  if (event.code != GLFW_KEY_ESCAPE || is_used) return false;
  panel_focus_.leave();
  return true;
}

void ExploreWindow::scroll(glm::dvec2 xy, double notches) {
  welcome_.dismiss();
  session_.wheel(xy, notches);
}

// Returns true if the event belongs to the cursor that is caught, or ends that.
bool ExploreWindow::handle_caught(const Event& event) {
  switch (event.kind) {
    case Event::Kind::kMove: session_.look_by(event.dx, event.dy); return true;
    case Event::Kind::kScroll: add_speed(event.scroll); return true;
    case Event::Kind::kPress:
    case Event::Kind::kRelease: return true;
    case Event::Kind::kFocusLost: let_cursor_go(); return true;
    case Event::Kind::kKeyPress:
      if (event.code != GLFW_KEY_ESCAPE) return false;
      let_cursor_go();
      return true;
    default: return false;
  }
}

// Changes the speed of the mode. On foot and in the vehicle the wheel has another meaning while the cursor is free.
void ExploreWindow::add_speed(double notches) {
  if (!session_.mover().is_on_ground()) {
    session_.wheel(cursor_, notches);
    if (session_.follows_flight()) return;  // there it is the field of view
    return show_message("speed " + formatted("%.3g", session_.mover().speed()));
  }
  const double sign = setup_.preferences.invert_wheel ? -1 : 1;
  state_.speed = std::clamp(state_.speed * std::pow(explore::Mover::kSpeedNotch, sign * notches),
                            WindowState::kSlowest, WindowState::kFastest);
  show_message("speed " + formatted("%.3g", state_.speed));
}

std::string ExploreWindow::catch_cursor() {
  if (session_.mode() == explore::MotionMode::kOrbit)
    return "the mouse looks around in fly, walk and drive; F changes the mode";
  state_.help = state_.files = state_.preferences = state_.large_map = false;
  panel_focus_.leave();
  welcome_.dismiss();
  session_.release();
  display_.catch_cursor(true);
  frames_due_ = kFramesAfterChange;
  return {};
}

void ExploreWindow::let_cursor_go() {
  display_.catch_cursor(false);
  frames_due_ = kFramesAfterChange;
}

// Lets the cursor go where it is needed, or nothing is left to look at; else it stands in the middle of the view.
void ExploreWindow::follow_caught_cursor() {
  if (!display_.has_caught_cursor()) return;
  const bool needs_cursor = state_.help || state_.files || state_.preferences || state_.large_map ||
                            panel_focus_.is_on() || ImGui::GetIO().WantTextInput;
  if (needs_cursor || guide_.inside() != nullptr || session_.mode() == explore::MotionMode::kOrbit)
    return let_cursor_go();
  const ViewArea area = image_layout().eye_area(0);
  cursor_ = {area.x + area.width / 2, area.y + area.height / 2};
}

// Returns where the ground that an eye of a pair sees at `xy` is in the image between the eyes, for which the session
// takes positions; `xy` itself where there is no ground or no pair.
glm::dvec2 ExploreWindow::middle_xy(int eye, glm::dvec2 xy) const {
  if (image_layout().eyes() == 1) return xy;
  const std::optional<mars::LonLat> place = session_.place_at(eye_image(eye).view, xy);
  if (!place) return xy;
  const glm::dvec3 up = mars::direction(*place);
  return xy + parallax_px(eye, up * (session_.ground().radius_m + session_.ground().height_m(up)));
}

// Returns by how much a point is farther right in the image between the eyes than in that of an eye, and lower.
glm::dvec2 ExploreWindow::parallax_px(int eye, const glm::dvec3& point_m) const {
  return core::project(session_.view(), point_m).xy - core::project(eye_image(eye).view, point_m).xy;
}

void ExploreWindow::drag(double time_s) {
  constexpr int kRounds = 3;  // each shrinks the error by the relative change of the distance
  const glm::dvec2 xy = image_layout().xy_of(held_eye_, cursor_);
  const bool holds = session_.mouse_use() == explore::MouseUse::kHold && session_.held_m();
  if (image_layout().eyes() > 1 && holds)
    for (int n = 0; n < kRounds; ++n) {
      held_parallax_px_ = parallax_px(held_eye_, *session_.held_m());
      session_.drag(xy + held_parallax_px_);
    }
  session_.drag(xy + held_parallax_px_, time_s);
}

void ExploreWindow::handle_button(const Event& event) {
  if (event.kind == Event::Kind::kRelease) {
    session_.release(event.time_s);
    return;
  }
  const std::optional<glm::dvec2> over = image_layout().camera_xy(cursor_);
  if (state_.large_map || !over || ImGui::GetIO().WantCaptureMouse) return;
  panel_focus_.leave();
  welcome_.dismiss();
  held_eye_ = image_layout().eye_at(cursor_);
  const glm::dvec2 xy = middle_xy(held_eye_, *over);
  held_parallax_px_ = xy - *over;
  if (event.code == GLFW_MOUSE_BUTTON_LEFT) {
    const bool again = last_press_ && event.time_s - last_press_->first < kDoubleClick_s &&
                       glm::length(last_press_->second - cursor_) < kDoubleClick_px;
    last_press_ = again ? std::nullopt : std::optional(std::pair{event.time_s, cursor_});
    if (again) {
      session_.release();
      session_.fly_towards(xy);
      return;
    }
    const bool tilts = (event.modifiers & GLFW_MOD_SHIFT) != 0;
    const bool looks = (event.modifiers & GLFW_MOD_CONTROL) != 0;
    session_.press(looks   ? explore::MouseUse::kLook
                   : tilts ? explore::MouseUse::kTilt
                           : explore::MouseUse::kHold,
                   xy, event.time_s);
    return;
  }
  session_.press(explore::MouseUse::kTilt, xy, event.time_s);
}

}  // namespace vpe::window
