// The view of the explore window: its images, and marks over them.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "vpe/base/number.h"
#include "vpe/core/margin.h"
#include "vpe/explore/foresight.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/marks/flight_marks.h"
#include "vpe/window/marks/pivot_mark.h"

namespace vpe::window {

namespace {

// An image is expected so much later than it is requested.
constexpr double kSoonest_s = 0.02;
constexpr double kLatest_s = 0.5;
// Its margin is this part of its sides at most. Wider: slower images; narrower: their border is seen in quick turns.
constexpr int kMostMargin = 12;

// Returns true if something lies over images at a fixed place.
bool has_fixed_overlay(const core::Overlays& o) {
  return o.legend || o.scale_bar || o.north_arrow || o.time_code != core::TimeCode::kOff || !o.title.empty() ||
         o.compass != core::CompassStrip::kOff;
}

core::View sized(core::View view, const core::RgbImage& image) {
  view.width = image.width;
  view.height = image.height;
  return view;
}

// Returns true if an image may have the ranges of the nearest columns while its camera moves (rays.sample=auto).
bool may_take_nearest(const core::DrawRequest& request) {
  const core::RayMode mode = request.settings.ray_mode;
  return request.settings.ray_sample == core::RaySample::kAuto &&
         request.view.projection == core::Projection::kPerspective &&
         (mode == core::RayMode::kExact || mode == core::RayMode::kMultires);
}

}  // namespace

// Returns all that images depend on besides camera and settings.
std::string ExploreWindow::image_state(const explore::DrawChoice& chosen) {
  const std::string scene = objects_.shown_file(session_);
  // What stands in a scene depends on the time.
  const std::string objects = scene.empty() ? ""
                                            : " " + scene + " " + std::to_string(objects_.shown_revision()) +
                                                  " " + base::format_number(objects_.time_s());
  const explore::FlightPlayer* const followed = session_.follows_flight() ? session_.player() : nullptr;
  std::string ground;
  if (followed != nullptr && followed->ground()) {
    for (const std::string& line : scripts::lines_of(followed->ground()->at(objects_.time_s())))
      ground += "\n" + line;
  }
  if (reliefs_.reliefs()) ground += "\n" + std::to_string(reliefs_.editor().revision());
  return std::string(core::to_string(chosen.drawn_by)) +
         (chosen.stereo ? core::to_string(*chosen.stereo) : "") + base::format_number(chosen.eye_base_m) + " " +
         base::format_number(chosen.convergence_m) + objects + ground + (swipes() ? " swipe" : "") + " " +
         std::to_string(layers_.revision());
}

// Returns a request for an image of the session, by the backend that was chosen last.
ImageRequest ExploreWindow::request_of(const core::View& view, const explore::DrawChoice& chosen) {
  ImageRequest request;
  request.draw.view = view;
  request.draw.settings = session_.settings().values();
  request.draw.settings.scene = objects_.shown_file(session_);
  request.draw.sun = setup_.sun(session_.settings().values(), session_.pose());
  request.draw.interest = session_.all_interest();
  request.draw.paging.wait = false;
  request.is_auto = chosen.drawn_by == core::DrawnBy::kAuto;
  request.backend = state_.backend;
  request.flight_time_s = objects_.time_s();
  if (const explore::FlightPlayer* flight = session_.follows_flight() ? session_.player() : nullptr;
      flight != nullptr) {
    request.draw.tracks = flight->tracks();
    request.ground = flight->ground();
  }
  request.reliefs = reliefs_.reliefs();
  request.layers = layers_.files();
  request.draw.settings.layers = layers_.readable_setting();
  return request;
}

void ExploreWindow::request_image() {
  const explore::DrawChoice chosen =
      chooser_.update({state_.drawn_by, state_.stereo, state_.eye_base_m, state_.convergence_m},
                      session_.follows_flight() ? session_.player() : nullptr);
  const glm::ivec2 size = image_layout().eye_size();
  session_.resize(size.x, size.y);
  if (!maker_->is_idle()) return;
  live_.set_budget_ms(session_.settings().values().lod_frame_ms);
  const std::string state = image_state(chosen);
  const bool changed = session_.changes() != shown_changes_ || state != shown_state_;
  const auto next = live_.next(session_.view(), changed, std::max(session_.height_m(), 0.5));
  if (!next) return;
  shown_changes_ = session_.changes();
  shown_state_ = state;
  ImageRequest request = request_of(next->view, chosen);
  request.number = ++requested_;
  request.stereo = chosen.stereo;
  request.eye_base_m = eye_base_m();
  request.convergence_m = chosen.convergence_m;
  request.draw.coarsening = next->multiplier;
  request.draw.keeps_levels = true;
  // In red-cyan the images of both eyes are one.
  request.draw.want_rough_range =
      setup_.preferences.warp != explore::Warp::kOff && chosen.stereo != core::StereoLayout::kAnaglyph;
  request.with_earlier = swipes();
  request.keeps_ranges =
      setup_.preferences.warp == explore::Warp::kCarry && !chosen.stereo && !request.with_earlier;
  const double soon_s = std::clamp(2 * (drawn_ ? drawn_->seconds : 0), kSoonest_s, kLatest_s);
  const std::vector<core::View> soon = foreseen_views(next->view, soon_s, request.draw.paging.upcoming);
  request.backend = state_.backend =
      core::backend_for(chosen.drawn_by, {setup_.has_gpu, !setup_.suits_rays || setup_.suits_rays(request.draw),
                                          session_.pose().alt_m / session_.ground().radius_m, state_.backend});
  // Triangles draw coarser ones in place of tiles that are not loaded, for which a margin would ask.
  if (request.backend == core::Backend::kRay && request.draw.want_rough_range && !chosen.stereo &&
      !recorder_.is_recording() && !has_fixed_overlay(request.draw.settings))
    request.margin_px = core::margin_for(next->view, soon, std::max(session_.height_m(), 1.0),
                                         glm::ivec2(next->view.width, next->view.height) / kMostMargin);
  // Beside the finest tiles everywhere, any tolerance would be a leap.
  const bool is_exact = request.backend == core::Backend::kRay && !request.is_auto &&
                        request.draw.settings.ray_mode != core::RayMode::kMultires &&
                        request.draw.settings.ray_mode != core::RayMode::kDiscrete;
  if (is_exact) request.draw.coarsening = 1;
  const bool is_nearest = request.backend == core::Backend::kRay &&
                          live_.state() == lod::RefinementState::kMoving && may_take_nearest(request.draw);
  if (is_nearest) request.draw.settings.ray_sample = core::RaySample::kNearest;
  const ImageRequest drawn = setup_.as_drawn ? setup_.as_drawn(request) : request;
  // Tolerances are in pixels of the screen, also where the image has fewer.
  request.is_full = next->is_full && !is_nearest;
  request.px_per_screen_px = next->side;
  request.draw.settings.lod_tolerance_px *= next->side;
  request.draw.settings.ray_cell_px *= next->side;
  request.draw.settings.ray_ratio *= next->side;
  if (const std::string error = recorder_.record_image(request, drawn, session_, now_s()); !error.empty())
    show_message(error, true);
  shared_.place(request, drawn, recorder_.is_recording());
  maker_->request(std::move(request));
}

// Returns the scene of the images, for lines of sight.
explore::SightScene ExploreWindow::sight_scene() {
  explore::SightScene scene{objects_.shown_file(session_), objects_.shown_revision(), objects_.time_s()};
  if (session_.follows_flight() && session_.player() != nullptr) scene.tracks = session_.player()->tracks();
  return scene;
}

// From the flight that plays, else from the motion since the last request.
std::vector<core::View> ExploreWindow::foreseen_views(const core::View& shown, double soon_s,
                                                      std::vector<core::View>& later) {
  const double at_s = now_s();
  const explore::FlightPlayer* flight = session_.follows_flight() ? session_.player() : nullptr;
  const auto add = [&](double ahead_s, std::vector<core::View>& views) {
    if (flight != nullptr) {
      if (flight->is_playing())
        views.emplace_back(shown).camera =
            flight->state_at(flight->time_s() + ahead_s * flight->speed()).camera;
      return;
    }
    if (!last_pose_ || at_s <= last_pose_->first) return;
    const auto pose =
        explore::foreseen({last_pose_->second, session_.pose(), at_s - last_pose_->first}, ahead_s);
    if (pose) views.emplace_back(shown).camera = mars::to_camera(*pose, session_.ground().radius_m);
  };
  std::vector<core::View> soon;
  add(soon_s, soon);
  for (const double ahead_s : {0.5, 1.0}) add(ahead_s, later);
  last_pose_ = {at_s, session_.pose()};
  return soon;
}

bool ExploreWindow::take_image() {
  std::optional<DrawnImage> drawn = maker_->take();
  if (!drawn) return false;
  frames_due_ = std::max(frames_due_, 1);
  state_.image_error = drawn->error;
  if (!drawn->error.empty()) {
    live_.record(drawn->seconds * 1e3, true);
    show_message(drawn->error, true);
    return true;
  }
  live_.record(drawn->seconds * 1e3, drawn->result.settled);
  if (const auto& failures = drawn->result.failures; !failures.empty()) {
    const std::size_t more = failures.size() - 1;
    show_message(failures.front() + (more > 0 ? " (and " + std::to_string(more) + " more)" : ""), true);
  }
  follow_ground(drawn->changed);
  if (!shared_.take(*drawn)) view_texture_.upload(drawn->image);
  if (!drawn->earlier.pixels.empty()) earlier_texture_.upload(drawn->earlier);
  const glm::ivec2 margin_px = drawn->request.margin_px;
  finer_.begin();  // not before: it would delay the first image
  ++images_;
  moved_image_.forget();
  if (!drawn->range_m.empty())
    moved_image_.take(
        {drawn->image.width, drawn->image.height, drawn->image.pixels, std::move(drawn->range_m)});
  last_image_ = core::without_margin(std::move(drawn->image), margin_px);
  if (!drawn->earlier.pixels.empty())
    drawn->earlier = core::without_margin(std::move(drawn->earlier), margin_px);
  drawn_ = std::move(*drawn);
  image_times_s_.push_back(drawn_->seconds);
  if (image_times_s_.size() > 20) image_times_s_.pop_front();
  history_.observe(now_s(), {session_.pose(), session_.screen().fov_deg}, session_.height_m());
  if (saves_image_ && drawn_->request.is_full && drawn_->result.settled) save_image();
  return true;
}

// Runs the rest of an iteration while a panorama is entered. Returns false outside of panoramas.
bool ExploreWindow::step_overlook(const DeviceReading& input, double dt_s) {
  OverlookView* inside = guide_.inside();
  if (inside == nullptr) return false;
  inside->place(view_area_);
  inside->advance(input.controls, input.look, dt_s);
  if (inside->update(kImageWait_s)) frames_due_ = std::max(frames_due_, 1);
  if (inside->message() != state_.message && !inside->message().empty())
    show_message(inside->message(), inside->message_is_error());
  const std::string error =
      recorder_.record_overlook(inside->viewer(), guide_.inside_camera_m(), session_, now_s());
  if (!error.empty()) show_message(error, true);
  if (!maps_rest()) frames_due_ = std::max(frames_due_, 1);
  if (frames_due_ > 0) {
    draw_frame();
    --frames_due_;
  }
  return true;
}

void ExploreWindow::leave_overlook() {
  if (guide_.inside() == nullptr) return;
  guide_.leave();
  clear_message();
  session_.release();
  frames_due_ = kFramesAfterChange;
  if (const std::string error = recorder_.leave_overlook(now_s()); !error.empty()) show_message(error, true);
}

// Returns the distance of the eyes, metres.
double ExploreWindow::eye_base_m() const {
  const double base_m = chooser_.choice().eye_base_m;
  return base_m > 0 ? base_m : core::base_for_height_m(session_.height_m());
}

// Returns the view of an eye, and where its image is. One image, and one of red and cyan, are of the middle.
EyeImage ExploreWindow::eye_image(int eye) const {
  const ImageLayout layout = image_layout();
  const ViewArea area = layout.eye_area(eye);
  if (layout.eyes() == 1) return {session_.view(), area.x, area.y};
  const double aside_m = (eye == 0 ? -0.5 : 0.5) * eye_base_m();
  return {core::eye_view(session_.view(), aside_m, core::convergence_at(chooser_.choice().convergence_m)),
          area.x, area.y};
}

// Finds the ground under the cursor. Over panels there is none.
void ExploreWindow::find_cursor() {
  measure_.update();
  under_cursor_.reset();
  if (state_.large_map || guide_.inside() != nullptr || ImGui::GetIO().WantCaptureMouse) return;
  const ImageLayout layout = image_layout();
  if (const auto xy = layout.camera_xy(cursor_))
    under_cursor_ = session_.place_at(eye_image(layout.eye_at(cursor_)).view, *xy);
}

// Returns true if the image is to follow the camera, which has moved since: what lies over the image at fixed places would
// move with it.
bool ExploreWindow::lags() const {
  if (!drawn_ || drawn_->grids.empty() || setup_.preferences.warp == explore::Warp::kOff ||
      drawn_->request.stereo != chooser_.choice().stereo || guide_.inside() != nullptr || state_.large_map ||
      !state_.image_error.empty())
    return false;
  return !has_fixed_overlay(session_.settings().values()) &&
         !is_same_sight(drawn_->request.draw.view, session_.view());
}

void ExploreWindow::draw_view() {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  if (!state_.image_error.empty()) {
    // The previous image does not belong to the present settings.
    draw_message(list, view_area_, state_.image_error);
    return;
  }
  if (!drawn_) return;
  const ViewArea area =
      drawn_->request.stereo == chooser_.choice().stereo ? image_layout().image_area() : view_area_;
  if (swipes() && !drawn_->earlier.pixels.empty()) {
    const double x = std::round(swipe_.x_px(area));
    const double bottom = area.y + area.height;
    list.PushClipRect(at(area.x, area.y), at(x, bottom), true);
    draw_image(list, area, earlier_texture_, drawn_->earlier_grids);
    list.PopClipRect();
    list.PushClipRect(at(x, area.y), at(area.x + area.width, bottom), true);
    draw_image(list, area, view_texture_, drawn_->grids);
    list.PopClipRect();
  } else {
    draw_image(list, area, shared_.shown() != nullptr ? *shared_.shown() : view_texture_, drawn_->grids);
  }
  shown_view_ = lags() ? session_.view() : drawn_->request.draw.view;
  // Images of the terrain come first: few frames are shown between quick ones.
  constexpr double kQuickest_s = 1.0 / 60;
  constexpr double kSlowest_s = 1.0 / 40;
  next_moved_s_ = now_s() + std::clamp(drawn_->seconds / 3, kQuickest_s, kSlowest_s);
  for (int n = 0; n < image_layout().eyes(); ++n) {
    const EyeImage eye = eye_image(n);
    const ViewArea clip = image_layout().eye_area(n);
    list.PushClipRect(at(clip.x, clip.y), at(clip.x + clip.width, clip.y + clip.height), true);
    draw_marks(list, eye);
    list.PopClipRect();
  }
  if (swipes()) swipe_.draw(list, area, display_.scale());
}

// Returns true if the view has the line between the earlier planet and this one.
bool ExploreWindow::swipes() const {
  return swipe_.is_on() && !chooser_.choice().stereo && guide_.inside() == nullptr &&
         setup_.planet->earlier() != nullptr;
}

const core::RgbImage& ExploreWindow::image() const {
  if (last_image_.pixels.empty() && shared_.shown() != nullptr) last_image_ = shared_.shown()->read_back();
  return last_image_;
}

// Returns the last image as the line shows it.
core::RgbImage ExploreWindow::swiped_image() const {
  core::RgbImage image = this->image();
  if (!swipes() || !drawn_ || drawn_->earlier.pixels.size() != image.pixels.size()) return image;
  const auto width = static_cast<std::size_t>(image.width);
  const auto left = static_cast<std::size_t>(std::lround(swipe_.share() * image.width));
  for (std::size_t row = 0; row < image.pixels.size(); row += width) {
    for (std::size_t x = 0; x < left; ++x) image.pixels[row + x] = drawn_->earlier.pixels[row + x];
  }
  return image;
}

// Draws an image of the last request, or what the camera sees of it now.
void ExploreWindow::draw_image(ImDrawList& list, const ViewArea& area, const Texture& texture,
                               const std::vector<warp::ImageGrid>& grids) {
  if (lags() && !grids.empty()) return draw_moved(list, texture, grids);
  const glm::dvec2 edge = glm::dvec2(drawn_->request.margin_px) / glm::dvec2(texture.width(), texture.height());
  list.AddImage(texture.id(), at(area.x, area.y), at(area.x + area.width, area.y + area.height),
                at(edge.x, edge.y), at(1 - edge.x, 1 - edge.y));
}

// Draws the last image of each eye as that eye sees it now.
void ExploreWindow::draw_moved(ImDrawList& list, const Texture& texture,
                               const std::vector<warp::ImageGrid>& grids) {
  const ImageLayout layout = image_layout();
  const glm::ivec2 counts = layout.counts();
  const glm::vec2 size = 1.0F / glm::vec2(counts);
  for (int n = 0; n < std::min(layout.eyes(), static_cast<int>(grids.size())); ++n) {
    const glm::ivec2 place(n % counts.x, n / counts.x);
    moved_image_.draw(list, {texture.id(), glm::vec2(place) * size, size}, layout.eye_area(n),
                      grids[static_cast<std::size_t>(n)], eye_image(n).view, setup_.preferences.warp);
  }
  if (setup_.preferences.warp == explore::Warp::kCarry && layout.eyes() == 1 && !swipes())
    moved_image_.draw_carried(list, layout.image_area(), grids.front().view(),
                              sized(session_.view(), last_image_), session_.height_m());
}

void ExploreWindow::draw_marks(ImDrawList& list, const EyeImage& eye) {
  if (!measure_.points().empty()) measure_.draw_marks(list, session_, eye);
  draw_flight_marks(list, session_, flight_.selected(), eye);
  drawing_.draw_marks(list, session_, under_cursor_, eye);
  objects_.draw_marks(list, session_, eye);
  reliefs_.draw_marks(list, session_, eye);
  layers_.draw_marks(list, session_, eye);
  guide_.draw_marks(list, session_, eye);
  if (session_.mouse_use() == explore::MouseUse::kTilt && session_.held_m())
    draw_pivot_mark(list, *session_.held_m(), eye);
}

}  // namespace vpe::window
