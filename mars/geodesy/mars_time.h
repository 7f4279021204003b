// The sun and the clock on Mars, after the algorithm of Mars24 (NASA GISS; M. Allison and M. McEwen 2000,
// Planet. Space Sci. 48, 215), whose published test cases come out in every printed digit. A time is a moment
// on Mars: light time is no part of it.
//
// Longitude is east here as everywhere in this program (Mars24 counts west), latitude planetocentric. Pure
// functions, for any thread.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "mars/geodesy/sphere.h"

namespace mars {

// Seconds from 1970-01-01T00:00 UTC, leap seconds not counted (POSIX).
using UnixSeconds = double;

// TT - UTC, seconds: 32.184 and the leap seconds so far. Before 1972 the 10 s of then, after the last one known
// (2017-01-01) as today.
double tt_minus_utc_s(UnixSeconds time_s);

struct MarsTime {
  double julian_date_tt = 0;
  double mean_anomaly_deg = 0;          // not reduced to a turn
  double fictitious_mean_sun_deg = 0;   // angle of the fictitious mean sun, not reduced
  double perturbers_deg = 0;            // of the planets on the true anomaly
  double equation_of_centre_deg = 0;    // true minus mean anomaly
  double solar_longitude_deg = 0;       // Ls, [0, 360)
  double equation_of_time_deg = 0;      // true solar time is this much (15 degrees an hour) ahead of mean
  double sol_date = 0;                  // MSD
  double coordinated_time_h = 0;        // MTC, mean solar time at longitude 0, [0, 24)
  double subsolar_lon_deg = 0;          // east, (-180, 180]
  double subsolar_lat_deg = 0;          // planetocentric: what a sphere is lit by
  double subsolar_graphic_lat_deg = 0;  // planetographic, as almanacs have it
  double distance_au = 0;               // from the sun
};

MarsTime mars_time(UnixSeconds time_s);

// Local mean and true solar time at a longitude, hours, [0, 24).
double local_mean_time_h(const MarsTime& time, double lon_deg);
double local_true_time_h(const MarsTime& time, double lon_deg);

// Latitude below the sun, planetocentric, for a solar longitude.
double subsolar_lat_deg(double solar_longitude_deg);

// A sun as people write it.
struct LocalSun {  // "local": azimuth and elevation given apart, at a place
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

// - local
// - a date from 1900 to 2199: YYYY-MM-DD, then T and HH:MM, HH:MM:SS or HH:MM:SS.sss, then Z or an offset as
//   +02:00 (neither: UTC). A date alone is its first instant. 23:59:60 is the second after 23:59:59.
// - LsDEGREES,HH:MM[:SS[.sss]]: solar longitude 0 to 360 and local true solar time 00:00 to 24:00.
// Upper and lower case alike. Nothing for any other text.
std::optional<SunSpec> parse_sun(std::string_view text);

// Empty when parse_sun() takes it, else what is wrong.
std::string sun_problem(std::string_view text);

// What parse_sun() takes, in words.
std::string sun_grammar();

// Unit direction to the sun, body-fixed; `at`: the place whose local time a season is given in. Nothing for
// "local".
std::optional<glm::dvec3> sun_direction(const SunSpec& sun, LonLat at);

// Where a sun in this direction stands at a place.
struct SunPlace {
  double azimuth_deg = 0;    // clockwise from north, [0, 360); 0 with the sun in the zenith or nadir
  double elevation_deg = 0;  // above the horizontal
};
SunPlace sun_place(LonLat at, const glm::dvec3& direction);

}  // namespace mars
