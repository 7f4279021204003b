// A click of a mouse button that does not move.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <utility>

namespace vpe::window {

// Tells clicks from drags: a press that moves farther than kClick_px, even if it comes back, is a drag.
//
// Typical usage:
//   click.press(xy);                          // on events
//   click.move(xy);
//   if (const auto at = click.release()) open_menu(*at);
class StillClick {
 public:
  static constexpr double kClick_px = 4;

  void press(glm::dvec2 xy) { pressed_ = xy; }
  void move(glm::dvec2 xy) {
    if (pressed_ && glm::length(xy - *pressed_) > kClick_px) pressed_.reset();
  }
  void cancel() { pressed_.reset(); }
  // Returns where the button was pressed, if it did not move since.
  std::optional<glm::dvec2> release() { return std::exchange(pressed_, std::nullopt); }

 private:
  std::optional<glm::dvec2> pressed_;
};

}  // namespace vpe::window
