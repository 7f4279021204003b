// The panel "Ground": reliefs by formulas, put on the ground of the view, dragged and changed.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/explore/files/unsaved_copy.h"
#include "vpe/explore/reliefs/relief_editor.h"
#include "vpe/explore/session.h"
#include "vpe/window/marks/ground_view.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Holds what the window has to do after input, or after the panel was drawn.
struct ReliefsActions {
  std::string message;  // empty: nothing new
  bool message_is_error = false;
  // Reliefs to be put into a planet file that is made of the planet's own.
  std::optional<std::filesystem::path> patch;
};

struct ReliefsPanelLimits {
  static constexpr double kReach_px = 12;         // around the middle of a relief that can be grabbed
  static constexpr double kCopy_s = 0.5;          // between copies of reliefs that are being dragged
  static constexpr double kUsualShare = 0.18;     // of the image's height: size of a relief that a click makes
  static constexpr double kUsualForming_s = 5;    // in a flight
  static constexpr std::size_t kMostMarks = 200;  // each casts a ray
};

// Edits the reliefs of the window's planet. The window asks for images with reliefs(), so that they are seen at once. For the
// window's thread.
//
// Typical usage, in each iteration:
//   if (panel.handle(event, xy, typing, session, eye_view)) return;  // for each event
//   panel.update(now_s);
//   request.reliefs = panel.reliefs();
//   panel.draw(session, widgets);                                    // inside its tab
class ReliefsPanel {
 public:
  // Files without a folder are written to `folder`, copies of unsaved reliefs to `state`, or to `folder` if that is empty.
  // `surface` is that of the planet without reliefs.
  ReliefsPanel(std::shared_ptr<const paging::Surface> surface, std::filesystem::path folder,
               const std::filesystem::path& state);
  // Uses another surface of the same body from now on.
  void set_surface(std::shared_ptr<const paging::Surface> surface) { surface_ = std::move(surface); }

  // Handles an event, as ObjectsPanel::handle() does. While reliefs are placed, a click places one; V does so in the middle of
  // the view, Esc ends it. While the panel is shown, a press on the middle of a relief selects it, a drag moves it over the
  // ground, Delete deletes it, Ctrl+S saves the reliefs.
  bool handle(const Event& event, std::optional<glm::dvec2> xy, bool is_typing, const explore::Session& session,
              const core::View& view);
  bool is_placing() const { return is_placing_; }
  void stop_placing() { is_placing_ = false; }
  // Returns true while a relief is held.
  bool holds() const { return held_.has_value(); }

  // Draws the panel inside its tab.
  void draw(explore::Session& session, Widgets& widgets);
  // Returns true if the last frame showed the panel.
  bool is_shown() const;
  // Draws the outlines of reliefs over the image of an eye, while the panel is shown.
  void draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye);
  // Writes the copy of unsaved reliefs, if it is time.
  void update(double now_s);

  // Returns the reliefs of the images, or null if there are none. The same pointer until they change.
  std::shared_ptr<const std::vector<relief::ReliefSpec>> reliefs();

  // Opens a file of reliefs in place of the present ones, unless these have unsaved changes.
  void open(const std::filesystem::path& file);
  // Returns the copies of reliefs that programs which are gone have left, the newest first; a button opens the first.
  const std::vector<std::filesystem::path>& abandoned() const { return abandoned_; }
  // Returns what is to be done since the last call.
  ReliefsActions take_actions() { return std::exchange(actions_, {}); }
  // Saves reliefs with unsaved changes to a new file, at the end of the window. Returns a message about it, or "".
  std::string exit_message();

  explore::ReliefEditor& editor() { return editor_; }
  const explore::ReliefEditor& editor() const { return editor_; }
  std::uint64_t selected() const { return selected_; }

 private:
  struct Held {
    std::uint64_t id = 0;
    glm::dvec2 press_px{0, 0};
    glm::dvec2 aside_px{0, 0};  // of its middle from the cursor at the press
    bool has_moved = false;
  };

  void report(const std::string& problem);
  void tell(const std::string& text);
  // reliefs_input.cpp:
  bool handle_key(const Event& event, const explore::Session& session);
  bool handle_press(const Event& event, glm::dvec2 xy, const explore::Session& session, const core::View& view);
  void drag(glm::dvec2 xy, const explore::Session& session, const core::View& view);
  void place(std::optional<mars::LonLat> at, const explore::Session& session);
  std::uint64_t relief_at(glm::dvec2 xy, const explore::Session& session, const core::View& view) const;
  // reliefs_panel.cpp:
  void draw_tools(Widgets& widgets);
  void draw_list(explore::Session& session, Widgets& widgets);
  void draw_selected(Widgets& widgets);
  bool draw_key(relief::ReliefSpec& relief, std::size_t key, Widgets& widgets);
  bool draw_size(const std::string& label, std::size_t key, double& size, Widgets& widgets);
  void draw_files(const explore::Session& session, Widgets& widgets);
  // reliefs_files.cpp:
  std::filesystem::path typed_file() const;
  void save();
  void save_flight(const explore::Session& session);
  void patch();
  void restore(const std::filesystem::path& copy);

  std::shared_ptr<const paging::Surface> surface_;
  explore::ReliefEditor editor_;
  std::filesystem::path folder_;
  explore::UnsavedCopy copy_;
  std::vector<std::filesystem::path> abandoned_;
  double next_copy_s_ = 0;
  std::string file_;                           // in its field
  std::optional<std::filesystem::path> open_;  // file that was opened or saved last
  int kind_ = 0;                               // of reliefs that are placed
  std::uint64_t selected_ = 0;
  bool is_placing_ = false;
  std::optional<glm::dvec2> pressed_;  // while reliefs are placed and the button is down
  std::optional<Held> held_;
  std::map<std::size_t, std::pair<double, double>> ranges_;  // of sliders, by key; they stay while one is held
  std::string slides_;                                       // the edit by a slider that is held, or ""
  double forming_s_ = ReliefsPanelLimits::kUsualForming_s;
  int shown_frame_ = -2;  // ImGui's number of the frame in which the panel was drawn last
  std::shared_ptr<const std::vector<relief::ReliefSpec>> reliefs_;
  std::uint64_t reliefs_revision_ = 0;  // that reliefs_ is of
  ReliefsActions actions_;
};

}  // namespace vpe::window
