#include "vpe/explore/traverse/stamped_way.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

constexpr double kSameStop_rad = 1e-12;  // as in make_traverse()

// Describes a place of the way with the first and the last point that stand there.
struct Stop {
  const WayPoint* arrives = nullptr;
  const WayPoint* leaves = nullptr;
  double way_m = 0;
};

std::vector<Stop> stops_of(std::span<const WayPoint> points, double radius_m) {
  std::vector<Stop> stops;
  for (const WayPoint& point : points) {
    if (stops.empty()) {
      stops.push_back({&point, &point, 0});
      continue;
    }
    Stop& last = stops.back();
    // The place that make_traverse() keeps is that of the first point.
    const double angle_rad =
        mars::angle_between_rad(mars::direction(last.arrives->place), mars::direction(point.place));
    if (angle_rad < kSameStop_rad)
      last.leaves = &point;
    else
      stops.push_back({&point, &point, last.way_m + angle_rad * radius_m});
  }
  return stops;
}

void check_times(std::span<const WayPoint> points) {
  const auto with = std::ranges::count_if(points, [](const WayPoint& p) { return p.time_s.has_value(); });
  if (with != 0 && with != static_cast<std::ptrdiff_t>(points.size()))
    throw std::invalid_argument(std::to_string(with) + " of " + std::to_string(points.size()) +
                                " points have a time; give --speed, or a file with all of them or none");
}

// Checks that no point is earlier than the one before it, and that no way takes no time.
void check_ascent(const std::vector<Stop>& stops, std::span<const WayPoint> points) {
  for (std::size_t n = 1; n < points.size(); ++n)
    if (*points[n].time_s < *points[n - 1].time_s)
      throw std::invalid_argument("the time of point " + std::to_string(n + 1) +
                                  " is before that of the point before it; give --speed, or sort the points");
  for (std::size_t n = 1; n < stops.size(); ++n)
    if (!(*stops[n].arrives->time_s > *stops[n - 1].leaves->time_s))
      throw std::invalid_argument("point " + std::to_string(stops[n].arrives - points.data() + 1) +
                                  " has the time of the point before it, at another place; give --speed");
}

using Angle = std::optional<double> WayPoint::*;

// Interpolates an angle that both ends have.
std::optional<double> between(const WayPoint& from, const WayPoint& to, Angle angle, double share, bool turns) {
  if (!(from.*angle) || !(to.*angle)) return std::nullopt;
  const double difference =
      turns ? std::remainder(*(to.*angle) - *(from.*angle), 360) : *(to.*angle) - *(from.*angle);
  const double value = *(from.*angle) + share * difference;
  return turns ? value - 360 * std::floor(value / 360) : value;
}

class Stamper {
 public:
  Stamper(const TraverseOptions& options, const StampOptions& stamps, const TerrainQuery& ground, double mast_m)
      : options_(options), stamps_(stamps), ground_(ground), vehicle_(options.vehicle) {
    vehicle_.mast_m = mast_m;
  }

  void set_attitude(scripts::Waypoint& pose, const WayPoint& from, const WayPoint& to, double share) const {
    const auto yaw = between(from, to, &WayPoint::yaw_deg, share, true);
    if (yaw) {
      pose.yaw_deg = *yaw;
      if (options_.by == TraverseBy::kDrive) {
        const Contact c = contact({pose.lon_deg, pose.lat_deg}, *yaw, vehicle_, ground_);
        pose.pitch_deg = c.pitch_deg;
        pose.roll_deg = c.roll_deg;
        pose.up_m = std::max(c.plane_m, c.ground_m) + vehicle_.mast_m - c.ground_m;
      }
    }
    pose.pitch_deg = between(from, to, &WayPoint::pitch_deg, share, false).value_or(pose.pitch_deg);
    pose.roll_deg = between(from, to, &WayPoint::roll_deg, share, true).value_or(pose.roll_deg);
    pose.roll_deg = std::remainder(pose.roll_deg, 360);
  }

  double flight_s(double time_s, double begin_s) const { return (time_s - begin_s) / stamps_.scale; }

 private:
  const TraverseOptions& options_;
  const StampOptions& stamps_;
  const TerrainQuery& ground_;
  VehicleOptions vehicle_;
};

}  // namespace

