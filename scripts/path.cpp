#include "scripts/path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "scripts/object_tracks.h"
#include "vpe/base/mutation.h"
#include "vpe/base/number.h"

namespace scripts {

namespace {

using vpe::base::format_number;
using vpe::base::Guard;
using vpe::base::mutated;

std::string pose_at(double time_s) { return "the flight's pose at " + format_number(time_s) + " s"; }

mars::Pose resolve(const Waypoint& w, double radius_m, const TerrainHeight& terrain_height_m,
                   double exaggeration) {
  mars::Pose pose{w.lon_deg, w.lat_deg, w.up_m, w.yaw_deg, w.pitch_deg, w.roll_deg};
  if (w.above_terrain) {
    const double terrain_m =
        terrain_height_m ? terrain_height_m({w.lon_deg, w.lat_deg}, exaggeration) : std::nan("");
    if (!std::isfinite(terrain_m)) {
      throw std::runtime_error(pose_at(w.time_s) + " has height=, but the terrain's height at lon " +
                               format_number(w.lon_deg) + " lat " + format_number(w.lat_deg) +
                               " is unknown: use alt= there");
    }
    pose.alt_m += terrain_m;
  }
  if (!(radius_m + pose.alt_m > 0.0)) {
    throw std::runtime_error(pose_at(w.time_s) + " lies at or below the planet's centre: alt must be above " +
                             format_number(-radius_m) + " m");
  }
  return pose;
}

glm::dvec3 place_of(const mars::Pose& pose) { return mars::direction({pose.lon_deg, pose.lat_deg}); }

glm::dvec4 attitude_of(const mars::Pose& pose) {
  const mars::Axes axes = mars::oriented_axes(mars::local_frame({pose.lon_deg, pose.lat_deg}), pose.yaw_deg,
                                              pose.pitch_deg, pose.roll_deg);
  const glm::dquat q = glm::normalize(glm::quat_cast(glm::dmat3(axes.right, axes.up, -axes.forward)));
  return {q.x, q.y, q.z, q.w};
}

mars::Axes axes_of(const glm::dvec4& attitude) {
  const glm::dmat3 m = glm::mat3_cast(glm::dquat(attitude.w, attitude.x, attitude.y, attitude.z));
  return {m[0], m[1], -m[2]};
}

bool same(const mars::Pose& a, const mars::Pose& b) {
  return a.lon_deg == b.lon_deg && a.lat_deg == b.lat_deg && a.alt_m == b.alt_m && a.yaw_deg == b.yaw_deg &&
         a.pitch_deg == b.pitch_deg && a.roll_deg == b.roll_deg;
}

bool same(const HeadCommand& a, const HeadCommand& b) {
  return a.yaw_deg == b.yaw_deg && a.pitch_deg == b.pitch_deg && a.roll_deg == b.roll_deg;
}

// Adds knots for the states that are held from the start and to the end, so that motion starts and ends
// smoothly.
template <class Timed>
std::vector<Timed> held_at_ends(std::vector<Timed> knots, double end_s) {
  if (knots.back().time_s < end_s) {
    knots.push_back(knots.back());
    knots.back().time_s = end_s;
  }
  if (knots.front().time_s > 0.0) {
    knots.insert(knots.begin(), Timed(knots.front()));
    knots.front().time_s = 0.0;
  }
  return knots;
}

template <class Timed, class Function>
auto map(const std::vector<Timed>& knots, const Function& function) {
  std::vector<decltype(function(knots.front()))> values;
  values.reserve(knots.size());
  for (const Timed& knot : knots) values.push_back(function(knot));
  return values;
}

template <class Timed>
std::vector<double> times_of(const std::vector<Timed>& knots) {
  return map(knots, [](const Timed& knot) { return knot.time_s; });
}

// Selects the sign of each quaternion that is nearer to the attitude before: both signs are one attitude.
std::vector<glm::dvec4> aligned(std::vector<glm::dvec4> attitudes) {
  for (std::size_t i = 1; i < attitudes.size(); ++i) {
    if (glm::dot(attitudes[i - 1], attitudes[i]) < 0.0) attitudes[i] = -attitudes[i];
  }
  return attitudes;
}

MonotoneSpline angle_spline(const std::vector<HeadCommand>& heads, double HeadCommand::*angle_deg) {
  std::vector<double> values = map(heads, [&](const HeadCommand& head) { return head.*angle_deg; });
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!mutated(Guard::kShortWay))
      values[i] = values[i - 1] + std::remainder(values[i] - values[i - 1], 360.0);
  }
  return {times_of(heads), std::move(values)};
}

