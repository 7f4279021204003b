// Looking around in a panorama, inside of any window: the heart of the overlook window, and what another window
// shows in its own view when somebody steps into a panorama there.
//
// A window does this in each of its turns:
//
//   view.place(area);                      where it is drawn
//   view.handle(event, captured);          each event of the mouse
//   view.act(action);                      each action; those that it does not know are the window's
//   view.advance(controls, look, dt_s);    what is held down, and where the head looks
//   if (view.update(wait_s)) ...           something is to be shown: a frame with view.draw()
//
// and waits for events when is_at_rest(). Two degrees of freedom: yaw and pitch; the roll of devices and heads
// is left out. Belongs to the main thread and a Display that outlives it; images are made on a thread of its
// own, which wakes the display.
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
#include "vpe/explore/input/actions.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/live_image.h"
#include "vpe/overlay/compass.h"
#include "vpe/window/display.h"
#include "vpe/window/image_maker.h"
#include "vpe/window/painter.h"
#include "vpe/window/view_area.h"

namespace vpe::window {

// Between a view and its painter, on two threads: how far the copying of a large image is, and that nobody
// wants it any more.
struct CopyingState {
  std::atomic<double> fraction{-1};  // < 0: nothing is copied
  std::atomic<bool> stop{false};     // the painter gives up
};

struct OverlookSetup {
  panorama::PanoramaDescription panorama;
  bool is_pair = false;      // there is a second eye
  MakePainter make_painter;  // of views of the panorama: ImageRequest's request.view and stereo count
  std::shared_ptr<CopyingState> copying = std::make_shared<CopyingState>();
  std::optional<panorama::Direction> look;                   // to begin with; the middle when left out
  double fov_deg = panorama::ViewerLimits::kDefaultFov_deg;  // vertical, of one eye
  std::optional<core::StereoLayout> stereo;                  // only with a pair
  double budget_ms = 40;         // of an image while the view moves; 0: always full images
  bool invert_wheel = false;     // rolling away zooms out
  std::filesystem::path images;  // folder of saved views
};

// What the cursor is on.
struct OverlookReading {
  panorama::Direction direction;
  std::optional<panorama::ProbeResult> place;  // nothing where the image shows nothing
};

class OverlookView {
 public:
  static constexpr double kTurn_deg_s = 45;  // at full deflection and a field of view of 60 degrees
  static constexpr double kZoomStep = 1.2;   // of a notch of the wheel, of + and -

  // Needs a Display. Throws vpe::base::FileError when a plane of the panorama cannot be used.
  explicit OverlookView(OverlookSetup setup);
  ~OverlookView();  // waits for the image that is begun, which stops copying
  OverlookView(const OverlookView&) = delete;
  OverlookView& operator=(const OverlookView&) = delete;

  void place(const ViewArea& area);
  // Mouse: drag holds what is under the cursor, the wheel zooms there. captured: a panel has the mouse. Keys
  // and dropped files do nothing here.
  void handle(const Event& event, bool captured);
  // north-up, level, reset, zoom-in, zoom-out, zoom-reset, screenshot; false for all others.
  bool act(const explore::Action& action);
  void advance(const explore::Controls& controls, const mars::HeadAngles& look, double dt_s);
  // Orders an image when one is due, and takes one that is finished, for which it waits at most so long. True
  // when what draw() shows has changed.
  bool update(double wait_s);
  // Image and compass strip, into the area, behind ImGui's windows.
  void draw();
  // Nothing moves, is being made, or waits to be shown.
  bool is_at_rest() const;

  // Of one eye; the screen of a pair side by side or over and under is one eye's half of the area.
  const panorama::Viewer& viewer() const { return viewer_; }
  const panorama::PanoramaDescription& panorama() const { return setup_.panorama; }
  bool is_pair() const { return setup_.is_pair; }
  std::optional<core::StereoLayout> stereo() const { return stereo_; }
  void set_stereo(std::optional<core::StereoLayout> stereo);  // without a pair nothing happens
  void look_at(double yaw_deg, double pitch_deg);
  void set_fov(double fov_deg);

  // Nothing while the cursor is not over the view, and while it drags.
  std::optional<OverlookReading> reading();
  // Marks of the strip as drawn last, in pixels of one eye's screen: where the azimuths of its middle row are.
  const std::vector<overlay::PlacedMark>& compass() const { return marks_; }
  // The image shown last; null before the first.
  const DrawnImage* drawn() const { return drawn_ ? &*drawn_ : nullptr; }
  std::int64_t images() const { return images_; }
  // What was done last or went wrong, until somebody does something else; empty: nothing.
  const std::string& message() const { return message_; }
  bool message_is_trouble() const { return message_is_trouble_; }

 private:
  glm::ivec2 eye_size() const;
  glm::dvec2 camera_xy(double x, double y) const;
  void took_over();
  void say(std::string words, bool is_trouble);
  void order_image();
  void take_image(double wait_s);
  void save_image();
  void draw_strip(const glm::dvec2& corner);  // of an eye

  OverlookSetup setup_;
  panorama::Viewer viewer_;  // the platform's direction and the head's look
  panorama::PixelProbe reader_;
  explore::LiveImage live_;
  std::optional<core::StereoLayout> stereo_;
  ViewArea area_;
  Texture texture_;
  glm::dvec2 platform_deg_{0, 0};  // yaw and pitch without the head's look
  glm::dvec2 head_deg_{0, 0};
  glm::dvec2 start_deg_{0, 0};
  std::optional<panorama::Direction> held_;
  std::optional<glm::dvec2> cursor_;  // over the view
  std::optional<glm::dvec2> read_at_;
  std::optional<core::View> read_view_;
  std::optional<OverlookReading> reading_;
  std::vector<overlay::PlacedMark> marks_;
  std::optional<DrawnImage> drawn_;
  std::optional<core::StereoLayout> ordered_stereo_;
  bool order_is_full_ = false;
  bool image_is_full_ = false;
  bool save_due_ = false;
  bool is_new_ = true;
  bool turns_ = false;
  double shown_copying_ = -1;
  std::uint64_t ordered_ = 0;
  std::int64_t images_ = 0;
  std::string message_;
  bool message_is_trouble_ = false;
  std::unique_ptr<ImageMaker> maker_;  // last: its thread uses what is above
};

}  // namespace vpe::window
