// The panel "Draw": points, lines and polygons, drawn in the view and on the map, with their measures and
// files.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vpe/explore/drawing/drawing_files.h"
#include "vpe/explore/drawing/sketch.h"
#include "vpe/explore/flight_undo.h"
#include "vpe/explore/results/drawing_results.h"
#include "vpe/explore/session.h"
#include "vpe/window/marks/drawing_marks.h"
#include "vpe/window/panels/map_panel.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/widgets.h"
#include "vpe/window/workers/drawing_measurer.h"

namespace vpe::window {

// Holds what the window has to do after input, or after the panel was drawn.
struct DrawingActions {
  std::string message;  // empty: nothing new
  bool message_is_error = false;
  bool saves_project = false;
  std::optional<std::filesystem::path> restore;  // copy of unsaved drawings to open
};

// Holds the drawings, and the order of undo of drawings and flight. For the window's thread; areas are measured
// on another one.
//
// Typical usage:
//   if (panel.handle(event, xy, typing, session, eye_view)) return;  // for each event
//   panel.draw(widgets);                              // inside its tab
//   panel.draw_marks(list, session, cursor, eye);     // over the view
//   show(panel.take_actions());
class DrawingPanel : public MapOverlay {
 public:
  // `flights` must outlive the panel. Files without a folder are written to `folder`. Calls `notify` on the
  // measuring thread when the window should draw again.
  DrawingPanel(explore::FlightController& flights, std::shared_ptr<const paging::Surface> surface,
               std::filesystem::path folder, std::function<void()> notify);

  // Handles an event. `xy` is the cursor's position in the image of `view`, which is that of the session or of one of
  // two eyes, or nullopt over anything else. While `is_typing`, keys belong to a text field. Returns true if nobody
  // else may handle it.
  //
  // With a tool: a click places a vertex, a double click or Enter ends, Backspace takes the last vertex back,
  // Esc cancels; a drag moves the ground as ever. While the panel is shown, a drag of a vertex moves it. Ctrl+Z
  // undoes the last edit of drawings and flight, Ctrl+Shift+Z or Ctrl+Y repeats it, Ctrl+S saves the project.
  bool handle(const Event& event, std::optional<glm::dvec2> xy, bool is_typing, const explore::Session& session,
              const core::View& view);

  // Draws the panel inside its tab.
  void draw(Widgets& widgets);
  // Draws the drawings over the image of an eye. `cursor` is the place under the cursor.
  void draw_marks(ImDrawList& list, const explore::Session& session, std::optional<mars::LonLat> cursor,
                  const EyeImage& eye);

  void draw_on_map(ImDrawList& list, const explore::MapView& map, double x0, double y0) override;
  bool press_on_map(const explore::MapView& map, glm::dvec2 xy) override;
  void drag_on_map(mars::LonLat to) override;
  void release_on_map() override { sketch_.release(); }
  bool click_on_map(const explore::MapView& map, glm::dvec2 xy, double time_s) override;

  // Returns what is to be done since the last call.
  DrawingActions take_actions() { return std::exchange(actions_, {}); }
  // Adds other work to the order of undo; it must outlive the panel.
  void join(explore::UndoStore& store) { history_.join(store); }
  // Reverts the last edit of all that joined, or repeats it, and says so; takes back a vertex while something is drawn.
  void undo(bool again);
  // Takes over what flight and drawings did, in the order of calls.
  void update_history() { history_.update(); }

  // Measures on another surface of the same body from now on. Waits for the measurement that runs.
  void set_surface(std::shared_ptr<const paging::Surface> surface);
  // Sets the copies of unsaved drawings that a button offers.
  void offer(std::vector<std::filesystem::path> abandoned) { abandoned_ = std::move(abandoned); }

  explore::Drawings& drawings() { return drawings_; }
  const explore::Drawings& drawings() const { return drawings_; }
  explore::Sketch& sketch() { return sketch_; }
  const explore::Sketch& sketch() const { return sketch_; }
  // Returns the measures of the selected drawing, or null if they are not finished.
  const MeasuredDrawing* measured() { return measurer_->measured(); }
  bool is_at_rest() const { return measurer_->is_idle(); }

 private:
  bool handle_key(const Event& event, const explore::Session& session);
  bool handle_press(const Event& event, glm::dvec2 xy, const explore::Session& session, const core::View& view);
  bool is_shown() const;
  void place_vertex(mars::LonLat place);
  void report(const std::string& problem);
  void tell(const std::string& text);
  DrawingScene scene() const;
  void draw_tools(Widgets& widgets);
  void draw_list(Widgets& widgets);
  void draw_selected(const explore::Drawing& drawing, Widgets& widgets);
  void draw_measures(const explore::Drawing& drawing);
  void draw_results(const explore::Drawing& drawing, Widgets& widgets);
  void save_results(const explore::DrawingResults& results);
  void draw_vertices(const explore::Drawing& drawing, Widgets& widgets);
  void draw_files(Widgets& widgets);
  std::filesystem::path file(const char* extension) const;
  void save_geojson();
  void save_csv();
  void open();

  std::shared_ptr<const paging::Surface> surface_;
  std::filesystem::path folder_;
  std::function<void()> notify_;
  explore::Drawings drawings_;
  explore::Sketch sketch_;
  explore::FlightUndo flight_undo_;
  explore::UndoHistory history_;
  DrawingMarks marks_;
  DrawingActions actions_;
  std::vector<std::filesystem::path> abandoned_;
  std::string file_ = "drawings.geojson";
  int shown_frame_ = -2;               // ImGui's number of the frame in which the panel was drawn last
  std::optional<glm::dvec2> pressed_;  // with a tool, while the button is down
  std::optional<std::pair<double, glm::dvec2>> last_click_;  // time and place, for double clicks in the view
  std::optional<std::pair<double, glm::dvec2>> last_map_click_;  // likewise on the map
  std::optional<mars::LonLat> cursor_;                           // in view or map
  std::optional<std::pair<std::uint64_t, base::Rgb>> mixing_;    // colour that is being chosen
  std::unique_ptr<DrawingMeasurer> measurer_;                    // last: its thread notifies the window
};

}  // namespace vpe::window
