// Profiles across the ground, for a plot and as CSV: what `vpe profile` and the window share.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "paging/surface/profile.h"

namespace vpe::explore {

struct ProfileOptions {
  double step_m = 0;          // between points, at most; 0: profile_step_m()
  double most_points = 1000;  // about, when step_m is 0
};

// The way through the places in `most_points` steps, but never finer than the planet's finest posts. A step
// says what lies between its points (ProfilePoint::lowest_m, highest_m), so that a plot that draws these loses
// no peak.
double profile_step_m(const paging::PlanetMeta& meta, std::span<const mars::LonLat> places,
                      double most_points = ProfileOptions().most_points);

struct Profile {
  double step_m = 0;  // asked for; steps are equal and at most this long between two places
  std::vector<paging::ProfilePoint> points;
  double length_m = 0;         // along the great circles on the planet's sphere
  double ground_length_m = 0;  // along S over every facet: exact but for rounding, below 2e-8 m a facet
  double lowest_m = 0;         // of S on the whole way, above the sphere: exact but for rounding, as above
  double highest_m = 0;
  bool some_missing = false;  // some point has no data
};

// Throws std::invalid_argument as paging::profile(), and paging::PlanetError. Any thread.
Profile make_profile(const paging::Surface& surface, std::span<const mars::LonLat> places,
                     const ProfileOptions& options = {});

// One point a line, no value where no source has data.
std::string profile_csv_header();
std::string profile_csv_line(const paging::ProfilePoint& point);
std::string to_csv(const Profile& profile);

}  // namespace vpe::explore
