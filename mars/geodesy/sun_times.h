// Sols of a place, and the times at which the sun is seen there.
//
// The sun is infinitely far, and its light is straight: no refraction, no light time. Times are those of
// mars_time(). All functions are pure and may be called from any thread.
//
// Typical usage:
//   const Sol sol = local_sol(date.time_s, place.lon_deg);
//   const auto seen = [](const SunPosition& sun) { return sun.elevation_deg > ridge_deg(sun.azimuth_deg); };
//   for (const SunPeriod& period : sun_periods(place, sol.begin_s, sol.end_s, seen)) list(period.rise_s);
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mars/geodesy/mars_time.h"

namespace mars {

// Holds the length of a mean solar day of Mars.
inline constexpr double kSol_s = 86400 * 1.0274912517;

// Describes a day of a place: from local mean midnight (LMST 00:00) to the next.
struct Sol {
  std::int64_t number = 0;  // of midnights at the place since MSD 0; at longitude 0 the whole part of MSD
  UnixSeconds begin_s = 0;
  UnixSeconds end_s = 0;
};

// Returns the sol of a place at a time. The longitude is east-positive and taken to (-180, 180]. Error: 1e-5 s.
Sol local_sol(UnixSeconds time_s, double lon_deg);

// Returns where the centre of the sun stands in the sky of a place.
SunPosition sun_at(UnixSeconds time_s, LonLat place);

// Returns the angular radius of the sun at a distance in astronomical units (> 0), for the nominal solar radius of
// the IAU (2015, resolution B3).
double sun_radius_deg(double distance_au);

// Returns whether the sun is seen when it stands there: whether it is above the skyline. Called from one thread.
using SunSeen = std::function<bool(const SunPosition& sun)>;

// Describes a time during which the sun is seen without a break.
struct SunPeriod {
  UnixSeconds rise_s = 0;  // the first time at which it is seen
  UnixSeconds set_s = 0;   // the last one
  bool rises = true;       // false: it is seen at the beginning of the search already
  bool sets = true;        // false: it is seen at the end of the search still
};

// Options of sun_periods().
struct SunSearch {
  double step_s = 60;         // the sun moves by a quarter of a degree in it
  double tolerance_s = 0.01;  // of rise and set
};

// Returns the periods from `begin_s` to `end_s` in which the sun is seen, in the order of time: none in the polar
// night, one that neither rises nor sets in the polar day, several behind mountains. Looks once per step and
// bisects where two looks differ. So a period or a gap that is shorter than a step may be missed; others are exact
// to the tolerance. Throws std::invalid_argument for numbers that are not finite, an end before the beginning, a
// step or a tolerance that is not positive, and more than 10 million steps.
std::vector<SunPeriod> sun_periods(LonLat place, UnixSeconds begin_s, UnixSeconds end_s, const SunSeen& seen,
                                   const SunSearch& search = {});

// Returns the sum of the periods in seconds.
double seen_s(const std::vector<SunPeriod>& periods);

}  // namespace mars