// Returns the index of the first knot at or after a time, which must lie within the knots.
template <class Timed>
std::size_t knot_at_or_after(const std::vector<Timed>& knots, double time_s) {
  const auto found = std::lower_bound(knots.begin(), knots.end(), time_s,
                                      [](const Timed& knot, double t) { return knot.time_s < t; });
  return static_cast<std::size_t>(found - knots.begin());
}

template <class Command>
std::span<const Command> up_to(const std::vector<Command>& commands, double time_s) {
  const auto end = std::upper_bound(commands.begin(), commands.end(), time_s,
                                    [](double t, const Command& c) { return t < c.time_s; });
  return {commands.begin(), end};
}

std::shared_ptr<const GroundTracks> ground_of(const Flight& flight, double radius_m) {
  if (flight.reliefs.empty() && flight.patches.empty()) return nullptr;
  return std::make_shared<const GroundTracks>(flight, radius_m);
}

double half_fov_rad(double fov_deg) { return 0.5 * fov_deg * mars::kRadiansPerDegree; }

// Adds to each command what those before it say.
std::vector<ViewCommand> accumulated(std::vector<ViewCommand> views) {
  const auto keep = [](auto& now, const auto& before) {
    if (!now) now = before;
  };
  for (std::size_t i = 1; i < views.size(); ++i) {
    ViewState& now = views[i].view;
    const ViewState& before = views[i - 1].view;
    keep(now.size, before.size);
    keep(now.backend, before.backend);
    keep(now.eyes, before.eyes);
    keep(now.eye_base_m, before.eye_base_m);
    keep(now.convergence_m, before.convergence_m);
  }
  return views;
}

}  // namespace

std::vector<Path::Knot> Path::knots_of(const Flight& flight, const TerrainHeight& terrain_height_m) const {
  constexpr double kOpposite_rad = 1e-6;
  if (flight.waypoints.empty()) throw std::runtime_error("the flight has no pose");
  std::vector<Knot> knots;
  for (const Waypoint& w : flight.waypoints) {
    const Knot knot{w.time_s, resolve(w, radius_m_, terrain_height_m, exaggeration(w.time_s))};
    if (!knots.empty() &&
        mars::angle_between_rad(place_of(knots.back().pose), place_of(knot.pose)) > mars::kPi - kOpposite_rad) {
      throw std::runtime_error(pose_at(w.time_s) +
                               " is opposite to the pose before it, so the path between them is not defined: "
                               "add a pose between the two");
    }
    knots.push_back(knot);
  }
  return held_at_ends(std::move(knots), scripts::duration_s(flight));
}

Path::Path(const Flight& flight, double radius_m, const TerrainHeight& terrain_height_m, double exaggeration)
    : radius_m_(radius_m),
      duration_s_(scripts::duration_s(flight)),
      exaggeration_(exaggeration),
      sets_(flight.sets),
      knots_(knots_of(flight, terrain_height_m)),
      heads_(held_at_ends(flight.heads.empty() ? std::vector<HeadCommand>{HeadCommand{}} : flight.heads,
                          duration_s_)),
      interests_(flight.interests),
      tracks_(object_tracks(flight.objects)),
      ground_(ground_of(flight, radius_m)),
      views_(accumulated(flight.views)),
      place_(times_of(knots_), map(knots_, [](const Knot& knot) { return place_of(knot.pose); })),
      attitude_(times_of(knots_),
                aligned(map(knots_, [](const Knot& knot) { return attitude_of(knot.pose); }))),
      alt_m_(times_of(knots_), map(knots_, [](const Knot& knot) { return knot.pose.alt_m; })),
      head_yaw_deg_(angle_spline(heads_, &HeadCommand::yaw_deg)),
      head_pitch_deg_(angle_spline(heads_, &HeadCommand::pitch_deg)),
      head_roll_deg_(angle_spline(heads_, &HeadCommand::roll_deg)) {
  for (const ViewCommand& command : flight.views) {
    if (!command.view.fov_deg) continue;
    if (fovs_.empty() && command.time_s > 0) fovs_.push_back({0, flight.view.fov_deg});
    fovs_.push_back({command.time_s, *command.view.fov_deg});
  }
  if (fovs_.empty()) return;
  fovs_ = held_at_ends(std::move(fovs_), duration_s_);
  zoom_.emplace(times_of(fovs_),
                map(fovs_, [](const Fov& fov) { return std::log(std::tan(half_fov_rad(fov.fov_deg))); }));
}

