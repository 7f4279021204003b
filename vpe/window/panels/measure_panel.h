// The panel "Measure": place under the cursor, typed places, points, distances, profile, line of sight among objects.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/explore/measure/read_out.h"
#include "vpe/explore/results/measure_path.h"
#include "vpe/explore/session.h"
#include "vpe/window/marks/ground_view.h"
#include "vpe/window/ui/widgets.h"
#include "vpe/window/workers/measurer.h"

namespace vpe::window {

// Holds what the window has to do after the panel was drawn.
struct MeasureActions {
  std::optional<mars::LonLat> go_to;
  bool undoes = false;  // the last edit, whatever it was of
  bool redoes = false;
  std::string message;  // empty: nothing new
  bool message_is_error = false;
};

// Draws the panel and holds the points. For the window's thread; slow measurements run on another one.
//
// Typical usage:
//   panel.add(place);                                                 // a point of the path
//   const MeasureActions actions = panel.draw(session, under_cursor, widgets);
//   panel.draw_marks(list, session, eye);                             // over the view
class MeasurePanel {
 public:
  // Calls `notify` on the measuring thread when a measurement is finished and the window should draw again. Calls
  // `open_scene` there, while a scene is set; empty: objects do not count.
  MeasurePanel(std::shared_ptr<const paging::Surface> surface, std::function<void()> notify,
               explore::OpenScene open_scene = {});

  // Draws the panel inside its tab. `under_cursor` is the place under the cursor in view or map; without one
  // the last place stays.
  MeasureActions draw(const explore::Session& session, std::optional<mars::LonLat> under_cursor,
                      Widgets& widgets);

  static constexpr double kStrip_px = 200;  // height that draw_profile() needs, at scale 1

  // Draws the profile of the path and its buttons in the present ImGui window, as wide and high as that. Draws
  // nothing for fewer than two points.
  MeasureActions draw_profile(Widgets& widgets);

  // Measures on another surface of the same body from now on. Waits for the measurement that runs.
  void set_surface(std::shared_ptr<const paging::Surface> surface, explore::OpenScene open_scene = {});

  // Sets the scene whose objects lines of sight regard. When it differs, measures the path again; until that is done the
  // former measurement stays.
  void set_scene(explore::SightScene scene);

  // Adds a point to the path. Ignores invalid places.
  void add(mars::LonLat place);
  // Begins the path anew with one point.
  void begin_at(mars::LonLat place);
  // Goes on to a place from the last point, or else from `begin`.
  void go_on_to(mars::LonLat place, mars::LonLat begin);
  void erase(std::size_t index);
  void clear();
  std::span<const mars::LonLat> points() const { return path_.places(); }
  // Returns the path, a store of an order of undo. What is undone is measured again in update().
  explore::UndoStore& path() { return path_; }
  // Returns the place under a cursor on the plot of the last frame, to be marked in map and view.
  std::optional<mars::LonLat> marked() const;

  // Returns true if nothing is being measured, and no result waits for update().
  bool is_at_rest() const { return measurer_->is_idle() && path_.revision() == measured_revision_; }
  // Measures the path again if it was edited or undone, and takes a finished result. draw() and draw_marks() take it too.
  void update();
  // Returns the measurement of the present points, or null if it is not finished.
  const Measured* measured() const { return measured_ ? &*measured_ : nullptr; }

  // Draws points, path and marked place over the image of an eye. Casts rays, which takes one or two milliseconds.
  void draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye);

 private:
  void request();
  void measure();
  void take();
  bool is_of_scene(const Measured& measured) const;
  void draw_read_out(const explore::Session& session, std::optional<mars::LonLat> under_cursor);
  void draw_place(MeasureActions& actions, Widgets& widgets);
  void draw_points(MeasureActions& actions, Widgets& widgets);
  void draw_values();
  void draw_sight(Widgets& widgets);
  void save(MeasureActions& actions) const;
  void copy(MeasureActions& actions) const;
  std::string results_text() const;

  std::shared_ptr<const paging::Surface> surface_;
  explore::MeasurePath path_;
  std::uint64_t measured_revision_ = path_.revision();  // of the path that was requested last
  std::string place_text_;
  std::optional<mars::LonLat> place_read_;
  std::string place_reply_;  // how the text was understood, or what is wrong with it
  std::string file_ = "profile.csv";
  std::vector<explore::ReadOutLine> read_out_;  // of the cursor's last place
  std::string read_out_error_;
  explore::SightScene scene_;
  std::uint64_t wanted_ = 0;  // request for the present points; 0: none
  std::optional<Measured> measured_;
  std::optional<mars::LonLat> marked_;
  int marked_frame_ = -2;  // ImGui's number of the frame that marked it
  std::function<void()> notify_;
  std::unique_ptr<Measurer> measurer_;  // last: its thread notifies the window
};

}  // namespace vpe::window
