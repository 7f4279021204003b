// The panel "Flight": playback, waypoints, recording.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vpe/core/view.h"
#include "vpe/explore/session.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Holds what the window has to do after the panel was drawn.
struct FlightActions {
  std::optional<bool> record;                    // start or stop recording
  std::optional<std::filesystem::path> restore;  // copy of an unsaved flight to open
  std::string message;                           // empty: nothing new
  bool message_is_error = false;
};

// Draws the panel and edits the session's flight. For the window's thread.
class FlightPanel {
 public:
  // `file` is where the flight is saved; empty: a new file in `folder`.
  FlightPanel(std::string file, std::filesystem::path folder);

  // Draws the panel inside its tab.
  FlightActions draw(explore::Session& session, bool is_recording, Widgets& widgets);

  // Handles an event. `xy` is the cursor's position in the image of `view`, which is that of the session or of one of
  // two eyes, or nullopt over anything else. While the panel is shown and no flight is followed, a press on the mark of
  // a pose selects it, and a drag moves it over the ground with its altitude or height kept, as one step of undo. Returns
  // true if nobody else may handle the event.
  bool handle(const Event& event, std::optional<glm::dvec2> xy, explore::Session& session,
              const core::View& view);
  // Returns true while a pose is held.
  bool holds_pose() const { return held_.has_value(); }

  // Opens a flight from a file, unless the present one has unsaved changes.
  FlightActions open_file(const std::string& file, explore::Session& session);

  // Sets the copies of unsaved flights that a button offers while there is no flight.
  void offer(std::vector<std::filesystem::path> abandoned) { abandoned_ = std::move(abandoned); }

  // Returns the ground speed to waypoints that are added: the one that was typed, else that of keys at the camera's
  // height.
  double ground_speed_m_s(const explore::Session& session) const;
  // Returns the pose that is marked in the list.
  std::size_t selected() const { return static_cast<std::size_t>(waypoint_); }

 private:
  struct HeldPose {
    std::size_t index = 0;
    glm::dvec2 aside_px{0, 0};  // of its mark from the cursor at the press
    bool has_moved = false;
  };
  bool is_shown() const;
  bool take_pose(const Event& event, glm::dvec2 xy, explore::Session& session, const core::View& view);
  void drag_pose(glm::dvec2 xy, explore::Session& session, const core::View& view);
  static void draw_player(explore::Session& session, Widgets& widgets);
  void draw_empty(explore::Session& session, FlightActions& actions, Widgets& widgets);
  void draw_file(explore::Session& session, FlightActions& actions, Widgets& widgets);
  void draw_waypoints(explore::Session& session, FlightActions& actions, Widgets& widgets);
  void draw_list(const std::vector<scripts::Waypoint>& waypoints, Widgets& widgets);
  void open(explore::Session& session, FlightActions& actions);
  void save(explore::FlightEditor& editor, FlightActions& actions);

  std::string file_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> abandoned_;
  double ground_speed_m_s_ = 0;  // 0: by height
  int waypoint_ = 0;             // selected in the list
  int shown_frame_ = -2;         // ImGui's number of the frame in which the panel was drawn last
  std::optional<HeldPose> held_;
  FlightActions pending_;  // of handle(), for the next draw()
};

// Reads and parses a flight of any length. Throws base::FileError.
scripts::ParsedFlight read_flight_file(const std::filesystem::path& file);

// Returns a new name in a folder: "vpe-KIND20261122-150405.png", with a number added if the file exists.
std::filesystem::path new_file(const std::filesystem::path& folder, const std::string& kind,
                               const std::string& extension);

}  // namespace vpe::window
