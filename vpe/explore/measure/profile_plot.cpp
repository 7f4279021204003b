#include "vpe/explore/measure/profile_plot.h"

#include <algorithm>
#include <cmath>

namespace vpe::explore {

namespace {

double share(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

// Returns the index of the first point at or after a distance, at least 1.
std::size_t step_at(const Profile& profile, double distance_m) {
  const auto found = std::lower_bound(
      profile.points.begin() + 1, profile.points.end() - 1, distance_m,
      [](const paging::ProfilePoint& point, double distance) { return point.distance_m < distance; });
  return static_cast<std::size_t>(found - profile.points.begin());
}

}  // namespace

double ground_at_distance_m(const Profile& profile, double distance_m) {
  const std::size_t n = step_at(profile, distance_m);
  const paging::ProfilePoint& a = profile.points[n - 1];
  const paging::ProfilePoint& b = profile.points[n];
  return std::lerp(a.height_m, b.height_m, share(distance_m - a.distance_m, b.distance_m - a.distance_m));
}

const paging::ProfilePoint& nearest_point(const Profile& profile, double distance_m) {
  const std::size_t n = step_at(profile, distance_m);
  const paging::ProfilePoint& a = profile.points[n - 1];
  const paging::ProfilePoint& b = profile.points[n];
  return distance_m - a.distance_m < b.distance_m - distance_m ? a : b;
}

std::vector<PlotColumn> plot_columns(const Profile& profile, int count) {
  std::vector<PlotColumn> columns(static_cast<std::size_t>(std::max(0, count)));
  const double width_m = profile.length_m / std::max(1, count);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    PlotColumn& column = columns[k];
    const double begin_m = static_cast<double>(k) * width_m;
    const double end_m = k + 1 == columns.size() ? profile.length_m : begin_m + width_m;
    column.begin_m = ground_at_distance_m(profile, begin_m);
    column.end_m = ground_at_distance_m(profile, end_m);
    column.low_m = std::min(column.begin_m, column.end_m);
    column.high_m = std::max(column.begin_m, column.end_m);
    const auto include = [&](double height_m, double below_m, double above_m) {
      column.low_m = std::min(column.low_m, height_m - below_m);
      column.high_m = std::max(column.high_m, height_m + above_m);
    };
    for (std::size_t n = step_at(profile, begin_m); n < profile.points.size(); ++n) {
      const paging::ProfilePoint& a = profile.points[n - 1];
      const paging::ProfilePoint& b = profile.points[n];
      if (a.distance_m > end_m) break;
      const double below_m = std::min(a.height_m, b.height_m) - b.lowest_m;
      const double above_m = b.highest_m - std::max(a.height_m, b.height_m);
      for (const double end : {std::max(a.distance_m, begin_m), std::min(b.distance_m, end_m)}) {
        const double t = share(end - a.distance_m, b.distance_m - a.distance_m);
        include(std::lerp(a.height_m, b.height_m, t), below_m, above_m);
      }
      column.nodata = column.nodata || a.nodata || b.nodata;
    }
  }
  return columns;
}

double sight_height_m(double radius_m, double from_m, double to_m, double arc_rad, double t) {
  const double a = radius_m + from_m;
  const double b = radius_m + to_m;
  const double whole = std::sin(arc_rad);
  if (!(whole > 0)) return std::lerp(from_m, to_m, t);
  return whole / (std::sin(arc_rad * (1 - t)) / a + std::sin(arc_rad * t) / b) - radius_m;
}

}  // namespace vpe::explore
