// The view of the explore window: its images, and what is image_request over them.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "vpe/base/number.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/panel_words.h"
#include "vpe/window/screen_point.h"

namespace vpe::window {

void ExploreWindow::order_image() {
  if (!maker_->is_idle()) return;
  live_.set_budget_ms(session_.settings().values().lod_frame_ms);
  const std::string shown = std::string(to_string(state_.backend)) +
                            (state_.stereo ? core::to_string(*state_.stereo) : "") +
                            base::format_number(state_.eye_base_m);
  const bool changed = session_.changes() != shown_changes_ || shown != shown_state_;
  const auto order = live_.next(session_.view(), changed, std::max(session_.height_m(), 0.5));
  if (!order) return;
  shown_changes_ = session_.changes();
  shown_state_ = shown;
  ImageRequest image_request;
  image_request.number = ++ordered_;
  image_request.backend = state_.backend;
  image_request.stereo = state_.stereo;
  image_request.eye_base_m =
      state_.eye_base_m > 0 ? state_.eye_base_m : std::max(session_.height_m(), 1.0) / core::kNearestToBase;
  image_request.request.view = order->view;
  image_request.request.settings = session_.settings().values();
  image_request.request.sun = setup_.sun(session_.settings().values(), session_.pose());
  image_request.request.interest = session_.all_interest();
  image_request.request.coarsening = order->multiplier;
  image_request.request.paging.wait = false;
  if (const explore::FlightPlayer* flight = session_.follows_flight() ? session_.player() : nullptr;
      flight != nullptr)
    image_request.flight_time_s = flight->time_s();
  log_image(image_request);
  maker_->ask(std::move(image_request));
}

void ExploreWindow::take_image(double wait_s) {
  std::optional<DrawnImage> made = maker_->take(wait_s);
  if (!made) return;
  frames_due_ = std::max(frames_due_, 1);
  state_.image_error = made->error;
  if (!made->error.empty()) {
    live_.made(made->seconds * 1e3, true);
    say(made->error, true);
    return;
  }
  live_.made(made->seconds * 1e3, made->result.settled);
  if (const auto& failures = made->result.failures; !failures.empty()) {
    const std::size_t more = failures.size() - 1;
    say(failures.front() + (more > 0 ? " (and " + std::to_string(more) + " more)" : ""), true);
  }
  view_texture_.upload(made->image);
  ++images_;
  last_image_ = std::move(made->image);
  drawn_ = std::move(*made);
  frame_times_s_.push_back(drawn_->seconds);
  if (frame_times_s_.size() > 20) frame_times_s_.pop_front();
  history_.observe(now_s(), {session_.pose(), session_.screen().fov_deg}, session_.height_m());
  if (saves_image_ && drawn_->order.request.coarsening == 1.0 && drawn_->result.settled) save_image();
}

// In a panorama: true, and a turn of the loop is done.
bool ExploreWindow::view_panorama(const DeviceReading& hands, double dt_s) {
  OverlookView* inside = guide_.inside();
  if (inside == nullptr) return false;
  inside->place(view_area_);
  inside->advance(hands.controls, hands.look, dt_s);
  if (inside->update(kImageWait_s)) frames_due_ = std::max(frames_due_, 1);
  if (inside->message() != state_.message && !inside->message().empty())
    say(inside->message(), inside->message_is_trouble());
  log_overlook();
  if (shows_map() && !map_.is_at_rest()) frames_due_ = std::max(frames_due_, 1);
  if (frames_due_ > 0) {
    draw_frame();
    --frames_due_;
  }
  return true;
}

void ExploreWindow::step_out() {
  if (guide_.inside() == nullptr) return;
  guide_.step_out();
  forget_message();
  session_.release();
  frames_due_ = kFramesAfterChange;
  if (log_ == nullptr) return;
  try {
    log_->step_out(now_s() - log_begun_s_);
  } catch (const std::exception& e) {
    log_.reset();
    say(e.what(), true);
  }
}

// Where images stand: pairs have another shape than the view and are shown whole.
ExploreWindow::Area ExploreWindow::image_area() const {
  const bool wide = state_.stereo == core::StereoLayout::kSideBySide;
  const bool tall = state_.stereo == core::StereoLayout::kOverUnder;
  if (!wide && !tall) return view_area_;
  const double width = view_area_.width * (wide ? 2 : 1);
  const double height = view_area_.height * (tall ? 2 : 1);
  const double scale = std::min(view_area_.width / width, view_area_.height / height);
  return {view_area_.x + (view_area_.width - width * scale) / 2,
          view_area_.y + (view_area_.height - height * scale) / 2, width * scale, height * scale};
}

// A position of the window in the image of one eye; nothing beside it.
std::optional<glm::dvec2> ExploreWindow::camera_xy(glm::dvec2 cursor) const {
  const Area area = image_area();
  if (!area.holds(cursor.x, cursor.y)) return std::nullopt;
  const double wide = state_.stereo == core::StereoLayout::kSideBySide ? 2 : 1;
  const double tall = state_.stereo == core::StereoLayout::kOverUnder ? 2 : 1;
  const glm::dvec2 camera{(cursor.x - area.x) * wide * view_area_.width / area.width,
                          (cursor.y - area.y) * tall * view_area_.height / area.height};
  return glm::dvec2{std::fmod(camera.x, view_area_.width), std::fmod(camera.y, view_area_.height)};
}

// Of a drag: it belongs to the camera in whose image it began, wherever the hand goes.
glm::dvec2 ExploreWindow::held_xy(glm::dvec2 cursor) const {
  const Area area = image_area();
  const double wide = state_.stereo == core::StereoLayout::kSideBySide ? 2 : 1;
  const double tall = state_.stereo == core::StereoLayout::kOverUnder ? 2 : 1;
  return glm::dvec2{(cursor.x - area.x) * wide * view_area_.width / area.width,
                    (cursor.y - area.y) * tall * view_area_.height / area.height} -
         held_half_;
}

// The ground under the cursor; over panels there is none.
void ExploreWindow::find_cursor() {
  measure_.update();
  under_cursor_.reset();
  if (state_.large_map || guide_.inside() != nullptr || ImGui::GetIO().WantCaptureMouse) return;
  const std::optional<glm::dvec2> xy = camera_xy(cursor_);
  if (!xy) return;
  const core::View view = session_.view();
  const glm::dvec3 ray = core::pixel_ray(view, xy->x, xy->y);
  const double range_m = session_.ground().cast_m(view.camera.position_m, ray);
  if (std::isfinite(range_m)) under_cursor_ = mars::lon_lat(view.camera.position_m + ray * range_m);
}

void ExploreWindow::draw_view() {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  if (!state_.image_error.empty()) {
    // The image before is of something else by now.
    draw_words(list, view_area_, state_.image_error);
    return;
  }
  if (!drawn_) return;
  const Area area = drawn_->order.stereo == state_.stereo ? image_area() : view_area_;
  list.AddImage(view_texture_.id(), at(area.x, area.y), at(area.x + area.width, area.y + area.height));
  if (state_.stereo) return;
  list.PushClipRect(at(view_area_.x, view_area_.y),
                    at(view_area_.x + view_area_.width, view_area_.y + view_area_.height), true);
  if (!measure_.points().empty()) measure_.draw_marks(list, session_, view_area_.x, view_area_.y);
  guide_.draw_marks(list, session_, view_area_.x, view_area_.y);
  list.PopClipRect();
}

}  // namespace vpe::window
