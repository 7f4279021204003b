// Elevation profiles for plots and CSV files, used by `vpe profile` and the window.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "paging/surface/profile.h"

namespace vpe::explore {

struct ProfileOptions {
  double step_m = 0;  // largest distance between points. Smaller: more points, slower; 0: profile_step_m().
  double most_points = 1000;  // approximate number of points if step_m is 0
};

// Returns the step that divides the path through the places into `most_points`, but not less than the planet's
// finest post spacing. No peak is lost with a large step: each point holds the extremes of its step
// (ProfilePoint::lowest_m, highest_m).
double profile_step_m(const paging::PlanetMeta& meta, std::span<const mars::LonLat> places,
                      double most_points = ProfileOptions().most_points);

struct Profile {
  double step_m = 0;  // as requested; steps are equal and at most this long between two places
  std::vector<paging::ProfilePoint> points;
  double length_m = 0;         // along the great circles on the planet's sphere
  double ground_length_m = 0;  // along the reference surface over every facet: rounding below 2e-8 m a facet
  double lowest_m = 0;  // of the reference surface on the whole path, above the sphere; rounding as above
  double highest_m = 0;
  bool has_nodata = false;  // at some point
};

// Computes a profile. Throws std::invalid_argument as paging::profile(), and paging::PlanetError. May be called
// from any thread.
Profile make_profile(const paging::Surface& surface, std::span<const mars::LonLat> places,
                     const ProfileOptions& options = {});

// Write a profile as CSV, one point a line. Values are empty for nodata.
std::string profile_csv_header();
std::string profile_csv_line(const paging::ProfilePoint& point);
std::string to_csv(const Profile& profile);

}  // namespace vpe::explore
