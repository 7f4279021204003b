// The window of `vpe explore`: the view, the map, panels and a status line.
#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/core/drawn_by.h"
#include "vpe/explore/command_words.h"
#include "vpe/explore/draw_choice.h"
#include "vpe/explore/drawing/bookmark_list.h"
#include "vpe/explore/drawing/project.h"
#include "vpe/explore/files/bookmarks.h"
#include "vpe/explore/files/preferences.h"
#include "vpe/explore/files/unsaved_copy.h"
#include "vpe/explore/files/view_history.h"
#include "vpe/explore/flight_backup.h"
#include "vpe/explore/images/live_image.h"
#include "vpe/explore/session.h"
#include "vpe/window/devices.h"
#include "vpe/window/explore_layout.h"
#include "vpe/window/hotspot_guide.h"
#include "vpe/window/image_layout.h"
#include "vpe/window/layers/layers_panel.h"
#include "vpe/window/menu/place_menu.h"
#include "vpe/window/menu/still_click.h"
#include "vpe/window/moved_image.h"
#include "vpe/window/objects/objects_panel.h"
#include "vpe/window/panels/appearance_panel.h"
#include "vpe/window/panels/drawing_panel.h"
#include "vpe/window/panels/file_panel.h"
#include "vpe/window/panels/flight_panel.h"
#include "vpe/window/panels/map_panel.h"
#include "vpe/window/panels/measure_panel.h"
#include "vpe/window/panels/places_panel.h"
#include "vpe/window/panels/preferences_panel.h"
#include "vpe/window/panels/search_box.h"
#include "vpe/window/panels/status_line.h"
#include "vpe/window/panels/welcome.h"
#include "vpe/window/reliefs/reliefs_panel.h"
#include "vpe/window/screens/screen_windows.h"
#include "vpe/window/session_recorder.h"
#include "vpe/window/shared_images.h"
#include "vpe/window/swipe_line.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/imgui_helpers.h"
#include "vpe/window/ui/panel_focus.h"
#include "vpe/window/ui/widgets.h"
#include "vpe/window/workers/image_maker.h"
#include "vpe/window/workers/job.h"
#include "vpe/window/workers/painter.h"
#include "vpe/window/workers/planet_opener.h"

namespace vpe::window {

class ExploreWindow;

struct ExploreSetup : ShownPlanet {
  // Makes a finer planet file of the same body, which replaces the first one in the window. Called on a thread of its own.
  // Empty: there is none.
  MakePlanet make_finer;
  explore::SessionOptions session;
  core::DrawnBy drawn_by = core::DrawnBy::kAuto;
  bool has_gpu = false;  // for kAuto
  // Returns whether rays draw the same image as triangles; for kAuto. Empty: always.
  std::function<bool(const core::DrawRequest&)> suits_rays;
  // Returns a request with the backend and the mode of rays that the painter draws it with; for logs. Empty: those of
  // the request.
  std::function<ImageRequest(ImageRequest)> as_drawn;
  // Returns the unit, body-fixed direction of the sun.
  std::function<glm::dvec3(const core::SettingsValues&, const mars::Pose&)> sun;
  OpenPlanet open_planet;  // for files that are opened or dropped; called on a thread of its own
  // Returns true for a file of which a planet file is built first, and for "", the embedded Mars; a job does that where
  // there are jobs.
  std::function<bool(const std::string& file)> builds_first;
  StartJob start_job;               // for what is made of the session; empty: nothing can be made
  std::vector<std::string> recent;  // files opened last, the newest first
  std::vector<explore::Hotspot> hotspots;
  OpenOverlook open_overlook;  // opens the panorama of a hotspot; required with hotspots
  DisplayOptions display;
  explore::Preferences preferences;
  DeviceSources devices;
  std::filesystem::path preferences_file;  // empty: changes last as long as the window
  std::filesystem::path bookmarks;         // file; empty: there are no bookmarks
  std::filesystem::path folder;            // for images, logs and flights; empty: the working directory
  std::filesystem::path state;             // folder for copies of unsaved flights; empty: there are none
  // Called with a window whose view or panels have changed, after a while and at most every few seconds, so that
  // the session can be kept before the program ends. May be empty.
  std::function<void(const ExploreWindow&)> keep_session;
  std::filesystem::path log;  // file to record from the start; empty: none
  std::optional<scripts::Flight> flight;
  std::string flight_file;  // where the flight is saved
  // A project that is open: its drawings, bookmarks, flight and overlays. Settings, view and regions are in
  // `session`.
  std::optional<explore::Project> project;
  std::filesystem::path project_file;   // where it is saved; empty: a new file
  std::filesystem::path planet_file;    // that a project names; empty: the embedded Mars
  std::filesystem::path hotspots_file;  // likewise; empty: none
  bool panels = true;                   // shown at the start
  double side_px = 0;                   // width of the side panel at scale 1; 0: LayoutLimits::kSide_px
  double letters = 0;                   // scale of text and panels chosen earlier; 0: that of `display`
  std::vector<core::Place> places;      // that the search box finds
  std::string places_file;              // the same, for names over the image; empty: there is none
  bool greets = false;                  // says at the start how to move
  std::string reliefs_file;             // of reliefs that are shown at the start; empty: none
  explore::ModelBall model_ball;  // of objects that are edited; called on a thread; empty: they count as 1 m
  // Returns a command that draws the present view, to be copied. Empty: there is none.
  std::function<std::string(const explore::Session&)> command_line;
  // Screens that have windows of their own, and what draws their images; without a painter make_painter does.
  std::optional<explore::ScreenSet> screens;
  MakePainter make_screen_painter;
  int threads = 0;
};

// Holds the state of the window apart from the session.
struct WindowState {
  static constexpr double kSlowest = 0.05;
  static constexpr double kFastest = 20;

