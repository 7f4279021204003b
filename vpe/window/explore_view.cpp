// The view of the explore window: its pictures, and what is drawn over them.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "vpe/core/number.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/screen_point.h"

namespace vpe::window {

void ExploreWindow::order_picture() {
  if (!maker_->is_idle()) return;
  live_.set_budget_ms(session_.settings().values().lod_frame_ms);
  const std::string shown = std::string(to_string(state_.backend)) +
                            (state_.stereo ? core::to_string(*state_.stereo) : "") +
                            core::format_number(state_.eye_base_m);
  const bool changed = session_.changes() != shown_changes_ || shown != shown_state_;
  const auto order = live_.next(session_.view(), changed, std::max(session_.height_m(), 0.5));
  if (!order) return;
  shown_changes_ = session_.changes();
  shown_state_ = shown;
  PictureOrder picture;
  picture.number = ++ordered_;
  picture.backend = state_.backend;
  picture.stereo = state_.stereo;
  picture.eye_base_m =
      state_.eye_base_m > 0 ? state_.eye_base_m : std::max(session_.height_m(), 1.0) / core::kNearestToBase;
  picture.request.view = order->view;
  picture.request.settings = session_.settings().values();
  picture.request.sun = setup_.sun(session_.settings().values(), session_.pose());
  picture.request.interest = session_.all_interest();
  picture.request.coarsening = order->multiplier;
  picture.request.paging.wait = false;
  if (const explore::FlightPlayer* flight = session_.follows_flight() ? session_.player() : nullptr;
      flight != nullptr)
    picture.flight_time_s = flight->time_s();
  log_picture(picture);
  maker_->ask(std::move(picture));
}

void ExploreWindow::take_picture(double wait_s) {
  std::optional<Picture> made = maker_->take(wait_s);
  if (!made) return;
  frames_due_ = std::max(frames_due_, 1);
  if (!made->error.empty()) {
    live_.made(made->seconds * 1e3, true);
    say(made->error, true);
    return;
  }
  live_.made(made->seconds * 1e3, made->result.settled);
  for (const std::string& failure : made->result.failures) say(failure, true);
  view_texture_.upload(made->image);
  ++pictures_;
  last_image_ = std::move(made->image);
  picture_ = std::move(*made);
  frame_times_s_.push_back(picture_->seconds);
  if (frame_times_s_.size() > 20) frame_times_s_.pop_front();
  history_.observe(now_s(), {session_.pose(), session_.screen().fov_deg}, session_.height_m());
  if (saves_picture_ && picture_->order.request.coarsening == 1.0 && picture_->result.settled) save_picture();
}

// In a panorama: true, and a turn of the loop is done.
bool ExploreWindow::look_around(const DeviceReading& hands, double dt_s) {
  OverlookView* inside = guide_.inside();
  if (inside == nullptr) return false;
  inside->place({view_area_.x, view_area_.y, view_area_.width, view_area_.height});
  inside->advance(hands.controls, hands.look, dt_s);
  if (inside->update(kPictureWait_s)) frames_due_ = std::max(frames_due_, 1);
  if (log_ != nullptr && explore::any(hands.controls)) frames_due_ = std::max(frames_due_, 1);
  if (frames_due_ > 0) {
    draw_frame();
    --frames_due_;
  }
  return true;
}

void ExploreWindow::step_out() {
  if (guide_.inside() == nullptr) return;
  guide_.step_out();
  if (log_ != nullptr) log_->step_out(now_s() - log_begun_s_);
  frames_due_ = kFramesAfterChange;
}

// The ground under the cursor; over panels there is none.
void ExploreWindow::find_cursor() {
  measure_.update();
  under_cursor_.reset();
  if (state_.large_map || !view_area_.holds(cursor_.x, cursor_.y) || ImGui::GetIO().WantCaptureMouse) return;
  const core::View view = session_.view();
  const glm::dvec3 ray = core::pixel_ray(view, cursor_.x - view_area_.x, cursor_.y - view_area_.y);
  const double range_m = session_.ground().cast_m(view.eye.eye_m, ray);
  if (std::isfinite(range_m)) under_cursor_ = mars::lon_lat(view.eye.eye_m + ray * range_m);
}

void ExploreWindow::draw_view() {
  if (!picture_) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  // Pairs have another shape than the view; they are shown whole.
  const double scale =
      std::min(view_area_.width / view_texture_.width(), view_area_.height / view_texture_.height());
  const bool fits = !picture_->order.stereo;
  const double w = fits ? view_area_.width : view_texture_.width() * scale;
  const double h = fits ? view_area_.height : view_texture_.height() * scale;
  const double x = view_area_.x + (view_area_.width - w) / 2;
  const double y = view_area_.y + (view_area_.height - h) / 2;
  list.AddImage(view_texture_.id(), at(x, y), at(x + w, y + h));
  if (state_.stereo) return;
  list.PushClipRect(at(view_area_.x, view_area_.y),
                    at(view_area_.x + view_area_.width, view_area_.y + view_area_.height), true);
  if (!measure_.points().empty()) measure_.draw_marks(list, session_, view_area_.x, view_area_.y);
  guide_.draw_marks(list, session_, view_area_.x, view_area_.y);
  list.PopClipRect();
}

}  // namespace vpe::window