std::optional<double> Path::fov_deg(double time_s) const {
  if (fovs_.empty()) return std::nullopt;
  const std::size_t i = knot_at_or_after(fovs_, time_s);
  const double at_deg = fovs_[i].fov_deg;
  if (fovs_[i].time_s == time_s || fovs_[i - 1].fov_deg == at_deg) return at_deg;
  const auto [least, most] = std::minmax(fovs_[i - 1].fov_deg, at_deg);
  return std::clamp(2.0 * std::atan(std::exp(zoom_->at(time_s))) / mars::kRadiansPerDegree, least, most);
}

FlightState Path::at(double time_s) const {
  const double t = time_s > 0.0 ? std::min(time_s, duration_s_) : 0.0;
  FlightState state;

  const std::size_t i = knot_at_or_after(knots_, t);
  if (knots_[i].time_s == t || same(knots_[i].pose, knots_[i - 1].pose)) {
    state.pose = knots_[i].pose;
  } else {
    state.pose = mars::to_pose({place_.at(t) * radius_m_, axes_of(attitude_.at(t))}, radius_m_);
    state.pose.alt_m = alt_m_.at(t);
  }

  const std::size_t h = knot_at_or_after(heads_, t);
  const HeadCommand& head = heads_[h];
  // A head that is held keeps its angles to the bit: they bypass the spline, which unwraps angles.
  if (head.time_s == t || same(head, heads_[h - 1])) {
    state.head = {head.yaw_deg, head.pitch_deg, head.roll_deg};
  } else {
    state.head = {mars::normalize_lon_deg(head_yaw_deg_.at(t)), head_pitch_deg_.at(t),
                  mars::normalize_lon_deg(head_roll_deg_.at(t))};
  }
  state.camera = mars::to_camera(state.pose, state.head, radius_m_);

  if (const std::span<const ViewCommand> views = up_to(views_, t); !views.empty())
    state.view = views.back().view;
  state.view.fov_deg = fov_deg(t);
  return state;
}

void Path::apply_settings(double time_s, vpe::core::Settings& settings) const {
  for (const SetCommand& command : up_to(sets_, time_s)) {
    const std::string problem = settings.set(command.key, command.text);
    if (!problem.empty()) {
      throw std::runtime_error("the flight's set at " + format_number(command.time_s) + " s: " + problem);
    }
  }
}

double Path::exaggeration(double time_s) const {
  double value = exaggeration_;
  for (const SetCommand& command : up_to(sets_, time_s)) {
    if (command.key == "exaggeration") value = vpe::base::parse_number(command.text).value_or(value);
  }
  return value;
}

std::span<const InterestCommand> Path::interests(double time_s) const { return up_to(interests_, time_s); }

std::optional<Clearance> lowest_clearance(const Path& path, const FrameRate& rate,
                                          const TerrainHeight& terrain_height_m) {
  return lowest_clearance(path, rate, [&](mars::LonLat place, double exaggeration, double) {
    return terrain_height_m(place, exaggeration);
  });
}

std::optional<Clearance> lowest_clearance(const Path& path, const FrameRate& rate,
                                          const ChangingTerrainHeight& terrain_height_m) {
  std::optional<Clearance> lowest;
  const std::int64_t frames = frame_count(rate, path.duration_s());
  for (std::int64_t k = 0; k < frames; ++k) {
    const double time_s = frame_time(rate, k);
    const mars::Pose pose = path.at(time_s).pose;
    const mars::LonLat place{pose.lon_deg, pose.lat_deg};
    const double height_m = pose.alt_m - terrain_height_m(place, path.exaggeration(time_s), time_s);
    if (std::isfinite(height_m) && (!lowest || height_m < lowest->height_m))
      lowest = {k, time_s, height_m, place};
  }
  return lowest;
}

}  // namespace scripts
