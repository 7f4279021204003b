// The panel "Objects": the objects of a scene file, placed and moved on the ground of the view.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vpe/base/file.h"
#include "vpe/core/object_track.h"
#include "vpe/explore/files/unsaved_copy.h"
#include "vpe/explore/objects/item_balls.h"
#include "vpe/explore/objects/object_view.h"
#include "vpe/explore/objects/scene_clock.h"
#include "vpe/explore/objects/scene_editor.h"
#include "vpe/explore/session.h"
#include "vpe/window/marks/ground_view.h"
#include "vpe/window/objects/model_sizes.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Holds what the window has to show after input, or after the panel was drawn.
struct ObjectsActions {
  std::string message;  // empty: nothing new
  bool message_is_error = false;
};

struct ObjectsPanelLimits {
  static constexpr double kShortestCopy_s = 0.1;   // between copies of a scene that is being dragged
  static constexpr double kCopyShare = 0.1;        // of the time that writing copies may take
  static constexpr double kLookAgain_s = 1;        // for changes of the file by others
  static constexpr double kReach_px = 6;           // around objects that are seen smaller
  static constexpr std::size_t kMostItems = 5000;  // that have marks and can be clicked: the first ones
};

// Edits the scene of the session's setting `scene`, and shows it at once: while it has unsaved changes, images are drawn
// from a copy of it in the state folder, which is also what is left when the program is killed. The setting keeps the name
// of the file. For the window's thread; models are measured on another one.
//
// Typical usage, in each iteration:
//   if (panel.handle(event, xy, typing, session, eye_view)) return;  // for each event
//   panel.update(now_s, draws);
//   panel.advance(dt_s, moves_by_hand, session);                     // after the session
//   request.scene = panel.shown_file(session);
//   panel.draw(session, widgets);                                    // inside its tab
class ObjectsPanel {
 public:
  // Files without a folder are written to `folder`, copies of unsaved scenes to `state`, or to `folder` if that is empty.
  // `measure` finds the balls of models on a thread, and may be empty. Calls `notify` there when the window should draw
  // again.
  ObjectsPanel(explore::ModelBall measure, std::filesystem::path folder, const std::filesystem::path& state,
               std::function<void()> notify);

  // Handles an event. `xy` is the cursor's position in the image of `view`, which is that of the session or of one of two
  // eyes, or nullopt over anything else. While `is_typing`, keys belong to a text field. Returns true if nobody else may
  // handle it.
  //
  // While objects are placed, a click places one; V does so in the middle of the view, Esc ends it. While the panel is
  // shown, a press on an object selects it, a drag moves it over the ground unless the flight does, Delete deletes it,
  // Ctrl+S saves the scene.
  // While an object is followed, drags turn about it, the wheel changes the distance, and Esc ends it.
  bool handle(const Event& event, std::optional<glm::dvec2> xy, bool is_typing, explore::Session& session,
              const core::View& view);
  // Returns true while a click places an object.
  bool is_placing() const { return is_placing_; }
  void stop_placing() { is_placing_ = false; }
  // Returns true while an object or the view about one is held.
  bool holds() const { return held_.has_value() || turning_.has_value(); }

