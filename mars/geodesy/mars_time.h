// Computes the season, the local time and the direction of the sun on Mars for a date.
//
// The algorithm is that of Mars24 (NASA GISS; M. Allison and M. McEwen 2000, Planet. Space Sci. 48, 215). The
// results agree with its published test cases in every printed digit. A time is a moment on Mars: light time is
// not included.
//
// Longitudes are east-positive as everywhere in this program (Mars24 counts west), latitudes are
// planetocentric. All functions are pure and may be called from any thread.
//
// Typical usage:
//   const MarsTime time = mars_time(1795176000);  // 2026-11-20T12:00Z
//   const double hour = local_true_time_h(time, 137.4);
//   if (const auto sun = parse_sun("Ls90,15:00")) light(sun_direction(*sun, {137.4, -4.6}));
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "mars/geodesy/sphere.h"
#include "mars/geodesy/sun.h"

namespace mars {

// Seconds since 1970-01-01T00:00 UTC without leap seconds (POSIX).
using UnixSeconds = double;

// Returns TT - UTC in seconds: 32.184 plus TAI - UTC. Before 1972 TAI - UTC is 10 s, after the last known leap
// second (2017-01-01) it stays as it is then.
double tt_minus_utc_s(UnixSeconds time_s);

struct MarsTime {
  double julian_date_tt = 0;
  double mean_anomaly_deg = 0;          // not reduced to [0, 360)
  double fictitious_mean_sun_deg = 0;   // angle of the fictitious mean sun, not reduced
  double perturbers_deg = 0;            // perturbation of the true anomaly by the planets
  double equation_of_centre_deg = 0;    // true minus mean anomaly
  double solar_longitude_deg = 0;       // Ls, [0, 360)
  double equation_of_time_deg = 0;      // true minus mean solar time; 15 degrees are an hour
  double sol_date = 0;                  // MSD
  double coordinated_time_h = 0;        // MTC, mean solar time at longitude 0, [0, 24)
  double subsolar_lon_deg = 0;          // east, (-180, 180]
  double subsolar_lat_deg = 0;          // planetocentric; use it to light a sphere
  double subsolar_graphic_lat_deg = 0;  // planetographic, as in almanacs
  double distance_au = 0;               // from the sun
};

// Returns everything that depends on the date alone.
MarsTime mars_time(UnixSeconds time_s);

// Return local mean and local true solar time at a longitude, in hours, [0, 24).
double local_mean_time_h(const MarsTime& time, double lon_deg);
double local_true_time_h(const MarsTime& time, double lon_deg);

// Returns the planetocentric latitude of the subsolar point at a solar longitude.
double subsolar_lat_deg(double solar_longitude_deg);

// Describes a sun that is given as text, see parse_sun().
struct LocalSun {  // "local": azimuth and elevation are given separately, for a place
  bool operator==(const LocalSun&) const = default;
};
struct SunDate {  // "2026-11-20T12:00Z"
  UnixSeconds time_s = 0;
  bool operator==(const SunDate&) const = default;
};
struct SunSeason {  // "Ls90,15:00"
  double solar_longitude_deg = 0;
  double true_time_h = 12;  // local true solar time, at a place
  bool operator==(const SunSeason&) const = default;
};
using SunSpec = std::variant<LocalSun, SunDate, SunSeason>;

// Parses one of these texts, in upper or lower case, or returns nullopt:
// - local
// - A date from 1900 to 2199: YYYY-MM-DD, then T and HH:MM, HH:MM:SS or HH:MM:SS.sss, then Z or an offset such
//   as +02:00 (without either: UTC). A date without a time means its first instant. 23:59:60 is the second
//   after 23:59:59.
// - LsDEGREES,HH:MM[:SS[.sss]]: a solar longitude from 0 to 360 and a local true solar time from 00:00 to
//   24:00.
std::optional<SunSpec> parse_sun(std::string_view text);

// Returns a message that says what is wrong with the text, or "" if parse_sun() accepts it.
std::string sun_problem(std::string_view text);

// Returns a short description of the texts that parse_sun() accepts.
std::string sun_grammar();

// Returns the unit direction of the sun in the body-fixed frame. `place` is where the local time of a season
// holds. Returns nullopt for LocalSun.
std::optional<glm::dvec3> sun_direction(const SunSpec& sun, LonLat place);

}  // namespace mars
