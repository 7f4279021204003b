#include "vpe/explore/traverse/traverse.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "vpe/base/number.h"
#include "vpe/explore/walk.h"

namespace vpe::explore {

namespace {

constexpr double kLooksAhead_m = 10;  // of the walker
constexpr double kMostGaze_deg = 30;  // of the walker's pitch
constexpr double kSameStep_rad = 1e-12;

void check(const char* what, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw std::invalid_argument(std::string(what) + " must be from " + base::format_number(least) + " to " +
                              base::format_number(most));
}

// A way of great circles with its length so far.
class Way {
 public:
  Way(std::span<const mars::LonLat> places, double radius_m) : radius_m_(radius_m) {
    for (const mars::LonLat& place : places) {
      const glm::dvec3 at = mars::direction(place);
      if (directions_.empty()) {
        directions_.push_back(at);
        ends_m_.push_back(0);
        continue;
      }
      const double angle_rad = mars::angle_between_rad(directions_.back(), at);
      if (angle_rad < kSameStep_rad) continue;
      if (mars::kPi - angle_rad < 1e-6)
        throw std::invalid_argument(
            "two successive places are opposite, so there is no shortest way; give one between");
      directions_.push_back(at);
      ends_m_.push_back(ends_m_.back() + angle_rad * radius_m_);
    }
    if (directions_.size() < 2) throw std::invalid_argument("a traverse needs at least two different places");
  }

  double length_m() const { return ends_m_.back(); }
  std::size_t legs() const { return directions_.size() - 1; }
  double begin_m(std::size_t leg) const { return ends_m_[leg]; }
  double end_m(std::size_t leg) const { return ends_m_[leg + 1]; }

  // Returns the direction at a distance from the start, clamped to the way.
  glm::dvec3 at(double way_m) const {
    const auto after = std::upper_bound(ends_m_.begin() + 1, ends_m_.end() - 1, way_m);
    const auto leg = static_cast<std::size_t>(after - ends_m_.begin()) - 1;
    const double share = std::clamp((way_m - ends_m_[leg]) / (ends_m_[leg + 1] - ends_m_[leg]), 0.0, 1.0);
    if (share == 0.0) return directions_[leg];
    if (share == 1.0) return directions_[leg + 1];
    return mars::slerp(directions_[leg], directions_[leg + 1], share);
  }

  // Returns the heading at a distance, of the chord from `reach_m` before it to as far behind it.
  double heading_deg(double way_m, double reach_m) const {
    const mars::LonLat here = mars::lon_lat(at(way_m));
    const mars::LonLat to = mars::lon_lat(at(way_m + reach_m));
    const mars::LonLat from = mars::lon_lat(at(way_m - reach_m));
    // Where the way turns back, the chord is a point: the heading is that of what follows.
    const bool turns_back = mars::distance_rad(from, to) * radius_m_ < 0.1 * reach_m;
    if (turns_back && mars::distance_rad(here, to) > 0) return mars::initial_bearing_deg(here, to);
    return mars::initial_bearing_deg(from, to);
  }

