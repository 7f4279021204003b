// Tells in a new window how to move, and offers places to begin with.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "vpe/explore/places/place_search.h"
#include "vpe/window/ui/imgui_helpers.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Shown until the user's first input. For the window's thread.
class Welcome {
 public:
  // Offers the sights of Mars that the list has, else its first places.
  explicit Welcome(const explore::PlaceSearch& places);

  bool is_shown() const { return is_shown_; }
  void dismiss() { is_shown_ = false; }
  // Draws the line and the buttons over the lower part of a view. Returns the place whose button was pressed.
  std::optional<core::Place> draw(const ViewArea& area, double scale, Widgets& widgets);

 private:
  std::vector<core::Place> sights_;
  bool is_shown_ = true;
};

}  // namespace vpe::window