  core::DrawnBy drawn_by = core::DrawnBy::kAuto;
  core::Backend backend = core::Backend::kPolygon;  // of the last image that was requested
  std::optional<core::StereoLayout> stereo;
  double eye_base_m = 0;     // 0: a thirtieth of the height above ground
  double convergence_m = 0;  // where both eyes' images coincide; 0: infinitely far
  double speed = 1;          // factor on motion by hand, kSlowest to kFastest
  bool panels = true;
  double side_px = 0;         // width of the side panel at scale 1; 0: LayoutLimits::kSide_px
  bool side_is_open = false;  // in a narrow window
  double letters = 0;  // scale of text and panels that was chosen; 0: the usual one. A small window has less.
  double letters_slid = 0;  // while the slider is held; 0: it is not
  bool help = false;
  bool files = false;        // the window "File" is open
  bool preferences = false;  // and the window "Preferences"
  bool large_map = false;
  explore::MapStyle map_style = explore::MapStyle::kElevation;
  std::string message;  // about the last action or error
  bool message_is_error = false;
  double message_since_s = 0;
  std::string image_error;  // why there is no image for the present settings; empty: there is one
};

// Runs the window. For the main thread.
//
// Typical usage:
//   ExploreWindow window(std::move(setup));
//   window.run();
//   if (const std::string message = window.exit_message(); !message.empty()) print(message);
class ExploreWindow {
 public:
  // Throws DisplayError.
  explicit ExploreWindow(ExploreSetup setup);
  ~ExploreWindow();