bool has_times(std::span<const WayPoint> points) {
  return !points.empty() &&
         std::ranges::all_of(points, [](const WayPoint& point) { return point.time_s.has_value(); });
}

Traverse make_stamped_traverse(std::span<const WayPoint> points, const TraverseOptions& options,
                               const StampOptions& stamps, const TerrainQuery& ground) {
  if (!(stamps.scale >= StampOptions::kLeastScale && stamps.scale <= StampOptions::kMostScale))
    throw std::invalid_argument("the scale of time must be from " +
                                base::format_number(StampOptions::kLeastScale) + " to " +
                                base::format_number(StampOptions::kMostScale));
  if (stamps.keeps_times) check_times(points);
  const bool is_timed = stamps.keeps_times && has_times(points);
  std::vector<mars::LonLat> places;
  for (const WayPoint& point : points) places.push_back(point.place);
  TraverseOptions own = options;
  // Times of the file replace those of the speed, which must not be refused for a long way.
  if (is_timed) own.speed_m_s = TraverseOptions::kMaxSpeed_m_s;
  Traverse traverse = make_traverse(places, own, ground);
  const std::vector<Stop> stops = stops_of(points, ground.radius_m);
  if (is_timed) check_ascent(stops, points);

  const Stamper stamper(options, stamps, ground, options.camera_height_m.value_or(options.vehicle.mast_m));
  const double begin_s = is_timed ? *points.front().time_s : 0;
  std::vector<scripts::Waypoint> poses;
  std::size_t leg = 0;  // from stops[leg] to the next one
  double way_m = 0;
  for (std::size_t n = 0; n < traverse.flight.waypoints.size(); ++n) {
    scripts::Waypoint pose = traverse.flight.waypoints[n];
    if (n > 0) {
      const scripts::Waypoint& before = traverse.flight.waypoints[n - 1];
      way_m +=
          mars::distance_rad({before.lon_deg, before.lat_deg}, {pose.lon_deg, pose.lat_deg}) * ground.radius_m;
    }
    // Each stop is a pose; sums of lengths round, so that the nearer one of both ends counts within a part of a step.
    while (leg + 2 < stops.size() && way_m > stops[leg + 1].way_m * (1 + 1e-9) + 1e-6) ++leg;
    const Stop& from = stops[leg];
    const Stop& to = stops[leg + 1];
    const double leg_m = to.way_m - from.way_m;
    double share = std::clamp((way_m - from.way_m) / leg_m, 0.0, 1.0);
    const double rounding = (1e-9 * way_m + 1e-6) / leg_m;
    if (n + 1 == traverse.flight.waypoints.size() || 1 - share <= rounding) share = 1;
    if (share <= rounding) share = 0;
    const Stop* stop = share == 1 ? &to : share == 0 ? &from : nullptr;
    if (is_timed) {
      const double leaves_s = *from.leaves->time_s;
      pose.time_s = stamper.flight_s(leaves_s + share * (*to.arrives->time_s - leaves_s), begin_s);
    }
    if (stop == nullptr) {
      stamper.set_attitude(pose, *from.leaves, *to.arrives, share);
    } else if (is_timed && *stop->leaves->time_s > *stop->arrives->time_s) {
      scripts::Waypoint arrived = pose;
      arrived.time_s = stamper.flight_s(*stop->arrives->time_s, begin_s);
      stamper.set_attitude(arrived, *stop->arrives, *stop->arrives, 0);
      poses.push_back(arrived);
      pose.time_s = stamper.flight_s(*stop->leaves->time_s, begin_s);
    }
    if (stop != nullptr) stamper.set_attitude(pose, *stop->leaves, *stop->leaves, 0);
    poses.push_back(pose);
  }
  if (poses.back().time_s > scripts::FlightLimits::kMaxTime_s)
    throw std::invalid_argument("the traverse lasts " + base::format_rounded(poses.back().time_s, 0) +
                                " s by the times of its points, and no flight may last longer than " +
                                base::format_number(scripts::FlightLimits::kMaxTime_s) +
                                " s; give --time-scale or --speed");
  traverse.flight.waypoints = std::move(poses);
  traverse.duration_s = traverse.flight.waypoints.back().time_s;
  return traverse;
}

}  // namespace vpe::explore
