// The panel "Appearance": looks in words, light by a dial, and every setting below.
#pragma once

#include <string>

#include "vpe/explore/session.h"
#include "vpe/window/ui/widgets.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Draws the panel inside its tab and applies changes to the session. For the window's thread.
class AppearancePanel {
 public:
  // `drawn` is the image shown last, or null. `has_imagery`: the planet has images, whose stretch can be set. Returns what is wrong with a changed setting, or "".
  std::string draw(explore::Session& session, const DrawnImage* drawn, bool has_imagery, Widgets& widgets);

 private:
  void set(const std::string& key, const std::string& text);
  void set(const std::string& key, double value);
  std::string get(const char* key) const;
  void draw_looks();
  void draw_palette();
  void draw_sun();
  void draw_dial(double azimuth_deg, double elevation_deg);
  void draw_season();
  void draw_air();
  void draw_imagery();

  std::string filter_;
  // For one frame.
  explore::Session* session_ = nullptr;
  Widgets* widgets_ = nullptr;
  bool has_imagery_ = false;
  std::string error_;
};

}  // namespace vpe::window
