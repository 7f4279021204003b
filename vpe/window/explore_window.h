// The window of `vpe explore`: the view, the map, panels and a line of figures.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/explore/files/bookmarks.h"
#include "vpe/explore/files/preferences.h"
#include "vpe/explore/files/session_log.h"
#include "vpe/explore/files/view_history.h"
#include "vpe/explore/live_image.h"
#include "vpe/explore/session.h"
#include "vpe/window/devices.h"
#include "vpe/window/display.h"
#include "vpe/window/hotspot_guide.h"
#include "vpe/window/image_maker.h"
#include "vpe/window/map_panel.h"
#include "vpe/window/measure_panel.h"
#include "vpe/window/painter.h"
#include "vpe/window/view_area.h"
#include "vpe/window/widgets.h"

namespace vpe::window {

struct ExploreSetup {
  std::shared_ptr<const paging::PlanetFile> planet;
  std::shared_ptr<const paging::Surface> surface;
  explore::SessionOptions session;
  Backend backend = Backend::kPolygons;
  MakePainter make_painter;
  // Unit, body-fixed, towards the sun.
  std::function<glm::dvec3(const core::SettingsValues&, const mars::Pose&)> sun;
  // A planet file, or a raster to make one of, that was dropped on the window. Called on a thread of its own.
  std::function<std::shared_ptr<const paging::PlanetFile>(const std::string& file)> open_planet;
  std::vector<explore::Hotspot> hotspots;  // that have panoramas
  OpenOverlook open_overlook;              // of one; needed with spots
  DisplayOptions display;
  explore::Preferences preferences;
  DeviceSources devices;
  std::filesystem::path bookmarks;  // file; empty: none are kept
  std::filesystem::path folder;     // for images, logs and flights; empty: where the program was started
  std::filesystem::path log;        // recorded from the start when not empty
  std::optional<scripts::Flight> flight;
  std::string flight_file;  // where it is saved
  bool panels = true;       // shown at the start
  int threads = 0;
};

// What the window shows besides the session.
struct WindowState {
  Backend backend = Backend::kPolygons;
  std::optional<core::StereoLayout> stereo;
  double eye_base_m = 0;           // 0: a thirtieth of the height above ground
  double speed = 1;                // of moving by hand
  double ground_speed_m_s = 1000;  // to new waypoints
  int waypoint = 0;                // chosen in the list
  bool panels = true;
  bool help = false;
  bool large_map = false;
  explore::MapGround map_ground = explore::MapGround::kRelief;
  std::string message;  // what was done last, or what went wrong
  bool message_is_trouble = false;
  double message_since_s = 0;
  std::string image_error;  // why there is no image of what is set; empty: there is
};

class ExploreWindow {
 public:
  // Throws DisplayError.
  explicit ExploreWindow(ExploreSetup setup);
  ~ExploreWindow();

  // Until the window is closed.
  void run();
  // What was dropped on the window, once it is open: then run() has ended, and it is to be shown next.
  const std::shared_ptr<const paging::PlanetFile>& next_planet() const { return next_planet_; }
  const std::string& next_planet_file() const { return opening_file_; }
  // What is to be told when the window is gone: where an unsaved flight was put. Empty: nothing.
  std::string exit_message();
  // One turn: events, devices, panels, an image when one is due. Waits for events for at most so long when
  // there is nothing to do. False when the window is closed.
  bool step(double wait_s);

  explore::Session& session() { return session_; }
  const WindowState& state() const { return state_; }
  const Widgets& widgets() const { return widgets_; }
  Display& display() { return display_; }
  const Devices& devices() const { return devices_; }
  // The image shown last; null before the first.
  const DrawnImage* drawn() const { return drawn_ ? &*drawn_ : nullptr; }
  const core::RgbImage& image() const { return last_image_; }  // of it
  // Nothing moves, loads or waits to be drawn.
  bool is_at_rest() const;
  // The image shown is the one that is there when nothing moves any more.
  bool shows_final_image() const;
  // Frames of the window so far, and images of ground.
  std::int64_t frames() const { return frames_; }
  std::int64_t images() const { return images_; }
  // The next frame's pixels, once it is shown.
  void capture(core::RgbImage* to) { capture_ = to; }
  // The panorama that is stepped into; null in the world.
  const OverlookView* overlook() const { return guide_.inside(); }
  bool is_recording() const { return log_ != nullptr; }
  std::string act(const explore::Action& action);  // as a key would; what went wrong, empty when all is well

