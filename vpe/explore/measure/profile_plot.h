// Content of the plot of a profile, independent of drawing: columns and the line of sight. All functions are
// pure.
#pragma once

#include <string>
#include <vector>

#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/measure/profile.h"

namespace vpe::explore {

// Holds the ground over an equal share of the path. The ground is linear between points; the band (low, high)
// is wider by what the reference surface rises above and falls below that line in the step, so that all bands
// together reach the profile's lowest and highest ground.
struct PlotColumn {
  double low_m = 0;
  double high_m = 0;
  double begin_m = 0;  // the linear ground at the beginning and at the end of the column
  double end_m = 0;
  bool nodata = false;  // in some of it
};
std::vector<PlotColumn> plot_columns(const Profile& profile, int count);

// Returns the ground at a distance within the profile, linear between points.
double ground_at_distance_m(const Profile& profile, double distance_m);
// Returns the point that is nearest to a distance.
const paging::ProfilePoint& nearest_point(const Profile& profile, double distance_m);

// Returns the height above the sphere of a straight line between two points that are `arc_rad` (below pi) apart
// as seen from the planet's centre, at a share `t` (0..1) of that angle.
double sight_height_m(double radius_m, double from_m, double to_m, double arc_rad, double t);

}  // namespace vpe::explore