  // Runs until the window is closed or another planet is to be shown.
  void run();
  // Returns the planet that was dropped on the window and is to be shown next, or null.
  const std::shared_ptr<const paging::PlanetFile>& next_planet() const { return next_planet_; }
  const std::string& next_planet_file() const { return opener_.file(); }
  // Returns the project that next_planet() belongs to, or an empty path.
  const std::filesystem::path& next_project() const { return next_project_; }
  // Returns the files opened last, the newest first.
  const std::vector<std::string>& recent() const { return files_.recent(); }
  // Returns the commands, as words, of what is still being made or built and stops with the window.
  std::vector<std::vector<std::string>> unfinished() const;
  // Saves a flight with unsaved changes to a new file. Returns a message about it for the time after the window
  // was closed, or "" if there is no such flight.
  std::string exit_message();
  // Does the same for drawings and bookmarks of a project.
  std::string drawings_message();
  // Returns the project as it is now.
  explore::Project project() const;
  // Does the same for a scene of objects.
  std::string objects_message() { return objects_.exit_message(); }
  // Does the same for reliefs.
  std::string reliefs_message() { return reliefs_.exit_message(); }
  DrawingPanel& drawing() { return drawing_; }
  ObjectsPanel& objects() { return objects_; }
  ReliefsPanel& reliefs() { return reliefs_; }
  LayersPanel& layers() { return layers_; }
  const MeasurePanel& measure() const { return measure_; }
  // Runs one iteration of the event loop: events, devices, panels, an image if one is due. Waits for events for
  // at most `wait_s` seconds if there is nothing to do. Returns false if the window was closed.
  bool step(double wait_s);

  explore::Session& session() { return session_; }
  const explore::Session& session() const { return session_; }
  const WindowState& state() const { return state_; }
  const Widgets& widgets() const { return widgets_; }
  Display& display() { return display_; }
  const Display& display() const { return display_; }
  const Devices& devices() const { return devices_; }
  // Returns the image shown last, or null before the first, and its pixels.
  const DrawnImage* drawn() const { return drawn_ ? &*drawn_ : nullptr; }
  const core::RgbImage& image() const;
  // Returns what keeps images of triangles in OpenGL.
  const SharedImages& shared_images() const { return shared_; }
  // Returns the line between the earlier planet and this one.
  const SwipeLine& swipe_line() const { return swipe_; }
  // Returns the view that the last frame shows, by its image or by one that follows the camera, or null before the first.
  const core::View* shown_view() const { return shown_view_ ? &*shown_view_ : nullptr; }
  // Returns true if nothing moves, loads or waits to be drawn.
  bool is_at_rest() const;
  // Returns true if the image shown is the final one for the present state.
  bool shows_final_image() const;
  // Return the number of frames of the window, and of images of terrain, so far.
  std::int64_t frames() const { return frames_; }
  std::int64_t images() const { return images_; }
  // Stores the pixels of the next frame that is shown.
  void capture(core::RgbImage* to) { capture_ = to; }
  // Returns the panorama that was entered, or null.
  const OverlookView* overlook() const { return guide_.inside(); }
  const PlaceMenu& menu() const { return menu_; }
  // Returns what the status line says of the place under the cursor.
  const std::string& cursor_line() const { return cursor_text_; }
  // Returns true while keys act in the panels.
  bool keys_are_in_panels() const { return panel_focus_.is_on(); }
  bool is_recording() const { return recorder_.is_recording(); }
  const Welcome& welcome() const { return welcome_; }
  // Returns the windows of screens, or null.
  ScreenWindows* screens() { return screens_.get(); }
  // Performs an action as its key would. Returns what is wrong, or "".
  std::string act(const explore::Action& action);

 private:
  static constexpr double kImageWait_s = 0.1;   // limit of waiting for an image in one iteration
  static constexpr int kFramesAfterChange = 3;  // ImGui settles within these

  // Holds the state that keep_session() wrote last.
  struct KeptSession {
    std::array<double, 6> pose;  // the fields of mars::Pose
    core::DrawnBy drawn_by;
    bool panels;
    double side_px;
    double letters;
    std::vector<std::string> overlays;
    std::pair<int, int> size;
    bool operator==(const KeptSession&) const = default;
  };