 private:
  static constexpr double kImageWait_s = 0.1;   // for which a turn waits for its image
  static constexpr int kFramesAfterChange = 3;  // ImGui settles within so many

  using Area = ViewArea;

  void handle(const Event& event);
  void handle_button(const Event& event);
  void lay_out();
  void draw_frame();
  void find_cursor();
  Area image_area() const;
  std::optional<glm::dvec2> camera_xy(glm::dvec2 cursor) const;
  glm::dvec2 held_xy(glm::dvec2 cursor) const;
  bool shows_map() const { return state_.panels || state_.large_map; }
  void forget_message();
  void forget_old_message();
  void log_overlook();
  bool view_panorama(const DeviceReading& hands, double dt_s);
  void step_out();
  void draw_view();
  void draw_side();
  void draw_status();
  void draw_help();
  void draw_map(int width, int height);
  void draw_large_map();
  void control_panel();
  void appearance_panel();
  void detail_panel();
  void flight_panel();
  void measure_panel();
  void waypoint_rows(explore::FlightEditor& editor);
  void settings_group(std::string_view prefix, const std::vector<std::string_view>& without);
  void setting(const core::SettingInfo& info);
  void order_image();
  void take_image(double wait_s);
  void say(std::string words, bool is_trouble = false);
  void open_dropped(const std::string& file);
  void take_opened();
  void save_image();
  void start_log(const std::filesystem::path& file);
  void stop_log();
  void log_image(ImageRequest& order);
  void go_to_bookmark(int number);
  void set_bookmark(int number);
  void save_flight();
  double now_s() const;
  std::filesystem::path new_file(const std::string& kind, const std::string& extension) const;

  ExploreSetup setup_;
  explore::Session session_;
  WindowState state_;
  Display display_;
  Widgets widgets_;
  MapPanel map_;
  MeasurePanel measure_;
  HotspotGuide guide_;
  std::optional<mars::LonLat> under_cursor_;  // in view or map
  Texture view_texture_;
  explore::LiveImage live_;
  std::optional<DrawnImage> drawn_;
  std::uint64_t ordered_ = 0;        // number of the last order
  std::uint64_t shown_changes_ = 0;  // Session::changes() and state at the last order
  std::string shown_state_;
  Area view_area_;
  glm::dvec2 cursor_{0, 0};
  std::optional<std::pair<double, glm::dvec2>> last_press_;  // for double clicks
  glm::dvec2 held_half_{0,
                        0};  // of a pair's image: where the camera's own begins that the button was pressed in
  Devices devices_;
  explore::ViewHistory history_;
  std::unique_ptr<explore::SessionLog> log_;
  std::filesystem::path log_file_;
  double log_begun_s_ = 0;
  std::string log_note_;
  std::pair<double, double> logged_look_{0, 0};  // in a panorama
  core::RgbImage last_image_;                    // of the image shown
  std::future<std::shared_ptr<const paging::PlanetFile>> opening_;
  std::string opening_file_;
  std::shared_ptr<const paging::PlanetFile> next_planet_;
  bool saves_image_ = false;  // once it is the final one
  double first_fov_deg_ = 50;
  std::chrono::steady_clock::time_point begun_;
  std::chrono::steady_clock::time_point last_frame_;
  std::deque<double> frame_times_s_;
  int frames_due_ = 3;
  bool was_moving_ = false;  // by hand
  std::int64_t frames_ = 0;
  std::int64_t images_ = 0;
  core::RgbImage* capture_ = nullptr;
  std::unique_ptr<ImageMaker> maker_;  // last: its thread uses the painter, which may use what is above
};

}  // namespace vpe::window
