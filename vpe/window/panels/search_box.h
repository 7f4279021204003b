// The search box: names of places and coordinates in one field, with a list of what was found below it.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "vpe/explore/places/place_search.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Draws the field and its list. For the window's thread.
//
// Typical usage:
//   if (const std::optional<core::Place> place = box.draw(width_px, widgets)) fly_to(*place);
class SearchBox {
 public:
  static constexpr std::size_t kMostFound = 9;

  explicit SearchBox(explore::PlaceSearch places) : places_(std::move(places)) {}

  const explore::PlaceSearch& places() const { return places_; }
  // Gives the field the keyboard in the next frame.
  void focus() { takes_focus_ = true; }
  bool takes_focus() const { return takes_focus_; }
  // Returns true while the list is shown; clicks on it are not those of the view.
  bool is_open() const { return is_open_; }

  // Draws the field in the present ImGui window, and while text is typed the list of what is found over what is below.
  // Up and Down move its mark, which begins at the first place; Tab makes the marked name the text. Returns the place that
  // was chosen: by Enter the marked one, or by a click. Coordinates have no diameter, and their text as name.
  std::optional<core::Place> draw(double width_px, Widgets& widgets);

 private:
  struct Found {
    core::Place place;
    std::string detail;
  };
  void find();
  bool completes() const;  // whether Tab has a name to set
  std::optional<core::Place> draw_list(ImVec2 corner, double width_px, Widgets& widgets);
  static int on_edit(ImGuiInputTextCallbackData* data);

  explore::PlaceSearch places_;
  std::string text_;
  std::vector<Found> found_;
  std::string fault_;  // what was expected, if nothing was found
  int marked_ = 0;     // of found_
  bool is_open_ = false;
  bool takes_focus_ = false;
};

}  // namespace vpe::window
