// The keyboard in the panels: which window its arrows, Space and Enter act in.
#pragma once

#include <optional>

#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Gives the keyboard to one window after another. While a window has it, Dear ImGui moves a highlight by arrows, presses
// by Space, and edits by Enter. For the window's thread.
class PanelFocus {
 public:
  bool is_on() const { return at_.has_value(); }
  // Gives the keyboard to the next window that is shown, the first one at first; after the last one nobody has it. Call it
  // between frames.
  void next();
  void leave();
  // Puts the highlight on the first widget of a window that has just got the keyboard. Call it as a frame begins.
  void begin_frame();
  // Returns where the highlight is, or nullopt.
  static std::optional<WidgetPlace> highlight();

 private:
  std::optional<std::size_t> at_;  // index of the window
  bool is_new_ = false;            // the highlight is not there yet
};

}  // namespace vpe::window
