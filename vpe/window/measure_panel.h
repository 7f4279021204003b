// The measuring panel: what lies under the cursor, places typed, points, distances, profile, line of sight.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/explore/measure/read_out.h"
#include "vpe/explore/session.h"
#include "vpe/window/measurer.h"
#include "vpe/window/widgets.h"

namespace vpe::window {

// What the user asked for in a frame, and what is to be said.
struct MeasureActions {
  std::optional<mars::LonLat> go_to;
  std::string message;  // of something done, or that could not be; empty: nothing new
  bool message_is_trouble = false;
};

// On the window's thread. What takes long is measured on another one.
class MeasurePanel {
 public:
  // `tell` is called on that thread when something is finished: the window shall draw again.
  MeasurePanel(std::shared_ptr<const paging::Surface> surface, std::function<void()> tell);

  // Inside the tab "Measure". The place under the cursor, in view or map; nothing where there is none: then the
  // last one stays.
  MeasureActions draw(const explore::Session& session, std::optional<mars::LonLat> under_cursor,
                      Widgets& widgets);

  // Another point of the way. Places that are none are ignored.
  void add(mars::LonLat place);
  void erase(std::size_t index);
  void clear();
  std::span<const mars::LonLat> points() const { return places_; }
  // The place under a cursor on the plot of the frame drawn last, to be marked in map and view.
  std::optional<mars::LonLat> marked() const;

  // Nothing is measured, and nothing finished waits for the next draw() or draw_marks() to show it.
  bool is_at_rest() const { return measurer_.is_at_rest(); }
  // Takes what is finished; draw() and draw_marks() do so too.
  void update() { take(); }
  // What was measured of the points as they are now; null while that is not finished.
  const Measured* measured() const { return measured_ ? &*measured_ : nullptr; }

  // Points, the way over the ground and the marked place, over a view with its upper left corner at (x0, y0).
  // Casts rays: about a millisecond or two.
  void draw_marks(ImDrawList& list, const explore::Session& session, double x0, double y0);

 private:
  void order();
  void take();
  void draw_read_out(const explore::Session& session, std::optional<mars::LonLat> under_cursor);
  void draw_place(MeasureActions& wish, Widgets& widgets);
  void draw_points(Widgets& widgets);
  void draw_figures();
  void draw_sight(Widgets& widgets);
  void draw_profile(MeasureActions& wish, Widgets& widgets);
  void save(MeasureActions& wish) const;

  std::shared_ptr<const paging::Surface> surface_;
  std::vector<mars::LonLat> places_;
  double from_height_m_ = 2;
  double to_height_m_ = 0;
  std::string place_text_;
  std::optional<mars::LonLat> place_read_;
  std::string place_said_;  // how the text was understood, or what is wrong with it
  std::string file_ = "profile.csv";
  std::vector<explore::ReadOutLine> read_out_;  // of the cursor's last place
  std::string read_out_trouble_;
  std::uint64_t wanted_ = 0;  // order of the points as they are now; 0: none
  std::optional<Measured> measured_;
  std::optional<mars::LonLat> marked_;
  int marked_frame_ = -2;  // ImGui's count of the frame that marked it
  Measurer measurer_;      // last: its thread tells the window
};

}  // namespace vpe::window
