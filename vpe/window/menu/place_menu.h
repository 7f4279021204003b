// The menu that a right click opens over view and map: what is there, and what can be done from there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/explore/measure/read_out.h"
#include "vpe/explore/results/place_report.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Names what the user chose.
enum class PlaceChoice { kCopy, kMeasureFrom, kProfileTo, kViewshedFrom, kPanoramaFrom };

// Describes what the menu offers.
struct PlaceOffer {
  std::string profile_from;  // where a profile would begin, such as "point B" or "the camera"
  bool can_make = false;     // files can be made here
  std::string why_not;       // a panorama or viewshed cannot be made; empty: they can
};

// Draws the menu. For the window's thread.
//
// Typical usage:
//   menu.open(place, explore::what_is_here(surface, place, names), reach_m);   // after a right click
//   if (const auto choice = menu.draw(offer, widgets)) act(*choice, menu.place());
class PlaceMenu {
 public:
  static constexpr double kUsualHeight_m = 2;
  static constexpr double kMostHeight_m = 1e9;

  // Opens the menu at the cursor in the next draw(). A viewshed reaches `reach_m` metres.
  void open(mars::LonLat place, const explore::PlaceReport& report, double reach_m);
  // Closes it in the next draw(). Returns false if it is not open.
  bool close();
  bool is_open() const { return is_open_; }

  // Draws the menu while it is open. Returns what was chosen in this frame; then the menu is closed.
  std::optional<PlaceChoice> draw(const PlaceOffer& offer, Widgets& widgets);

  mars::LonLat place() const { return place_; }
  // Returns the lines of the report as text.
  std::string text() const;
  // Returns the height of the eye above the ground, metres, as the user has set it last, and the reach of a viewshed.
  double height_m() const { return height_m_; }
  double reach_m() const { return reach_m_; }

 private:
  mars::LonLat place_;
  std::vector<explore::ReadOutLine> lines_;
  double height_m_ = kUsualHeight_m;
  double reach_m_ = 0;
  bool opens_ = false;
  bool closes_ = false;
  bool is_open_ = false;
};

}  // namespace vpe::window