 private:
  double radius_m_;
  std::vector<glm::dvec3> directions_;
  std::vector<double> ends_m_;  // of the way up to each direction
};

struct Plan {
  double speed_m_s = 0;
  double camera_height_m = 0;
  double step_m = 0;
  double turns_m = 0;
};

Plan plan_of(const TraverseOptions& o, double length_m) {
  const bool drives = o.by == TraverseBy::kDrive;
  const bool walks = o.by == TraverseBy::kWalk;
  Plan plan;
  plan.speed_m_s = o.speed_m_s.value_or(walks ? stride_m_s(0) : drives ? o.vehicle.speed_m_s : 50);
  plan.camera_height_m = o.camera_height_m.value_or(walks    ? WalkLimits::kEye_m
                                                    : drives ? o.vehicle.mast_m
                                                             : 100);
  check("the speed", plan.speed_m_s, TraverseOptions::kMinSpeed_m_s, TraverseOptions::kMaxSpeed_m_s);
  check("the height of the eye", plan.camera_height_m, TraverseOptions::kMinEye_m, TraverseOptions::kMaxEye_m);
  const double usual_m = walks ? 2.0 : drives ? 1.0 : std::max(plan.camera_height_m / 4, 1.0);
  plan.step_m = o.step_m.value_or(std::max(usual_m, length_m / TraverseOptions::kUsualPoses));
  check("the step", plan.step_m, TraverseOptions::kMinStep_m, TraverseOptions::kMaxStep_m);
  plan.turns_m = walks ? 1.0 : drives ? o.vehicle.turning_radius_m : plan.step_m;
  return plan;
}

// Returns the distances of all poses from the start.
std::vector<double> samples_of(const Way& way, double step_m) {
  std::vector<double> samples{0};
  for (std::size_t leg = 0; leg < way.legs(); ++leg) {
    const double leg_m = way.end_m(leg) - way.begin_m(leg);
    const double steps = std::max(1.0, std::ceil(leg_m / step_m - 1e-9));
    if (static_cast<double>(samples.size()) + steps > static_cast<double>(TraverseOptions::kMostPoses))
      throw std::invalid_argument("a way of " + base::format_rounded(way.length_m(), 0) + " m in steps of " +
                                  base::format_number(step_m) + " m has more than " +
                                  std::to_string(TraverseOptions::kMostPoses) +
                                  " poses; give a larger step, or a part of the way");
    for (double n = 1; n < steps; ++n) samples.push_back(way.begin_m(leg) + leg_m * n / steps);
    samples.push_back(way.end_m(leg));
  }
  return samples;
}

double slope_deg(double rise_m, double run_m) { return std::atan2(rise_m, run_m) / mars::kRadiansPerDegree; }

}  // namespace

Traverse make_traverse(std::span<const mars::LonLat> places, const TraverseOptions& options,
                       const TerrainQuery& ground) {
  if (const std::string fault = problem(options.vehicle); !fault.empty()) throw std::invalid_argument(fault);
  const Way way(places, ground.radius_m);
  const Plan plan = plan_of(options, way.length_m());
  const std::vector<double> samples = samples_of(way, plan.step_m);
  const bool drives = options.by == TraverseBy::kDrive;
  const bool walks = options.by == TraverseBy::kWalk;
  VehicleOptions vehicle = options.vehicle;
  vehicle.mast_m = plan.camera_height_m;

  Traverse out;
  out.length_m = way.length_m();
  out.limit_deg = walks ? WalkLimits::kSteepest_deg : drives ? vehicle.steepest_deg : 0;
  const auto note_slope = [&out](double here_deg, double size_deg, mars::LonLat place) {
    if (out.limit_deg > 0 && here_deg > out.limit_deg) ++out.too_steep;
    if (size_deg <= out.steepest_deg) return;
    out.steepest_deg = size_deg;
    out.steepest_at = place;
  };
  double time_s = 0;
  double last_ground_m = 0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const glm::dvec3 direction = way.at(samples[n]);
    const mars::LonLat place = mars::lon_lat(direction);
    scripts::Waypoint w;
    w.lon_deg = place.lon_deg;
    w.lat_deg = place.lat_deg;
    w.above_terrain = true;
    w.yaw_deg = way.heading_deg(samples[n], plan.turns_m);
    double here_m = 0;
    if (drives) {
      const Contact c = contact(place, w.yaw_deg, vehicle, ground);
      here_m = c.ground_m;
      w.pitch_deg = c.pitch_deg;
      w.roll_deg = c.roll_deg;
      w.up_m = std::max(c.plane_m, c.ground_m) + vehicle.mast_m - c.ground_m;
      note_slope(c.slope_deg, c.slope_deg, place);
    } else {
      here_m = ground.height_m(direction);
      w.up_m = plan.camera_height_m;
    }
    if (walks) {
      const double ahead_m = ground.height_m(way.at(samples[n] + kLooksAhead_m));
      const double run_m = std::min(kLooksAhead_m, way.length_m() - samples[n]);
      if (run_m > 0)
        w.pitch_deg = std::clamp(slope_deg(ahead_m - here_m, run_m), -kMostGaze_deg, kMostGaze_deg);
      else if (n > 0)
        w.pitch_deg = out.flight.waypoints.back().pitch_deg;
    }
    if (n > 0) {
      const double run_m = samples[n] - samples[n - 1];
      const double rise_m = here_m - last_ground_m;
      double speed_m_s = plan.speed_m_s;
      if (walks) speed_m_s *= std::max(stride_m_s(rise_m / run_m), WalkLimits::kScramble_m_s) / stride_m_s(0);
      if (!drives) note_slope(slope_deg(rise_m, run_m), std::abs(slope_deg(rise_m, run_m)), place);
      time_s += run_m / speed_m_s;
    }
    if (time_s > scripts::FlightLimits::kMaxTime_s)
      throw std::invalid_argument("the traverse lasts longer than " +
                                  base::format_number(scripts::FlightLimits::kMaxTime_s) +
                                  " s, which no flight may; give a higher speed or a part of the way");
    w.time_s = time_s;
    last_ground_m = here_m;
    out.flight.waypoints.push_back(w);
  }
  out.duration_s = time_s;
  return out;
}

}  // namespace vpe::explore
