#include "vpe/window/overlook_view.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "panorama/viewer/head_offset.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/steer.h"

namespace vpe::window {

namespace {

using explore::ActionKind;

constexpr double kRotationFov_deg = 60;  // at which kRotation_deg_s applies
// The camera only rotates, so the distance of the ground does not matter.
constexpr double kNearest_m = 1;

double tangent_of_half(double fov_deg) { return std::tan(0.5 * fov_deg * mars::kRadiansPerDegree); }

bool same_view(const core::View& a, const core::View& b) {
  return a.width == b.width && a.height == b.height && a.fov_deg == b.fov_deg &&
         a.camera.axes.forward == b.camera.axes.forward && a.camera.axes.up == b.camera.axes.up &&
         a.camera.position_m == b.camera.position_m;
}

}  // namespace

OverlookView::OverlookView(OverlookSetup setup)
    : setup_(std::move(setup)),
      viewer_(setup_.panorama.map, 1280, 720),
      probe_(setup_.panorama),
      live_({setup_.budget_ms}),
      maker_(std::make_unique<ImageMaker>(setup_.make_painter, [] { Display::wake(); })) {
  viewer_.set_fov(setup_.fov_deg);
  if (setup_.look) viewer_.look_at(setup_.look->azimuth_deg, setup_.look->elevation_deg);
  start_deg_ = {viewer_.yaw_deg(), viewer_.pitch_deg()};
  update_platform();
  set_stereo(setup_.stereo);
}

OverlookView::~OverlookView() { setup_.copying->stop = true; }

glm::ivec2 OverlookView::eye_size() const {
  const int across = stereo_ == core::StereoLayout::kSideBySide ? 2 : 1;
  const int down = stereo_ == core::StereoLayout::kOverUnder ? 2 : 1;
  const auto side = [](double px, int parts) { return std::max(16, static_cast<int>(px) / parts); };
  return {side(area_.width, across), side(area_.height, down)};
}

glm::dvec2 OverlookView::camera_xy(double x, double y) const {
  const glm::ivec2 size = eye_size();
  glm::dvec2 xy{x - area_.x, y - area_.y};
  if (stereo_ == core::StereoLayout::kSideBySide && xy.x >= size.x) xy.x -= size.x;
  if (stereo_ == core::StereoLayout::kOverUnder && xy.y >= size.y) xy.y -= size.y;
  return xy;
}

void OverlookView::place(const ViewArea& area) {
  const bool moved =
      area.x != area_.x || area.y != area_.y || area.width != area_.width || area.height != area_.height;
  area_ = area;
  const glm::ivec2 size = eye_size();
  if (size != viewer_.size()) viewer_.resize(size.x, size.y);
  is_new_ = is_new_ || moved;
}

void OverlookView::update_platform() {
  platform_deg_ = glm::dvec2{viewer_.yaw_deg(), viewer_.pitch_deg()} - head_deg_;
}

void OverlookView::show_message(std::string text, bool is_error) {
  message_ = std::move(text);
  message_is_error_ = is_error;
  is_new_ = true;
}

void OverlookView::handle(const Event& event, bool captured) {
  const bool over = area_.holds(event.x, event.y) && !captured;
  switch (event.kind) {
    case Event::Kind::kPress:
      if (!over || event.code != GLFW_MOUSE_BUTTON_LEFT) break;
      message_.clear();
      cursor_ = camera_xy(event.x, event.y);
      (void)reading();
      held_ = viewer_.direction(cursor_->x, cursor_->y);
      break;
    case Event::Kind::kRelease:
      if (event.code != GLFW_MOUSE_BUTTON_LEFT || !held_) break;
      held_.reset();
      // In a pair the cursor may have moved into the other half.
      cursor_ = over ? std::optional(camera_xy(event.x, event.y)) : std::nullopt;
      break;
    case Event::Kind::kMove:
      if (held_) {
        // A drag belongs to the half in which it began.
        const glm::dvec2 size = viewer_.size();
        glm::dvec2 xy = glm::dvec2{event.x - area_.x, event.y - area_.y};
        if (stereo_ == core::StereoLayout::kSideBySide)
          xy.x -= size.x * std::round((xy.x - cursor_->x) / size.x);
        if (stereo_ == core::StereoLayout::kOverUnder)
          xy.y -= size.y * std::round((xy.y - cursor_->y) / size.y);
        cursor_ = xy;
        viewer_.hold(*held_, xy.x, xy.y);
        update_platform();
      } else if (over) {
        cursor_ = camera_xy(event.x, event.y);
      } else {
        cursor_.reset();
      }
      break;
    case Event::Kind::kScroll: {
      if (!over || event.scroll == 0) break;
      message_.clear();
      const glm::dvec2 xy = camera_xy(event.x, event.y);
      viewer_.zoom(std::pow(kZoomStep, setup_.invert_wheel ? -event.scroll : event.scroll), xy.x, xy.y);
      update_platform();
      break;
    }
    default: break;
  }
}

bool OverlookView::act(const explore::Action& action) {
  const glm::dvec2 middle = 0.5 * glm::dvec2(viewer_.size());
  switch (action.kind) {
    case ActionKind::kNorthUp:
      // The nearest multiple of a full circle.
      viewer_.look_at(viewer_.yaw_deg() - std::remainder(viewer_.yaw_deg(), 360.0), viewer_.pitch_deg());
      break;
    case ActionKind::kLevel: viewer_.look_at(viewer_.yaw_deg(), 0); break;
    case ActionKind::kReset:
      viewer_.set_fov(setup_.fov_deg);
      viewer_.look_at(start_deg_.x, start_deg_.y);
      break;
    case ActionKind::kZoomIn: viewer_.zoom(kZoomStep, middle.x, middle.y); break;
    case ActionKind::kZoomOut: viewer_.zoom(1 / kZoomStep, middle.x, middle.y); break;
    case ActionKind::kZoomReset: viewer_.set_fov(setup_.fov_deg); break;
    case ActionKind::kScreenshot: save_due_ = true; return true;
    default: return false;
  }
  message_.clear();
  update_platform();
  return true;
}

// Returns the view with the head beside the panorama's place.
core::View OverlookView::wanted_view() const {
  core::View view = viewer_.view();
  // The body faces where the platform does, not where the head looks.
  view.camera.position_m = panorama::head_offset(platform_deg_.x, head_m_);
  return view;
}

void OverlookView::advance(const explore::Controls& controls, const mars::HeadAngles& look, double dt_s,
                           const glm::dvec3& head_m) {
  head_m_ = setup_.head_scale * head_m;
  const glm::dvec2 head{look.yaw_deg, look.pitch_deg};
  if (head != head_deg_) {
    head_deg_ = head;
    viewer_.look_at(platform_deg_.x + head.x, platform_deg_.y + head.y);
  }
  viewer_.set_roll(look.roll_deg);
  rotates_ = controls.yaw_right != 0 || controls.pitch_up != 0;
  if (rotates_) {
    const double step_deg = kRotation_deg_s * tangent_of_half(viewer_.fov_deg()) /
                            tangent_of_half(kRotationFov_deg) *
                            std::min(dt_s, explore::SteerLimits::kLongestStep_s);
    viewer_.turn(controls.yaw_right * step_deg, controls.pitch_up * step_deg);
    update_platform();
  }
  if (held_ && cursor_) {
    viewer_.hold(*held_, cursor_->x, cursor_->y);
    update_platform();
  }
}

void OverlookView::set_stereo(std::optional<core::StereoLayout> stereo) {
  if (!setup_.is_pair || stereo == stereo_) return;
  stereo_ = stereo;
  held_.reset();
  cursor_.reset();
  place(area_);
  is_new_ = true;
}

void OverlookView::look_at(double yaw_deg, double pitch_deg) {
  viewer_.look_at(yaw_deg, pitch_deg);
  update_platform();
}

void OverlookView::set_fov(double fov_deg) {
  viewer_.set_fov(fov_deg);
  update_platform();
}

bool OverlookView::is_at_rest() const {
  return maker_->is_idle() && live_.state() == lod::RefinementState::kWaiting && !rotates_ && !is_new_ &&
         !save_due_;
}

bool OverlookView::update(double wait_s) {
  const std::int64_t before = images_;
  take_image(0);
  // The next image is drawn while this one is shown.
  request_image();
  if (images_ == before) take_image(wait_s);
  const double copying = setup_.copying->fraction;
  if (copying != shown_copying_) is_new_ = true;
  shown_copying_ = copying;
  return std::exchange(is_new_, false);
}

void OverlookView::request_image() {
  if (!maker_->is_idle()) return;
  const core::View wanted = wanted_view();
  // Images are saved at rest, so that the saved view is the one that the user sees.
  const bool shows_it = drawn_ && image_is_full_ && drawn_->error.empty() &&
                        same_view(drawn_->request.draw.view, wanted) && drawn_->request.stereo == stereo_;
  if (save_due_ && shows_it) save_image();
  if (requested_ == 0) {
    // A full image may take long, so the first one is small. Its time is not representative and is not
    // recorded.
    request_is_full_ = false;
    ImageRequest first;
    first.number = ++requested_;
    first.stereo = requested_stereo_ = stereo_;
    first.is_full = false;
    first.draw.view = explore::reduced(wanted, explore::LiveImageOptions().smallest_side);
    maker_->request(std::move(first));
    return;
  }
  const auto next = live_.next(wanted, stereo_ != requested_stereo_, kNearest_m);
  if (!next) {
    if (save_due_) {
      save_due_ = false;
      show_message("there is no image to save", true);
    }
    return;
  }
  requested_stereo_ = stereo_;
  request_is_full_ = next->is_full;
  ImageRequest request;
  request.number = ++requested_;
  request.stereo = stereo_;
  request.is_full = next->is_full;
  request.draw.view = next->view;
  maker_->request(std::move(request));
}

void OverlookView::take_image(double wait_s) {
  std::optional<DrawnImage> drawn = maker_->take(wait_s);
  if (!drawn) return;
  ++images_;
  is_new_ = true;
  if (drawn->request.number > 1) live_.record(drawn->seconds * 1e3, drawn->result.settled);
  if (!drawn->error.empty()) {
    show_message(drawn->error, true);
    return;
  }
  texture_.upload(drawn->image);
  drawn_ = std::move(*drawn);
  image_is_full_ = request_is_full_;
}

void OverlookView::save_image() {
  namespace fs = std::filesystem;
  save_due_ = false;
  const std::string stem = setup_.panorama.image.stem().string() + "-view-";
  std::error_code ignored;
  fs::path path;
  for (int n = 1; path.empty() || fs::exists(path, ignored); ++n)
    path = setup_.images / (stem + std::to_string(n) + ".png");
  const core::RgbImage& image = drawn_->image;
  try {
    core::write_image(path, image.pixels, image.width, image.height);
    show_message("written: " + fs::absolute(path, ignored).string(), false);
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
}

std::optional<OverlookReading> OverlookView::reading() {
  if (!cursor_) return std::nullopt;
  const core::View view = viewer_.view();
  const bool known = held_ || (read_at_ == cursor_ && read_view_ && same_view(*read_view_, view));
  if (known) return reading_;
  read_at_ = cursor_;
  read_view_ = view;
  reading_ = OverlookReading{viewer_.direction(cursor_->x, cursor_->y), std::nullopt};
  try {
    reading_->place = probe_.at(reading_->direction);
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
  return reading_;
}

}  // namespace vpe::window
