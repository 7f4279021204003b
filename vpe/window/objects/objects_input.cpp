// Objects that are placed and dragged in the view, and the camera that follows one.
//
// GLFW would include OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "vpe/window/marks/pose_drag.h"
#include "vpe/window/objects/objects_panel.h"
#include "vpe/window/ui/letter_key.h"

namespace vpe::window {

using explore::SharedItem;
using objects::HeightKind;
using objects::Placing;

namespace {

constexpr double kObjectClick_px = 5;  // a press that moves farther is a drag
constexpr double kSecondPlace_s = 0.35;
constexpr double kSecondPlace_px = 6;
constexpr double kTurn_deg_px = 0.25;      // on an image of 720 rows, as drags that tilt
constexpr double kDistanceNotch = 1.35;    // as the wheel
constexpr double kKeepsOffset_radii = 60;  // a camera that is nearer stays where it is

// Returns a place that is written with few digits, a tenth of a millimetre aside at most.
mars::LonLat rounded(mars::LonLat place) {
  constexpr double kParts = 1e9;  // of a degree
  return {std::round(place.lon_deg * kParts) / kParts, std::round(place.lat_deg * kParts) / kParts};
}

bool is_plain_press(const Event& event) {
  return (event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0;
}

bool is_same_pose(const mars::Pose& a, const mars::Pose& b) {
  return a.lon_deg == b.lon_deg && a.lat_deg == b.lat_deg && a.alt_m == b.alt_m && a.yaw_deg == b.yaw_deg &&
         a.pitch_deg == b.pitch_deg && a.roll_deg == b.roll_deg;
}

}  // namespace

bool ObjectsPanel::is_shown() const { return ImGui::GetFrameCount() - shown_frame_ <= 1; }

bool ObjectsPanel::handle(const Event& event, std::optional<glm::dvec2> xy, bool is_typing,
                          explore::Session& session, const core::View& view) {
  switch (event.kind) {
    case Event::Kind::kKeyPress:
    case Event::Kind::kKeyRepeat: return !is_typing && handle_key(event, session);
    case Event::Kind::kPress: return xy && handle_press(event, *xy, session, view);
    case Event::Kind::kMove:
      if (pressed_ && (!xy || glm::length(*xy - *pressed_) > kObjectClick_px)) pressed_.reset();
      if (turning_ && xy) turn(*xy, session);
      if (held_ && xy) drag(*xy, session, view);
      return holds();
    case Event::Kind::kScroll:
      if (!follow_ || follow_->arrives || !xy) return false;
      if (const auto ball = ball_of(follow_->id, session))
        follow_->offset = explore::turned(follow_->offset, *ball, 0, 0,
                                          std::pow(kDistanceNotch, -std::clamp(event.scroll, -10.0, 10.0)));
      return true;
    case Event::Kind::kRelease: {
      if (turning_ && turning_->button == event.code) {
        turning_.reset();
        return true;
      }
      if (event.code != GLFW_MOUSE_BUTTON_LEFT) return false;
      const bool held = std::exchange(held_, std::nullopt).has_value();
      if (!std::exchange(pressed_, std::nullopt) || !xy) return held;
      last_click_ = {event.time_s, *xy};
      place(session.place_at(view, *xy), session);
      return false;  // the session ends its own drag
    }
    default: return false;
  }
}

bool ObjectsPanel::handle_press(const Event& event, glm::dvec2 xy, const explore::Session& session,
                                const core::View& view) {
  if (follow_ && !follow_->arrives) {
    turning_ = Turning{event.code, xy};
    return true;
  }
  if (event.code != GLFW_MOUSE_BUTTON_LEFT || !is_plain_press(event)) return false;
  if (is_placing_) {
    // Two quick clicks place one object and do not fly there.
    const bool again = last_click_ && event.time_s - last_click_->first < kSecondPlace_s &&
                       glm::length(last_click_->second - xy) < kSecondPlace_px;
    if (again) return true;
    pressed_ = xy;
    return false;
  }
  if (!is_shown()) return false;
  const std::uint64_t id = item_at(xy, session, view);
  if (id == 0) return false;
  select(id);
  const SharedItem item = editor_.find(id);
  const core::ObjectTrack* track = explore::track_of(*item, tracks_.get());
  if (explore::single_placing(*item) == nullptr || (track != nullptr && !track->points.empty())) return false;
  const core::Projected origin = core::project(view, balls(item, session).front().origin_m);
  held_ = Held{id, xy, origin.behind ? glm::dvec2(0, 0) : origin.xy - xy, false};
  return true;
}

std::uint64_t ObjectsPanel::item_at(glm::dvec2 xy, const explore::Session& session, const core::View& view) {
  explore::PickRay ray;
  ray.camera_m = view.camera.position_m;
  ray.direction = core::pixel_ray(view, xy.x, xy.y);
  ray.until_m = session.ground().cast_m(ray.camera_m, ray.direction);
  ray.reach_rad = ObjectsPanelLimits::kReach_px / core::focal_px(view);
  std::uint64_t found = 0;
  std::size_t looked_at = 0;
  for (const SharedItem& item : editor_.items()) {
    if (++looked_at > ObjectsPanelLimits::kMostItems) break;
    if (std::holds_alternative<objects::ScatterEntry>(item->entry)) continue;
    for (const explore::ItemBall& ball : balls(item, session)) {
      const auto at_m = explore::meets(ray, ball);
      if (!at_m) continue;
      ray.until_m = *at_m;
      found = item->id;
    }
  }
  return found;
}

void ObjectsPanel::drag(glm::dvec2 xy, const explore::Session& session, const core::View& view) {
  const SharedItem item = editor_.find(held_->id);
  const Placing* placing = item == nullptr ? nullptr : explore::single_placing(*item);
  if (placing == nullptr) return held_.reset();
  if (!held_->has_moved && glm::length(xy - held_->press_px) <= kObjectClick_px) return;
  const glm::dvec2 at = xy + held_->aside_px;
  const explore::TerrainQuery& ground = session.ground();
  const bool is_above_ground = placing->height_kind == HeightKind::kAboveGround;
  std::optional<mars::LonLat> to;
  if (is_above_ground && placing->height_m == 0) {
    to = session.place_at(view, at);
  } else {
    to = dragged_pose(view, placing->place, at, [&](mars::LonLat place) {
      return ground.radius_m + placing->height_m +
             (is_above_ground ? ground.height_m(mars::direction(place)) : 0.0);
    });
  }
  if (!to) return;  // over the sky it stays
  report(editor_.move(held_->id, rounded(*to), held_->has_moved));
  held_->has_moved = true;
}

void ObjectsPanel::turn(glm::dvec2 xy, const explore::Session& session) {
  const glm::dvec2 by = (xy - turning_->last_px) * (kTurn_deg_px * 720.0 / session.screen().height);
  turning_->last_px = xy;
  if (!follow_) return;
  if (const auto ball = ball_of(follow_->id, session))
    follow_->offset = explore::turned(follow_->offset, *ball, by.x, -by.y, 1);
}

// Places an object like the last one of the same model, turned as the camera is.
void ObjectsPanel::place(std::optional<mars::LonLat> at, const explore::Session& session) {
  if (!at) return report("there is no ground there");
  const auto count = editor_.models().size();
  const auto index = static_cast<std::size_t>(model_);
  if (index >= count + typed_models_.size()) return report("enter the file of a model first");
  const objects::ModelEntry model = index < count ? editor_.models()[index] : typed_models_[index - count];
  if (const std::string error = sizes_.error(model); !error.empty()) return report(error);
  Placing placing;
  placing.follows_slope = true;
  for (const SharedItem& item : editor_.items()) {
    const auto* object = std::get_if<objects::ObjectEntry>(&item->entry);
    if (object != nullptr && object->model == index && explore::single_placing(*item) != nullptr)
      placing = object->places.front();
  }
  if (placing.height_kind == HeightKind::kAltitude) placing.height_m = 0;
  placing.height_kind = HeightKind::kAboveGround;
  placing.place = rounded(*at);
  placing.heading_deg = std::round(std::remainder(session.pose().yaw_deg, 360.0));
  if (placing.heading_deg < 0) placing.heading_deg += 360;
  const std::string problem = editor_.add(model, placing);
  if (!problem.empty()) return report(problem);
  if (index >= count) {
    typed_models_.erase(typed_models_.begin() + static_cast<std::ptrdiff_t>(index - count));
    model_ = static_cast<int>(editor_.models().size()) - 1;
  }
  select(editor_.newest());
}

bool ObjectsPanel::handle_key(const Event& event, explore::Session& session) {
  const bool is_first = event.kind == Event::Kind::kKeyPress;
  const bool ctrl = (event.modifiers & GLFW_MOD_CONTROL) != 0;
  if ((event.modifiers & (GLFW_MOD_ALT | GLFW_MOD_SHIFT)) != 0) return false;
  if (ctrl) {
    if (!is_shown() || !editor_.is_changed() || !is_letter_key(event.code, 's')) return false;
    if (is_first) save(session);
    return true;
  }
  switch (event.code) {
    case GLFW_KEY_ESCAPE:
      if (!is_first) return false;
      if (std::exchange(is_placing_, false)) return true;
      if (!follow_) return false;
      follow_.reset();
      turning_.reset();
      tell("the object is no longer followed");
      return true;
    case GLFW_KEY_V:
    case GLFW_KEY_INSERT:
      if (!is_placing_) return false;
      if (is_first)
        place(session.place_at({session.screen().width / 2.0, session.screen().height / 2.0}), session);
      return true;
    case GLFW_KEY_DELETE:
      if (!is_shown() || editor_.find(selected_) == nullptr) return false;
      if (is_first) report(editor_.remove(selected_));
      return true;
    default: return false;
  }
}

const ObjectsPanel::Balls& ObjectsPanel::balls(const SharedItem& item, const explore::Session& session) {
  const BallsOf of{&session.surface(), session.settings().values().exaggeration, sizes_.revision(), tracks_};
  // Items that were edited or deleted leave balls behind.
  if (of != balls_of_ || balls_.size() > 2 * editor_.items().size() + 50) balls_.clear();
  balls_of_ = of;
  const core::ObjectTrack* track = explore::track_of(*item, tracks_.get());
  const bool moves = track != nullptr || std::holds_alternative<objects::PathEntry>(item->entry);
  const auto known = balls_.find(item);
  if (known != balls_.end() && !moves) return known->second;
  return balls_[item] = explore::balls_of(
             *item, editor_.models(), [this](const objects::ModelEntry& model) { return sizes_.ball(model); },
             session.ground(), time_s_, track);
}

std::optional<explore::ItemBall> ObjectsPanel::ball_of(std::uint64_t id, const explore::Session& session) {
  const SharedItem item = editor_.find(id);
  if (item == nullptr) return std::nullopt;
  const Balls& all = balls(item, session);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

// Leaves the flight, and the ways that it gives to objects.
void ObjectsPanel::leave_flight(explore::Session& session) {
  session.leave_flight();
  tracks_.reset();
}

void ObjectsPanel::go_to(std::uint64_t id, explore::Session& session) {
  leave_flight(session);
  const auto ball = ball_of(id, session);
  if (!ball) return;
  follow_.reset();
  session.go(explore::pose_at(*ball, explore::usual_offset(*ball, session.pose().yaw_deg), session.ground()));
}

void ObjectsPanel::follow(std::uint64_t id, explore::Session& session) {
  leave_flight(session);
  const auto ball = ball_of(id, session);
  if (!ball) return;
  is_placing_ = false;
  if (session.mover().is_on_ground()) session.set_mode(explore::MotionMode::kOrbit);
  const explore::ObjectOffset here = explore::offset_of(session.pose(), *ball, session.ground().radius_m);
  const double distance_m =
      glm::length(ball->centre_m - mars::to_camera(session.pose(), session.ground().radius_m).position_m);
  follow_ = Following{id, here, distance_m > kKeepsOffset_radii * ball->radius_m};
  if (follow_->arrives)
    session.go(explore::pose_at(*ball, explore::usual_offset(*ball, session.pose().yaw_deg), session.ground()));
  tell("following; drag to look from elsewhere, Esc ends it");
}

void ObjectsPanel::advance(double dt_s, bool moves_by_hand, explore::Session& session) {
  if (clock_revision_ != editor_.revision()) {
    clock_.set_range(explore::time_range(editor_.items()));
    clock_revision_ = editor_.revision();
  }
  follows_flight_ = session.follows_flight();
  const explore::FlightPlayer* flight = follows_flight_ ? session.player() : nullptr;
  tracks_ = flight != nullptr ? flight->tracks() : nullptr;
  if (flight != nullptr) {
    clock_.play(false);
    clock_.set(flight->time_s());
  }
  clock_.advance(dt_s);
  time_s_ = flight != nullptr ? flight->time_s() : clock_.time_s();
  if (!follow_) return;
  const auto ball = ball_of(follow_->id, session);
  const bool is_taken = moves_by_hand || follows_flight_ || (session.is_going() && !follow_->arrives);
  if (!ball || is_taken) {
    follow_.reset();
    turning_.reset();
    return tell("the object is no longer followed");
  }
  if (follow_->arrives) {
    if (session.is_going()) return;
    follow_->arrives = false;
    follow_->offset = explore::offset_of(session.pose(), *ball, session.ground().radius_m);
  }
  const mars::Pose pose = explore::pose_at(*ball, follow_->offset, session.ground());
  if (!is_same_pose(pose, session.pose())) session.put(pose);
}

}  // namespace vpe::window
