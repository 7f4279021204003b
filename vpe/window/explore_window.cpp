#include "vpe/window/explore_window.h"

// GLFW would include OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <utility>

#include "vpe/base/heap.h"
#include "vpe/window/panels/overlay_bar.h"

namespace vpe::window {

namespace {

constexpr double kShortestFrame_s = 1.0 / 120;
constexpr double kIdle_s = 0.5;
constexpr double kMessage_s = 6;  // for which it is shown
constexpr double kError_s = 30;
constexpr double kPoll_s = 1.0 / 60;  // of devices that send no events
constexpr double kKeepSession_s = 2;
constexpr double kAskJobs_s = 0.25;
constexpr double kHoverFrame_s = 0.1;  // while only the cursor moves over the view

}  // namespace

ExploreWindow::ExploreWindow(ExploreSetup setup)
    : setup_(std::move(setup)),
      session_(setup_.surface, setup_.session),
      display_(setup_.display),
      map_(setup_.planet, setup_.threads, [] { Display::wake(); }),
      measure_(
          setup_.surface, [] { Display::wake(); }, setup_.open_scene),
      flight_(setup_.flight_file, setup_.folder),
      places_(setup_.bookmarks),
      search_(explore::PlaceSearch(setup_.places)),
      files_(setup_.recent, setup_.folder),
      jobs_(setup_.start_job),
      welcome_(search_.places()),
      objects_(setup_.model_ball, setup_.folder, setup_.state, [] { Display::wake(); }),
      reliefs_(setup_.surface, setup_.folder, setup_.state),
      layers_(setup_.planet->radius_m(), [] { Display::wake(); }),
      measured_(setup_.surface),
      drawing_(session_.flights(), setup_.surface, setup_.folder, [] { Display::wake(); }),
      project_file_(setup_.project_file),
      drawing_copy_(setup_.state, ".vpeproj", "drawings"),
      guide_(setup_.hotspots, setup_.open_overlook),
      backup_(setup_.state),
      shared_(display_,
              setup_.planet->earlier() ? explore::DrawContextChoice::kOwn : setup_.preferences.context,
              setup_.has_gpu),
      live_({setup_.session.settings.values().lod_frame_ms}),
      devices_(setup_.preferences, std::move(setup_.devices)),
      history_(session_.ground().radius_m),
      opener_(setup_.open_planet, [] { Display::wake(); }),
      finer_(setup_.make_finer, [] { Display::wake(); }),
      first_fov_deg_(setup_.session.fov_deg),
      begun_s_(display_.now_s()),
      last_step_s_(begun_s_),
      maker_(std::make_unique<ImageMaker>(setup_.make_painter, [] { Display::wake(); })) {
  swipe_.set_on(setup_.planet != nullptr && setup_.planet->earlier() != nullptr);
  state_.drawn_by = setup_.drawn_by;
  state_.panels = setup_.panels;
  state_.side_px = setup_.side_px;
  state_.letters = setup_.letters;
  if (!setup_.greets) welcome_.dismiss();
  files_.add_recent(setup_.planet_file.string());
  files_.add_recent(setup_.project_file.string());
  lay_out();
  if (!setup_.session.start)
    session_.put(explore::overview({0, 0}, session_.screen(), session_.ground().radius_m));
  if (!setup_.log.empty()) set_recording(true, setup_.log);
  // All errors are shown together, and instead of other messages.
  std::string errors = state_.message_is_error ? state_.message : "";
  const auto add = [&errors](const std::string& error) {
    if (!error.empty()) errors += (errors.empty() ? "" : "; ") + error;
  };
  for (const std::string& error : devices_.errors()) add(error);
  if (setup_.flight) add(session_.flights().load(*setup_.flight));
  add(open_project());
  if (!setup_.reliefs_file.empty()) {
    reliefs_.open(setup_.reliefs_file);
    if (const ReliefsActions actions = reliefs_.take_actions(); actions.message_is_error) add(actions.message);
  }
  open_screens();
  const std::vector<std::filesystem::path> abandoned = backup_.abandoned();
  flight_.offer(abandoned);
  if (!errors.empty())
    show_message(errors, true);
  else if (finer_.is_making())
    clear_message();
  else if (!abandoned.empty())
    show_message("an earlier session left an unsaved flight: 'Restore' in the panel 'Flight' opens it");
  else if (!drawing_copy_.abandoned().empty())
    show_message("an earlier session left unsaved drawings: 'Restore' in the panel 'Draw' adds them");
  else if (!objects_.abandoned().empty())
    show_message("an earlier session left an unsaved scene: 'Restore' in the panel 'Objects' opens it");
  else if (!reliefs_.abandoned().empty())
    show_message("an earlier session left unsaved reliefs: 'Restore' in the panel 'Ground' opens them");
}

ExploreWindow::~ExploreWindow() { (void)recorder_.stop(now_s()); }

double ExploreWindow::now_s() const { return display_.now_s() - begun_s_; }

void ExploreWindow::run() {
  while (step(kIdle_s) && next_planet_ == nullptr) {
  }
}

bool ExploreWindow::is_at_rest() const {
  if (guide_.inside() != nullptr) return guide_.inside()->is_at_rest() && frames_due_ <= 0;
  return maker_->is_idle() && (screens_ == nullptr || screens_->is_at_rest()) && maps_rest() &&
         measure_.is_at_rest() && drawing_.is_at_rest() && objects_.is_at_rest() && layers_.is_at_rest() &&
         !measures_other_ground() && !session_.is_going() && !session_.is_moving() && frames_due_ <= 0 &&
         live_.state() == lod::RefinementState::kWaiting;
}

bool ExploreWindow::maps_rest() const {
  return (!state_.panels || layout_.side.width <= 0 || map_.is_at_rest()) &&
         (!state_.large_map || large_map_ == nullptr || large_map_->is_at_rest());
}

bool ExploreWindow::shows_final_image() const {
  return drawn_ && state_.image_error.empty() && drawn_->result.settled && drawn_->request.is_full &&
         maker_->is_idle() && live_.state() == lod::RefinementState::kWaiting;
}

// Returns how long an iteration may wait for events. A finished image is an event too.
double ExploreWindow::event_wait_s(bool moves, double rest_s) const {
  const double since_s = display_.now_s() - last_step_s_;
  const double pause_s = std::max(0.0, kShortestFrame_s - since_s);
  if (guide_.inside() != nullptr) return !guide_.inside()->is_at_rest() || frames_due_ > 0 ? pause_s : rest_s;
  if (frames_due_ > 0) return std::max(pause_s, next_frame_s_ - now_s());
  if (!maker_->is_idle()) {
    const bool follows = lags() || (moves && drawn_ && !drawn_->grids.empty());
    return follows ? std::max(pause_s, next_moved_s_ - now_s()) : std::min(rest_s, kImageWait_s);
  }
  return moves || live_.state() != lod::RefinementState::kWaiting ? pause_s : rest_s;
}

// Returns freed memory to the system once the view has rested for a while: tiles that came and went leave holes in the heap.
void ExploreWindow::tidy_at_rest(bool busy) {
  constexpr double kRest_s = 1;
  if (busy) {
    rests_since_s_ = now_s();
    is_tidy_ = false;
  } else if (!is_tidy_ && now_s() - rests_since_s_ > kRest_s) {
    base::return_freed_memory();
    is_tidy_ = true;
  }
}

// Returns the mode in which keys act: a flight and a panorama have their own.
explore::MotionMode ExploreWindow::key_mode() const {
  return session_.follows_flight() || guide_.inside() != nullptr ? explore::MotionMode::kOrbit
                                                                 : session_.mode();
}

// Where the cursor moves over the view alone, little changes but the read-out.
bool ExploreWindow::is_over_view() const {
  return view_area_.holds(cursor_.x, cursor_.y) && !ImGui::GetIO().WantCaptureMouse && !state_.help &&
         !state_.large_map && !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
}

bool ExploreWindow::step(double wait_s) {
  const explore::FlightPlayer* flight = session_.follows_flight() ? session_.player() : nullptr;
  const bool plays = flight != nullptr && flight->is_playing();
  const bool moves =
      session_.is_going() || session_.is_moving() || plays || was_moving_ || objects_.is_moving();
  const bool is_inside = guide_.inside() != nullptr;
  const bool busy = is_inside ? !guide_.inside()->is_at_rest() || frames_due_ > 0
                              : moves || !maker_->is_idle() || frames_due_ > 0 ||
                                    live_.state() != lod::RefinementState::kWaiting;
  double rest_s = devices_.polls(now_s()) ? std::min(wait_s, kPoll_s) : wait_s;
  if (shows_progress()) rest_s = std::min(rest_s, kAskJobs_s);
  if (tip_at_s_) rest_s = std::min(rest_s, std::max(*tip_at_s_ - now_s(), 0.001));
  const std::vector<Event> events = display_.events(event_wait_s(moves, rest_s));
  if (tip_at_s_ && now_s() >= *tip_at_s_) {
    tip_at_s_.reset();
    frames_due_ = std::max(frames_due_, 1);
  }
  if (display_.should_close()) return false;
  for (const Event& event : events) {
    handle(event);
    const bool hovers = event.kind == Event::Kind::kMove && (display_.has_caught_cursor() || is_over_view());
    if (!hovers) next_frame_s_ = 0;
    frames_due_ = std::max(frames_due_, hovers ? 1 : kFramesAfterChange);
  }
  lay_out();
  const DeviceReading input =
      devices_.read(now_s(), ImGui::GetIO().WantTextInput || panel_focus_.is_on(), key_mode());
  for (const explore::Action& action : input.actions) {
    if (const std::string error = act(action); !error.empty()) show_message(error, true);
    frames_due_ = kFramesAfterChange;
  }
  follow_caught_cursor();
  display_.show_hand(session_.mouse_use() == explore::MouseUse::kHold || flight_.holds_pose() ||
                     drawing_.sketch().held().has_value() || objects_.holds() || reliefs_.holds());
  const double step_s = display_.now_s();
  // The time of a rest does not count as motion.
  const double dt_s = busy ? step_s - last_step_s_ : 0.0;
  last_step_s_ = step_s;
  take_planets();
  update_layers();
  if (shows_progress() && now_s() - jobs_asked_s_ >= kAskJobs_s) update_jobs();
  const double shown_s = now_s() - state_.message_since_s;
  if (!state_.message.empty() && shown_s > (state_.message_is_error ? kError_s : kMessage_s)) clear_message();
  keep_work(busy);
  tidy_at_rest(busy);
  if (step_overlook(input, dt_s)) return !display_.should_close();
  explore::Controls controls = input.controls;
  controls.speed *= state_.speed;
  was_moving_ = explore::any(controls);
  if (was_moving_) welcome_.dismiss();
  session_.advance(dt_s, controls, input.look);
  objects_.advance(dt_s, was_moving_, session_);

  if (const std::string text = guide_.follow(session_, view_area_); !text.empty()) show_message(text);

  // The next image is drawn while the last one is shown.
  const bool is_new = take_image();
  request_image();
  update_screens(input.head);
  measure_on_ground();
  measure_.set_scene(sight_scene());
  if (!maps_rest() || !measure_.is_at_rest() || !drawing_.is_at_rest() || objects_.is_moving())
    frames_due_ = std::max(frames_due_, 1);
  if (shown_devices_ && shown_devices_ != devices_.states(now_s())) frames_due_ = std::max(frames_due_, 1);
  const bool moves_image =
      lags() && now_s() >= next_moved_s_ && (!shown_view_ || !is_same_sight(*shown_view_, session_.view()));
  if (is_new || moves_image || (frames_due_ > 0 && now_s() >= next_frame_s_)) {
    draw_frame();
    frames_due_ = std::max(frames_due_ - 1, 0);
    next_frame_s_ = frames_due_ > 0 ? 0 : now_s() + kHoverFrame_s;
  }
  return !display_.should_close();
}

void ExploreWindow::take_planets() {
  try {
    if (auto planet = opener_.take()) {
      next_planet_ = std::move(planet);
      next_project_ = std::exchange(opening_project_, {});
    }
    if (auto finer = finer_.take()) replace_planet(std::move(*finer));
  } catch (const std::exception& e) {
    opening_project_.clear();
    show_message(e.what(), true);
  }
}

void ExploreWindow::replace_planet(ShownPlanet next) {
  static_cast<ShownPlanet&>(setup_) = std::move(next);
  session_.set_surface(setup_.surface);
  map_.set_planet(setup_.planet);
  if (large_map_ != nullptr) large_map_->set_planet(setup_.planet);
  measure_.set_surface(setup_.surface, setup_.open_scene);
  drawing_.set_surface(setup_.surface);
  reliefs_.set_surface(setup_.surface);
  measured_ = setup_.surface;
  maker_ = std::make_unique<ImageMaker>(setup_.make_painter, [] { Display::wake(); });
  if (screens_ != nullptr) screens_->set_painter(screen_painter());
  show_message("the planet is complete");
}

// Keeps the flight as it is between two drags, and the session when the view has come to rest.
void ExploreWindow::keep_work(bool is_busy) {
  take_drawing_actions();
  keep_drawings();
  keep_scene();
  keep_reliefs();
  if (!ImGui::IsAnyMouseDown()) {
    if (const std::string error = backup_.update(session_.flights().editor()); !error.empty())
      show_message(error, true);
  }
  if (!setup_.keep_session || is_busy || now_s() - session_kept_s_ < kKeepSession_s) return;
  const mars::Pose& p = session_.pose();
  const KeptSession now{{p.lon_deg, p.lat_deg, p.alt_m, p.yaw_deg, p.pitch_deg, p.roll_deg},
                        state_.drawn_by,
                        state_.panels,
                        state_.side_px,
                        state_.letters,
                        overlays_on(session_.settings()),
                        display_.size()};
  if (session_kept_ == now) return;
  session_kept_s_ = now_s();
  session_kept_ = now;
  setup_.keep_session(*this);
}

void ExploreWindow::lay_out() {
  int width = 1;
  int height = 1;
  display_.framebuffer(width, height);
  const double scale = state_.letters > 0 ? state_.letters : display_.usual_scale();
  display_.set_scale(std::min(scale, largest_scale(width, height)));
  layout_ = layout_of({width, height, display_.scale(), state_.panels, state_.side_px, state_.side_is_open});
  view_area_ = layout_.view;
  const glm::ivec2 size = image_layout().eye_size();
  session_.resize(size.x, size.y);
}

void ExploreWindow::clear_message() {
  state_.message = opener_.is_opening() ? "opening " + opener_.file() + " ..."
                   : finer_.is_making() && !finer_.is_stopped()
                       ? "coarse ground, until the planet is built (once, about a minute) ..."
                       : "";
  state_.message_is_error = false;
  state_.message_since_s = now_s();
  frames_due_ = kFramesAfterChange;
}

void ExploreWindow::show_message(std::string text, bool is_error) {
  state_.message = std::move(text);
  state_.message_is_error = is_error;
  state_.message_since_s = now_s();
  frames_due_ = kFramesAfterChange;
}

}  // namespace vpe::window
