// Screens of the session that have windows of their own: a head before or among them sees the world through them.
#include <algorithm>
#include <string>

#include "vpe/window/explore_window.h"

namespace vpe::window {

MakePainter ExploreWindow::screen_painter() const {
  return setup_.make_screen_painter ? setup_.make_screen_painter : setup_.make_painter;
}

void ExploreWindow::open_screens() {
  if (!setup_.screens) return;
  screens_ = std::make_unique<ScreenWindows>(*setup_.screens, screen_painter(), [] { Display::wake(); });
  for (const std::string& note : screens_->notes()) show_message(note);
}

// The camera of the session without the head is the platform: the head's place is added in the room.
void ExploreWindow::update_screens(const explore::HeadPlace& head) {
  if (screens_ == nullptr) return;
  const explore::DrawChoice& chosen = chooser_.choice();
  ScreenScene scene;
  scene.base = request_of(session_.view(), chosen);
  scene.state = std::to_string(session_.changes()) + " " + std::string(core::to_string(state_.backend)) + " " +
                image_state(chosen);
  scene.platform =
      explore::screen_platform(session_.pose(), screens_->set().is_level, session_.ground().radius_m);
  scene.head = head;
  scene.nearest_m = std::max(session_.height_m(), 0.5);
  scene.budget_ms = session_.settings().values().lod_frame_ms;
  if (screens_->update(scene)) frames_due_ = std::max(frames_due_, 1);
  if (screens_->error() != screens_error_) {
    screens_error_ = screens_->error();
    if (!screens_error_.empty()) show_message("screens: " + screens_error_, true);
  }
}

}  // namespace vpe::window
