#include "objects/scene/place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>

#include "objects/scene/contact_plane.h"

namespace objects {

namespace {

// Above 0 also where it is too small for single precision.
float stored_scale(double scale) {
  return std::max(static_cast<float>(scale), std::numeric_limits<float>::min());
}

// Shorter legs have no direction.
constexpr double kLeastLeg_rad = 1e-13;

// Returns the unit direction of travel at d, from a to b along the great circle of mars::slerp().
glm::dvec3 travel_direction(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& d) {
  const glm::dvec3 normal = glm::cross(a, mars::slerp(a, b, 0.5) - a);
  return glm::normalize(glm::cross(normal, d));
}

// Returns the leg that gives the heading while the object is on `leg`: itself, or the one nearest to it, rather
// before than after, that leads anywhere. Returns the number of legs if there is none.
std::size_t leading_leg(const std::vector<PathPoint>& points, std::size_t leg) {
  const std::size_t legs = points.size() - 1;
  const auto leads = [&points](std::size_t n) {
    return mars::distance_rad(points[n].place, points[n + 1].place) > kLeastLeg_rad;
  };
  for (std::size_t n = leg + 1; n-- > 0;) {
    if (n < legs && leads(n)) return n;
  }
  for (std::size_t n = leg + 1; n < legs; ++n) {
    if (leads(n)) return n;
  }
  return legs;
}

// Returns the level axes for a heading, of which `forward` may be any level vector.
mars::LocalFrame level_frame(const glm::dvec3& up, const glm::dvec3& forward) {
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
  return {right, glm::cross(up, right), up};
}

mars::LocalFrame headed_frame(mars::LonLat place, double heading_deg) {
  const mars::Axes axes = mars::oriented_axes(mars::local_frame(place), heading_deg, 0, 0);
  return {axes.right, axes.forward, axes.up};
}

// Describes where a path is at a time.
struct PathState {
  mars::LonLat place;
  mars::LocalFrame frame;  // level; its north is the heading
  double height_m = 0;     // above the ground
};

PathState path_state(const std::vector<PathPoint>& points, double time_s) {
  const auto after = std::upper_bound(points.begin(), points.end(), time_s,
                                      [](double t, const PathPoint& point) { return t < point.time_s; });
  const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - points.begin() - 1, 0));
  const PathPoint& from = points[at];
  const glm::dvec3 start = mars::direction(from.place);
  const bool is_moving = at + 1 < points.size() && time_s > from.time_s;
  glm::dvec3 direction = start;
  PathState state{from.place, {}, from.height_m};
  if (is_moving) {
    const PathPoint& to = points[at + 1];
    const double t = (time_s - from.time_s) / (to.time_s - from.time_s);
    direction = glm::normalize(mars::slerp(start, mars::direction(to.place), t));
    state.place = mars::lon_lat(direction);
    state.height_m = std::lerp(from.height_m, to.height_m, t);
  }
  const std::size_t leg = from.heading_deg ? points.size() : leading_leg(points, at);
  if (leg + 1 >= points.size()) {
    state.frame = headed_frame(state.place, from.heading_deg.value_or(0));
  } else {
    const glm::dvec3 a = mars::direction(points[leg].place);
    const glm::dvec3 b = mars::direction(points[leg + 1].place);
    state.frame = level_frame(direction, travel_direction(a, b, direction));
  }
  return state;
}

}  // namespace

glm::quat rotation_of(const mars::Axes& axes) {
  glm::dquat q = glm::normalize(glm::quat_cast(glm::dmat3(axes.right, axes.forward, axes.up)));
  if (q.w < 0) q = -q;
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}

Instance place_instance(const Placing& placing, double foot_radius_m, double planet_radius_m,
                        const GroundRadius& ground_radius_m) {
  mars::LocalFrame frame = headed_frame(placing.place, placing.heading_deg);
  const glm::dvec3 up = frame.up;
  const bool is_above_ground = placing.height_kind == HeightKind::kAboveGround;
  const double ground_m = is_above_ground || placing.follows_slope ? ground_radius_m(up) : planet_radius_m;
  if (placing.follows_slope) {
    const double foot_m = std::max(foot_radius_m, kLeastFoot_m);
    const glm::dvec3 foot = up * ground_m;
    const std::array<glm::dvec3, 4> feet{foot + frame.north * foot_m, foot - frame.north * foot_m,
                                         foot + frame.east * foot_m, foot - frame.east * foot_m};
    frame = contact_plane(frame, foot, feet, ground_radius_m).frame;
  }
  Instance instance;
  instance.position_m = up * ((is_above_ground ? ground_m : planet_radius_m) + placing.height_m);
  instance.rotation = rotation_of(mars::oriented_axes(frame, 0, placing.pitch_deg, placing.roll_deg));
  instance.scale = stored_scale(placing.scale);
  return instance;
}

Placing placing_at(const Placing& placing, const std::vector<PathPoint>& points, double time_s) {
  const PathState state = path_state(points, time_s);
  const mars::LocalFrame north = mars::local_frame(state.place);
  const glm::dvec3& ahead = state.frame.north;
  Placing moved = placing;
  moved.place = state.place;
  moved.height_kind = HeightKind::kAboveGround;
  moved.height_m = state.height_m;
  moved.heading_deg =
      std::atan2(glm::dot(ahead, north.east), glm::dot(ahead, north.north)) / mars::kRadiansPerDegree;
  return moved;
}

Instance path_instance(const PathEntry& path, double time_s, const GroundRadius& ground_radius_m) {
  const PathState state = path_state(path.points, time_s);
  const mars::LocalFrame& level = state.frame;
  Instance instance;
  instance.model = static_cast<std::uint32_t>(path.model);
  instance.scale = stored_scale(path.scale);
  const bool has_wheels = path.wheelbase_m > 0 && path.track_m > 0;
  const ContactPlane stand = has_wheels ? wheel_plane(level, path.wheelbase_m, path.track_m, ground_radius_m)
                                        : ContactPlane{level, level.up * ground_radius_m(level.up)};
  instance.position_m = stand.origin_m + level.up * state.height_m;
  instance.rotation = rotation_of(mars::oriented_axes(stand.frame, 0, 0, 0));
  return instance;
}

}  // namespace objects