  void handle(const Event& event);
  // explore_input.cpp:
  void handle_button(const Event& event);
  void scroll(glm::dvec2 xy, double notches);
  void drag(double time_s);
  glm::dvec2 middle_xy(int eye, glm::dvec2 xy) const;
  glm::dvec2 parallax_px(int eye, const glm::dvec3& point_m) const;
  bool handle_swipe(const Event& event);
  std::string swipe(explore::ActionKind kind);
  bool handle_caught(const Event& event);
  void add_speed(double notches);
  std::string catch_cursor();  // returns what is wrong, or ""
  void let_cursor_go();
  void follow_caught_cursor();
  void lay_out();
  void draw_frame();
  void find_cursor();
  ImageLayout image_layout() const { return {view_area_, chooser_.choice().stereo}; }
  double eye_base_m() const;
  EyeImage eye_image(int eye) const;
  bool maps_rest() const;
  bool step_overlook(const DeviceReading& input, double dt_s);
  void leave_overlook();
  void draw_view();
  bool swipes() const;
  core::RgbImage swiped_image() const;
  void draw_image(ImDrawList& list, const ViewArea& area, const Texture& texture,
                  const std::vector<warp::ImageGrid>& grids);
  void draw_moved(ImDrawList& list, const Texture& texture, const std::vector<warp::ImageGrid>& grids);
  void draw_marks(ImDrawList& list, const EyeImage& eye);
  void draw_side();
  void draw_tabs();
  void draw_side_handle();
  void draw_devices();
  void draw_layers();
  void update_layers();
  void draw_over_view();
  void draw_notes();
  void draw_bars(const ViewArea& area);
  glm::dvec2 draw_modes(const ViewArea& area);
  void draw_status();
  void draw_map(MapPanel& map, int width, int height);
  void fly_to(const core::Place& place);
  QualityText quality_of_image() const;
  bool lags() const;
  std::string copy_view();
  std::optional<mars::LonLat> pointed_place() const;
  bool handle_panel_keys(const Event& event);
  void request_image();
  std::string image_state(const explore::DrawChoice& chosen);
  ImageRequest request_of(const core::View& view, const explore::DrawChoice& chosen);
  explore::SightScene sight_scene();
  std::vector<core::View> foreseen_views(const core::View& shown, double soon_s,
                                         std::vector<core::View>& later);
  bool take_image();  // returns true if there is a new one
  double event_wait_s(bool moves, double rest_s) const;
  bool is_over_view() const;
  void tidy_at_rest(bool busy);
  explore::MotionMode key_mode() const;
  void take_planets();
  void replace_planet(ShownPlanet next);
  // explore_menu.cpp:
  void watch_menu_click(const Event& event);
  void open_menu(mars::LonLat place);
  void draw_menu();
  void choose(PlaceChoice choice, mars::LonLat place);
  // explore_ground.cpp:
  void follow_ground(const std::shared_ptr<const paging::PlanetFile>& changed);
  void measure_on_ground();
  bool measures_other_ground() const;
  void keep_reliefs();
  // explore_screens.cpp:
  void open_screens();
  MakePainter screen_painter() const;
  void update_screens(const explore::HeadPlace& head);
  void show_message(std::string text, bool is_error = false);
  void clear_message();
  void save_image();
  void keep_work(bool is_busy);
  void restore_flight(const std::filesystem::path& copy);
  void scale_letters(double factor);
  void set_recording(bool on, const std::filesystem::path& file = {});
  // explore_files.cpp:
  void draw_files();
  void draw_preferences();
  void take(const PreferencesActions& actions);
  void use(const explore::Preferences& preferences);
  void open_file(const std::string& name);
  void open_flight(const std::filesystem::path& file);
  void open_project_file(const std::filesystem::path& file);
  void make(const MakeRequest& request);
  std::string why_not_made(bool is_film);
  explore::MakeOptions make_options() const;
  void open_planet(const std::filesystem::path& file, const std::filesystem::path& project);
  void start_job(JobList::Order order);
  void finish_job(const JobList::Entry& entry);
  bool shows_progress() const { return jobs_.is_running() || (state_.files && finer_.is_making()); }
  void update_jobs();
  // explore_project.cpp:
  std::string open_project();
  bool has_project() const { return !project_file_.empty(); }
  bool handle_marks(const Event& event);
  void take_drawing_actions();
  std::string project_text() const;
  void save_project();
  void keep_drawings();
  void keep_scene();
  void restore_drawings(const std::filesystem::path& copy);
  std::string act_on_project_bookmark(const explore::Action& action);
  double now_s() const;