  // Draws the panel inside its tab.
  void draw(explore::Session& session, Widgets& widgets);
  // Returns true if the last frame showed the panel.
  bool is_shown() const;
  // Draws the marks of objects over the image of an eye, while the panel is shown.
  void draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye);

  // Runs the time of the scene, and lets the camera follow. Motion by hand and any other flight end the following.
  void advance(double dt_s, bool moves_by_hand, explore::Session& session);
  // Writes the copy if the scene has changed and it is time. `draws` says that an image is being drawn, which may still read
  // the copy. Returns true if the panel should be drawn again.
  bool update(double now_s, bool draws);

  // Returns the scene file of images: that of the setting, or the copy while there are unsaved changes to it.
  std::string shown_file(const explore::Session& session) const;
  // Returns a number that grows with each change of that file.
  std::uint64_t shown_revision() const { return copies_; }
  // Returns the time of the scene: that of the flight while it is followed, else the panel's own.
  double time_s() const { return time_s_; }
  // Returns true while something moves, or waits to be shown.
  bool is_moving() const { return clock_.plays() || is_due_; }
  bool is_at_rest() const { return !is_moving() && sizes_.is_at_rest(); }

  // Opens a scene file in place of the present one, unless that has unsaved changes.
  void open(const std::filesystem::path& file, explore::Session& session);
  // Returns the copies of scenes that programs which are gone have left, the newest first; a button opens the first.
  const std::vector<std::filesystem::path>& abandoned() const { return abandoned_; }
  // Returns what is to be shown since the last call.
  ObjectsActions take_actions() { return std::exchange(actions_, {}); }
  // Saves a scene with unsaved changes to a new file, at the end of the window. Returns a message about it, or "".
  std::string exit_message();

  explore::SceneEditor& editor() { return editor_; }
  const explore::SceneEditor& editor() const { return editor_; }
  std::uint64_t selected() const { return selected_; }
  std::uint64_t followed() const { return follow_ ? follow_->id : 0; }

 private:
  struct Held {
    std::uint64_t id = 0;
    glm::dvec2 press_px{0, 0};
    glm::dvec2 aside_px{0, 0};  // of its origin from the cursor at the press
    bool has_moved = false;
  };
  struct Turning {
    int button = 0;
    glm::dvec2 last_px{0, 0};
  };
  struct Following {
    std::uint64_t id = 0;
    explore::ObjectOffset offset;
    bool arrives = false;  // the camera flies there
  };
  using Balls = std::vector<explore::ItemBall>;

  void report(const std::string& problem);
  void tell(const std::string& text);
  // objects_input.cpp:
  bool handle_key(const Event& event, explore::Session& session);
  bool handle_press(const Event& event, glm::dvec2 xy, const explore::Session& session, const core::View& view);
  void drag(glm::dvec2 xy, const explore::Session& session, const core::View& view);
  void turn(glm::dvec2 xy, const explore::Session& session);
  void place(std::optional<mars::LonLat> at, const explore::Session& session);
  std::uint64_t item_at(glm::dvec2 xy, const explore::Session& session, const core::View& view);
  const Balls& balls(const explore::SharedItem& item, const explore::Session& session);
  std::optional<explore::ItemBall> ball_of(std::uint64_t id, const explore::Session& session);
  void leave_flight(explore::Session& session);
  void go_to(std::uint64_t id, explore::Session& session);
  void follow(std::uint64_t id, explore::Session& session);
  // objects_panel.cpp:
  void draw_tools(explore::Session& session, Widgets& widgets);
  void draw_models(Widgets& widgets);
  void draw_list(explore::Session& session, Widgets& widgets);
  void draw_selected(explore::Session& session, Widgets& widgets);
  void draw_placing(const explore::SceneItem& item, const explore::Session& session, Widgets& widgets);
  void draw_time(Widgets& widgets);
  void draw_file(explore::Session& session, Widgets& widgets);
  void select(std::uint64_t id);
  // objects_files.cpp:
  void follow_setting(const explore::Session& session);
  void load(const std::string& setting);
  void save(explore::Session& session);
  void restore(const std::filesystem::path& copy, const explore::Session& session);
  void take_model(const std::string& text);
  std::filesystem::path typed_file() const;

  explore::SceneEditor editor_;
  ModelSizes sizes_;
  std::filesystem::path folder_;
  explore::UnsavedCopy copy_;
  std::vector<std::filesystem::path> abandoned_;
  std::uint64_t copies_ = 0;  // written or removed
  std::uint64_t copied_ = 0;  // SceneEditor::revision() of the copy; 0: there is none
  double next_copy_s_ = 0;    // not before
  bool is_due_ = false;       // a copy
  bool has_copy_ = false;
  std::optional<std::string> setting_;  // `scene` that was loaded
  std::string refused_setting_;         // that was not loaded, as there were unsaved changes
  std::optional<base::FileStamp> stamp_;
  double looked_s_ = 0;  // at the stamp
  double now_s_ = 0;
  std::string file_;  // in its field
  std::string model_text_;
  std::vector<objects::ModelEntry> typed_models_;  // that no object has yet
  int model_ = 0;                                  // of the scene's models, then of those
  std::uint64_t selected_ = 0;
  bool scrolls_to_selected_ = false;
  bool is_placing_ = false;
  std::optional<glm::dvec2> pressed_;                        // while objects are placed and the button is down
  std::optional<std::pair<double, glm::dvec2>> last_click_;  // that placed one, and its time
  std::optional<Held> held_;
  std::optional<Turning> turning_;
  std::optional<Following> follow_;
  explore::SceneClock clock_;
  std::uint64_t clock_revision_ = 0;  // of the scene that gave its range
  double time_s_ = 0;
  bool follows_flight_ = false;
  std::shared_ptr<const std::vector<core::ObjectTrack>> tracks_;  // of objects, by the flight that is followed
  int shown_frame_ = -2;  // ImGui's number of the frame in which the panel was drawn last
  std::map<explore::SharedItem, Balls> balls_;
  struct BallsOf {
    const paging::Surface* surface = nullptr;
    double exaggeration = 1;
    std::uint64_t sizes = 0;
    std::shared_ptr<const std::vector<core::ObjectTrack>> tracks;
    bool operator==(const BallsOf&) const = default;
  } balls_of_;
  ObjectsActions actions_;
};

}  // namespace vpe::window
