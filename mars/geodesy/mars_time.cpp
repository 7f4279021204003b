#include "mars/geodesy/mars_time.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mars {

namespace {

constexpr double kSecondsPerDay = 86400;
constexpr double kUnixJulianDate = 2440587.5;
constexpr double kJ2000JulianDate = 2451545.0;
constexpr double kDaysPerSol = 1.0274912517;

// First instants (UTC) from which TAI - UTC is one second longer (IERS, Bulletin C). It is 10 s before the
// second of them.
constexpr std::array<UnixSeconds, 28> kLeaps{
    63072000,  78796800,  94694400,   126230400,  157766400,  189302400,  220924800,
    252460800, 283996800, 315532800,  362793600,  394329600,  425865600,  489024000,
    567993600, 631152000, 662688000,  709948800,  741484800,  773020800,  820454400,
    867715200, 915148800, 1136073600, 1230768000, 1341100800, 1435708800, 1483228800};

double sin_deg(double angle_deg) { return sin_cos_deg(angle_deg).sin; }
double cos_deg(double angle_deg) { return sin_cos_deg(angle_deg).cos; }

// Reduces a value to [0, period).
double reduced(double value, double period) {
  const double rest = value - period * std::floor(value / period);
  return rest < period ? rest : 0.0;
}

double perturbers_deg(double days) {
  struct Term {
    double amplitude_deg;
    double period_years;
    double phase_deg;
  };
  constexpr std::array<Term, 7> kTerms{{{0.0071, 2.2353, 49.409},
                                        {0.0057, 2.7543, 168.173},
                                        {0.0039, 1.1177, 191.837},
                                        {0.0037, 15.7866, 21.736},
                                        {0.0021, 2.1354, 15.704},
                                        {0.0020, 2.4694, 95.528},
                                        {0.0018, 32.8493, 49.095}}};
  double sum = 0;
  for (const Term& t : kTerms) {
    sum += t.amplitude_deg * cos_deg(0.985626 * days / t.period_years + t.phase_deg);
  }
  return sum;
}

double declination_sine(double solar_longitude_deg) { return 0.42565 * sin_deg(solar_longitude_deg); }

}  // namespace

double tt_minus_utc_s(UnixSeconds time_s) {
  const auto leaps = std::upper_bound(kLeaps.begin(), kLeaps.end(), time_s) - kLeaps.begin();
  return 32.184 + 9.0 + static_cast<double>(std::max<std::ptrdiff_t>(leaps, 1));
}

MarsTime mars_time(UnixSeconds time_s) {
  MarsTime out;
  out.julian_date_tt = kUnixJulianDate + (time_s + tt_minus_utc_s(time_s)) / kSecondsPerDay;
  // Not computed from the Julian date, whose rounding in a double is 40 microseconds.
  const double days =
      (time_s + tt_minus_utc_s(time_s) - (kJ2000JulianDate - kUnixJulianDate) * kSecondsPerDay) /
      kSecondsPerDay;
  const double m = 19.3871 + 0.52402073 * days;
  out.mean_anomaly_deg = m;
  out.fictitious_mean_sun_deg = 270.3871 + 0.524038496 * days;
  out.perturbers_deg = perturbers_deg(days);
  out.equation_of_centre_deg = (10.691 + 3e-7 * days) * sin_deg(m) + 0.623 * sin_deg(2 * m) +
                               0.050 * sin_deg(3 * m) + 0.005 * sin_deg(4 * m) + 0.0005 * sin_deg(5 * m) +
                               out.perturbers_deg;
  const double ls = reduced(out.fictitious_mean_sun_deg + out.equation_of_centre_deg, 360);
  out.solar_longitude_deg = ls;
  out.equation_of_time_deg =
      2.861 * sin_deg(2 * ls) - 0.071 * sin_deg(4 * ls) + 0.002 * sin_deg(6 * ls) - out.equation_of_centre_deg;
  out.sol_date = (days - 4.5) / kDaysPerSol + 44796.0 - 0.0009626;
  out.coordinated_time_h = reduced(24 * out.sol_date, 24);
  out.subsolar_lon_deg = normalize_lon_deg(180 - 15 * out.coordinated_time_h - out.equation_of_time_deg);
  out.subsolar_lat_deg = subsolar_lat_deg(ls);
  out.subsolar_graphic_lat_deg = out.subsolar_lat_deg + 0.25 * sin_deg(ls);
  out.distance_au = 1.52367934 * (1.00436 - 0.09309 * cos_deg(m) - 0.004336 * cos_deg(2 * m) -
                                  0.00031 * cos_deg(3 * m) - 0.00003 * cos_deg(4 * m));
  return out;
}

double local_mean_time_h(const MarsTime& time, double lon_deg) {
  return reduced(time.coordinated_time_h + lon_deg / 15, 24);
}

double local_true_time_h(const MarsTime& time, double lon_deg) {
  return reduced(time.coordinated_time_h + (lon_deg + time.equation_of_time_deg) / 15, 24);
}

double subsolar_lat_deg(double solar_longitude_deg) {
  return std::asin(declination_sine(solar_longitude_deg)) / kRadiansPerDegree;
}

std::optional<glm::dvec3> sun_direction(const SunSpec& sun, LonLat place) {
  if (const auto* date = std::get_if<SunDate>(&sun)) {
    const MarsTime time = mars_time(date->time_s);
    return direction({time.subsolar_lon_deg, time.subsolar_lat_deg});
  }
  if (const auto* season = std::get_if<SunSeason>(&sun)) {
    const double hour_angle_deg = 15 * (season->true_time_h - 12);
    return direction(
        {normalize_lon_deg(place.lon_deg - hour_angle_deg), subsolar_lat_deg(season->solar_longitude_deg)});
  }
  return std::nullopt;
}

}  // namespace mars