  ExploreSetup setup_;
  explore::Session session_;
  WindowState state_;
  explore::DrawChooser chooser_;
  Display display_;
  Widgets widgets_;
  PanelFocus panel_focus_;
  MapPanel map_;
  std::unique_ptr<MapPanel> large_map_;  // once it was shown
  MeasurePanel measure_;
  PlaceMenu menu_;
  StillClick menu_click_;                   // of the right button in the view
  std::optional<mars::LonLat> menu_place_;  // under the cursor when it was pressed
  FlightPanel flight_;
  AppearancePanel appearance_;
  PlacesPanel places_;
  SearchBox search_;
  FilePanel files_;
  JobList jobs_;
  double jobs_asked_s_ = 0;
  double rests_since_s_ = 0;
  bool is_tidy_ = false;  // freed memory was returned since the last motion
  Welcome welcome_;
  ObjectsPanel objects_;
  ReliefsPanel reliefs_;
  LayersPanel layers_;
  std::shared_ptr<const paging::Surface> measured_;  // that measurements are of
  double ground_changed_s_ = 0;                      // when images showed other ground last
  DrawingPanel drawing_;
  explore::BookmarkList project_bookmarks_;
  std::filesystem::path project_file_;  // empty: no project is open
  explore::UnsavedCopy drawing_copy_;
  double drawings_kept_s_ = -1e9;
  HotspotGuide guide_;
  explore::FlightBackup backup_;
  double session_kept_s_ = 0;
  std::optional<KeptSession> session_kept_;
  std::optional<mars::LonLat> under_cursor_;  // in view or map
  std::string cursor_text_;                   // of the place that was under it last
  SharedImages shared_;
  Texture view_texture_;     // of images that are pixels
  Texture earlier_texture_;  // of the earlier planet, while the line is on
  SwipeLine swipe_;
  MovedImage moved_image_;
  std::optional<core::View> shown_view_;  // that the last frame showed
  double next_moved_s_ = 0;               // not before, while the image follows the camera
  explore::LiveImage live_;
  std::optional<DrawnImage> drawn_;
  std::uint64_t requested_ = 0;      // number of the last image request
  std::uint64_t shown_changes_ = 0;  // Session::changes() and the window's state at the last request
  std::string shown_state_;
  std::optional<std::pair<double, mars::Pose>> last_pose_;  // at the last request, and its time
  ExploreLayout layout_;
  ViewArea view_area_;  // layout_.view
  glm::dvec2 cursor_{0, 0};
  std::optional<std::pair<double, glm::dvec2>> last_press_;  // for double clicks
  int held_eye_ = 0;                                         // in whose image the button was pressed
  glm::dvec2 held_parallax_px_{0};                           // from that image to the one between the eyes
  Devices devices_;
  std::optional<DeviceStates> shown_devices_;  // in the last frame, where it showed them
  explore::ViewHistory history_;
  SessionRecorder recorder_;
  mutable core::RgbImage last_image_;  // pixels of drawn_, which are read back once they are asked for
  PlanetOpener opener_;
  std::filesystem::path opening_project_;  // whose planet is being opened
  std::filesystem::path next_project_;
  PlanetMaker finer_;
  std::shared_ptr<const paging::PlanetFile> next_planet_;
  bool saves_image_ = false;  // once the final image is there
  double first_fov_deg_ = 50;
  double begun_s_;  // of the display's clock
  double last_step_s_;
  std::deque<double> image_times_s_;
  int frames_due_ = 3;
  std::optional<double> tip_at_s_;  // when a tooltip is due
  double next_frame_s_ = 0;         // not before, while only the cursor moves over the view
  bool was_moving_ = false;         // by hand
  std::int64_t frames_ = 0;
  std::int64_t images_ = 0;
  core::RgbImage* capture_ = nullptr;
  std::unique_ptr<ScreenWindows> screens_;  // null: there are none
  std::string screens_error_;               // that was told last
  std::unique_ptr<ImageMaker> maker_;  // last: its thread uses the painter, which may use the members above
};

}  // namespace vpe::window
