// An interactive view of a panorama inside any window. The overlook window shows it alone; the explore window
// shows it in place of its own view when a hotspot is entered.
//
// Typical usage, in each iteration of the event loop:
//   view.place(area);                      // where it is drawn
//   view.handle(event, captured);          // for each mouse event
//   view.act(action);                      // for each action; the window handles those that return false
//   view.advance(controls, look, dt_s);
//   if (view.update(wait_s)) ...           // draw a frame with view.draw()
//
// and wait for events if is_at_rest(). The view has two degrees of freedom, yaw and pitch, and the roll of the head; the
// roll of other devices is ignored. It belongs to the main thread and a Display that outlives it. Images are drawn on a
// thread of its own, which wakes the display.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "panorama/metadata/open_panorama.h"
#include "panorama/viewer/pixel_probe.h"
#include "panorama/viewer/viewer.h"
#include "vpe/core/stereo.h"
#include "vpe/explore/images/live_image.h"
#include "vpe/explore/input/actions.h"
#include "vpe/explore/input/controls.h"
#include "vpe/overlay/compass.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/imgui_helpers.h"
#include "vpe/window/workers/image_maker.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Shared by a view and its painter, which run on two threads: progress of copying a large image, and its
// cancellation.
struct CopyingState {
  std::atomic<double> fraction{-1};  // < 0: nothing is being copied
  std::atomic<bool> stop{false};     // makes the painter stop
};

struct OverlookSetup {
  panorama::PanoramaDescription panorama;
  bool is_pair = false;      // for two eyes
  MakePainter make_painter;  // paints ImageRequest::draw.view with ImageRequest::stereo; ignores the rest
  std::shared_ptr<CopyingState> copying = std::make_shared<CopyingState>();
  std::optional<panorama::Direction> look;                   // at the start; nullopt: the middle
  double fov_deg = panorama::ViewerLimits::kDefaultFov_deg;  // vertical, of one eye
  std::optional<core::StereoLayout> stereo;                  // only with a pair
  // Time of an image while the view moves. Smaller: smoother motion, coarser images; 0: always full images.
  double budget_ms = 40;
  bool invert_wheel = false;  // rolling away zooms out
  // Metres of the world for a metre of the head, by the panorama's ranges. 0: a head only turns.
  double head_scale = 0;
  std::filesystem::path images;  // folder of saved views
};

// Holds the direction and the values under the cursor.
struct OverlookReading {
  panorama::Direction direction;
  std::optional<panorama::ProbeResult> place;  // nullopt outside of the image
};

// Holds the view and its images.
class OverlookView {
 public:
  static constexpr double kRotation_deg_s = 45;  // at full deflection and a field of view of 60 degrees
  static constexpr double kZoomStep = 1.2;       // of a notch of the wheel, and of + and -

  // Needs a Display. Throws base::FileError if an auxiliary layer of the panorama cannot be used.
  explicit OverlookView(OverlookSetup setup);
  ~OverlookView();  // stops copying and waits for the image that is being drawn
  OverlookView(const OverlookView&) = delete;
  OverlookView& operator=(const OverlookView&) = delete;

  void place(const ViewArea& area);
  // Handles a mouse event: a drag holds the direction under the cursor, the wheel zooms there. captured: a
  // panel uses the mouse. Ignores keys and dropped files.
  void handle(const Event& event, bool captured);
  // Handles north-up, level, reset, zoom-in, zoom-out, zoom-reset and screenshot. Returns false for other
  // actions.
  bool act(const explore::Action& action);
  // Takes the head's direction and its place, metres to the right, up and backwards of where it rests.
  void advance(const explore::Controls& controls, const mars::HeadAngles& look, double dt_s,
               const glm::dvec3& head_m = glm::dvec3(0));
  // Requests an image if one is due, and takes a finished one, for which it waits at most `wait_s` seconds.
  // Returns true if draw() would show something else.
  bool update(double wait_s);
  // Draws image and compass strip into the area, behind ImGui's windows.
  void draw();
  // Returns true if nothing moves, is being drawn, or waits to be shown.
  bool is_at_rest() const;

  // Returns the viewer of one eye. For a pair side by side or over and under its screen is half of the area.
  const panorama::Viewer& viewer() const { return viewer_; }
  const panorama::PanoramaDescription& panorama() const { return setup_.panorama; }
  bool is_pair() const { return setup_.is_pair; }
  std::optional<core::StereoLayout> stereo() const { return stereo_; }
  void set_stereo(std::optional<core::StereoLayout> stereo);  // does nothing without a pair
  void look_at(double yaw_deg, double pitch_deg);
  void set_fov(double fov_deg);

  // Reads the panorama under the cursor. Returns nullopt if the cursor is not over the view; during a drag
  // returns the reading from its beginning.
  std::optional<OverlookReading> reading();
  // Returns the marks of the strip as drawn last, in pixels of one eye's screen, at the azimuths of its middle
  // row.
  const std::vector<overlay::PlacedMark>& compass() const { return marks_; }
  // Returns the image shown last, or null before the first.
  const DrawnImage* drawn() const { return drawn_ ? &*drawn_ : nullptr; }
  std::int64_t images() const { return images_; }
  // Returns a message about the last action or error, or "". It is cleared by the next input.
  const std::string& message() const { return message_; }
  bool message_is_error() const { return message_is_error_; }

 private:
  glm::ivec2 eye_size() const;
  glm::dvec2 camera_xy(double x, double y) const;
  void update_platform();
  core::View wanted_view() const;
  void show_message(std::string text, bool is_error);
  void request_image();
  void take_image(double wait_s);
  void save_image();
  void draw_strip(const glm::dvec2& corner);  // of an eye

  OverlookSetup setup_;
  panorama::Viewer viewer_;  // with the platform's direction and the head's
  panorama::PixelProbe probe_;
  explore::LiveImage live_;
  std::optional<core::StereoLayout> stereo_;
  ViewArea area_;
  Texture texture_;
  glm::dvec2 platform_deg_{0, 0};  // yaw and pitch without the head's
  glm::dvec2 head_deg_{0, 0};
  glm::dvec3 head_m_{0, 0, 0};  // in the world's metres
  glm::dvec2 start_deg_{0, 0};
  std::optional<panorama::Direction> held_;
  std::optional<glm::dvec2> cursor_;  // over the view
  std::optional<glm::dvec2> read_at_;
  std::optional<core::View> read_view_;
  std::optional<OverlookReading> reading_;
  std::vector<overlay::PlacedMark> marks_;
  std::optional<DrawnImage> drawn_;
  std::optional<core::StereoLayout> requested_stereo_;
  bool request_is_full_ = false;
  bool image_is_full_ = false;
  bool save_due_ = false;
  bool is_new_ = true;
  bool rotates_ = false;
  double shown_copying_ = -1;
  std::uint64_t requested_ = 0;
  std::int64_t images_ = 0;
  std::string message_;
  bool message_is_error_ = false;
  std::unique_ptr<ImageMaker> maker_;  // last: its thread uses the members above
};

}  // namespace vpe::window
