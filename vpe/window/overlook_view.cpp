#include "vpe/window/overlook_view.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/steer.h"

namespace vpe::window {

namespace {

using explore::ActionKind;

constexpr double kTurnFov_deg = 60;  // at which turning has its stated speed
// The eye stays where it is, so nothing that is near moves past it.
constexpr double kNearest_m = 1;

double tangent_of_half(double fov_deg) { return std::tan(0.5 * fov_deg * mars::kRadiansPerDegree); }

bool same_view(const core::View& a, const core::View& b) {
  return a.width == b.width && a.height == b.height && a.fov_deg == b.fov_deg &&
         a.camera.axes.forward == b.camera.axes.forward && a.camera.axes.up == b.camera.axes.up;
}

}  // namespace

OverlookView::OverlookView(OverlookSetup setup)
    : setup_(std::move(setup)),
      viewer_(setup_.panorama.map, 1280, 720),
      reader_(setup_.panorama),
      live_({setup_.budget_ms}),
      maker_(std::make_unique<ImageMaker>(setup_.make_painter, [] { Display::wake(); })) {
  viewer_.set_fov(setup_.fov_deg);
  if (setup_.look) viewer_.look_at(setup_.look->azimuth_deg, setup_.look->elevation_deg);
  start_deg_ = {viewer_.yaw_deg(), viewer_.pitch_deg()};
  took_over();
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

void OverlookView::took_over() {
  platform_deg_ = glm::dvec2{viewer_.yaw_deg(), viewer_.pitch_deg()} - head_deg_;
}

void OverlookView::say(std::string words, bool is_trouble) {
  message_ = std::move(words);
  message_is_trouble_ = is_trouble;
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
      // Of a pair the cursor may have come into the other half.
      cursor_ = over ? std::optional(camera_xy(event.x, event.y)) : std::nullopt;
      break;
    case Event::Kind::kMove:
      if (held_) {
        // A drag belongs to the half in which it began, wherever the hand goes.
        const glm::dvec2 size = viewer_.size();
        glm::dvec2 xy = glm::dvec2{event.x - area_.x, event.y - area_.y};
        if (stereo_ == core::StereoLayout::kSideBySide)
          xy.x -= size.x * std::round((xy.x - cursor_->x) / size.x);
        if (stereo_ == core::StereoLayout::kOverUnder)
          xy.y -= size.y * std::round((xy.y - cursor_->y) / size.y);
        cursor_ = xy;
        viewer_.hold(*held_, xy.x, xy.y);
        took_over();
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
      took_over();
      break;
    }
    default: break;
  }
}

bool OverlookView::act(const explore::Action& action) {
  const glm::dvec2 middle = 0.5 * glm::dvec2(viewer_.size());
  switch (action.kind) {
    case ActionKind::kNorthUp:
      // The nearest of all turns.
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
  took_over();
  return true;
}

void OverlookView::advance(const explore::Controls& controls, const mars::HeadAngles& look, double dt_s) {
  const glm::dvec2 head{look.yaw_deg, look.pitch_deg};
  if (head != head_deg_) {
    head_deg_ = head;
    viewer_.look_at(platform_deg_.x + head.x, platform_deg_.y + head.y);
  }
  turns_ = controls.yaw_right != 0 || controls.pitch_up != 0;
  if (turns_) {
    const double step_deg = kTurn_deg_s * tangent_of_half(viewer_.fov_deg()) / tangent_of_half(kTurnFov_deg) *
                            std::min(dt_s, explore::SteerLimits::kLongestStep_s);
    viewer_.turn(controls.yaw_right * step_deg, controls.pitch_up * step_deg);
    took_over();
  }
  if (held_ && cursor_) {
    viewer_.hold(*held_, cursor_->x, cursor_->y);
    took_over();
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
  took_over();
}

void OverlookView::set_fov(double fov_deg) {
  viewer_.set_fov(fov_deg);
  took_over();
}

bool OverlookView::is_at_rest() const {
  return maker_->is_idle() && live_.state() == lod::RefinementState::kWaiting && !turns_ && !is_new_ &&
         !save_due_;
}

bool OverlookView::update(double wait_s) {
  const std::int64_t before = images_;
  take_image(0);
  // The next one is made while this one is shown.
  order_image();
  if (images_ == before) take_image(wait_s);
  const double copying = setup_.copying->fraction;
  if (copying != shown_copying_) is_new_ = true;
  shown_copying_ = copying;
  return std::exchange(is_new_, false);
}

void OverlookView::order_image() {
  if (!maker_->is_idle()) return;
  const core::View wanted = viewer_.view();
  // A view that was saved while it moved is one that nobody had a good look at.
  const bool shows_it = drawn_ && image_is_full_ && drawn_->error.empty() &&
                        same_view(drawn_->order.request.view, wanted) && drawn_->order.stereo == stereo_;
  if (save_due_ && shows_it) save_image();
  if (ordered_ == 0) {
    // A full one may take long; this is there at once, and tells nothing of how long images take.
    order_is_full_ = false;
    ImageRequest first;
    first.number = ++ordered_;
    first.stereo = ordered_stereo_ = stereo_;
    first.request.view = explore::reduced(wanted, explore::LiveImageOptions().smallest_side);
    maker_->ask(std::move(first));
    return;
  }
  const auto order = live_.next(wanted, stereo_ != ordered_stereo_, kNearest_m);
  if (!order) {
    if (save_due_) {
      save_due_ = false;
      say("there is no picture to save", true);
    }
    return;
  }
  ordered_stereo_ = stereo_;
  order_is_full_ = order->is_full;
  ImageRequest image_request;
  image_request.number = ++ordered_;
  image_request.stereo = stereo_;
  image_request.request.view = order->view;
  maker_->ask(std::move(image_request));
}

void OverlookView::take_image(double wait_s) {
  std::optional<DrawnImage> made = maker_->take(wait_s);
  if (!made) return;
  ++images_;
  is_new_ = true;
  if (made->order.number > 1) live_.made(made->seconds * 1e3, true);
  if (!made->error.empty()) {
    say(made->error, true);
    return;
  }
  texture_.upload(made->image);
  drawn_ = std::move(*made);
  image_is_full_ = order_is_full_;
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
    say("written: " + fs::absolute(path, ignored).string(), false);
  } catch (const std::exception& e) {
    say(e.what(), true);
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
    reading_->place = reader_.at(reading_->direction);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
  return reading_;
}

}  // namespace vpe::window
