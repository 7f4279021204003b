// What a plot of a profile shows, before it is drawn: ticks, columns, the line of sight. Pure.
#pragma once

#include <string>
#include <vector>

#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/measure/profile.h"

namespace vpe::explore {

// Round values (1, 2 or 5 times a power of ten apart) within low..high, at most `most` of them (2 or more), and
// how many digits behind the point tell them apart. Nothing where low..high is empty or not finite.
struct Ticks {
  std::vector<double> values;
  int digits = 0;
};
Ticks ticks(double low, double high, int most);

// The ground over an equal share of the way. Between points it is straight, and the band (low, high) is as much
// wider as S is above and below on that step: the bands together reach the profile's lowest and highest ground.
struct PlotColumn {
  double low_m = 0;
  double high_m = 0;
  double begin_m = 0;  // the straight line, at the beginning of the column and at its end
  double end_m = 0;
  bool nodata = false;  // some of it has no data
};
std::vector<PlotColumn> plot_columns(const Profile& profile, int count);

// The ground at a distance, straight between points; within the profile.
double ground_at_distance_m(const Profile& profile, double distance_m);
// The point that is nearest to a distance.
const paging::ProfilePoint& nearest_point(const Profile& profile, double distance_m);

// The height above the sphere of a straight line between two points that are `arc_rad` apart as seen from the
// planet's centre, where a share `t` (0..1) of that angle is behind; arc_rad below pi.
double sight_height_m(double radius_m, double from_m, double to_m, double arc_rad, double t);

}  // namespace vpe::explore
