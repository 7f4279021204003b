#include "mars/geodesy/sun_times.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace mars {

namespace {

double local_sol_date(UnixSeconds time_s, double lon_deg) {
  return mars_time(time_s).sol_date + normalize_lon_deg(lon_deg) / 360;
}

// Returns the time at which a whole sol of the place begins, near a time.
UnixSeconds time_of_midnight(double number, UnixSeconds near_s, double lon_deg) {
  UnixSeconds time_s = near_s;
  // The second round takes in a leap second between the two times.
  for (int round = 0; round < 2; ++round) time_s += (number - local_sol_date(time_s, lon_deg)) * kSol_s;
  return time_s;
}

void check(UnixSeconds begin_s, UnixSeconds end_s, const SunSearch& search) {
  constexpr double kMostSteps = 1e7;
  if (!std::isfinite(begin_s) || !std::isfinite(end_s) || !(end_s >= begin_s))
    throw std::invalid_argument("sun_periods: expected a finite end that is not before the beginning");
  if (!(search.step_s > 0) || !(search.tolerance_s > 0) || !std::isfinite(search.tolerance_s))
    throw std::invalid_argument("sun_periods: expected a positive step and a positive tolerance");
  if (!((end_s - begin_s) / search.step_s <= kMostSteps))
    throw std::invalid_argument("sun_periods: expected at most 10 million steps");
}

}  // namespace

Sol local_sol(UnixSeconds time_s, double lon_deg) {
  const double number = std::floor(local_sol_date(time_s, lon_deg));
  return {static_cast<std::int64_t>(number), time_of_midnight(number, time_s, lon_deg),
          time_of_midnight(number + 1, time_s, lon_deg)};
}

SunPosition sun_at(UnixSeconds time_s, LonLat place) {
  const MarsTime time = mars_time(time_s);
  return sun_position(place, direction({time.subsolar_lon_deg, time.subsolar_lat_deg}));
}

double sun_radius_deg(double distance_au) {
  constexpr double kRadius_km = 695700;
  constexpr double kAstronomicalUnit_km = 149597870.7;
  return std::asin(kRadius_km / (distance_au * kAstronomicalUnit_km)) / kRadiansPerDegree;
}

std::vector<SunPeriod> sun_periods(LonLat place, UnixSeconds begin_s, UnixSeconds end_s, const SunSeen& seen,
                                   const SunSearch& search) {
  check(begin_s, end_s, search);
  const auto is_seen = [&](UnixSeconds time_s) { return seen(sun_at(time_s, place)); };
  // Returns the times on both sides of a change: the one that is like `before_s` first.
  const auto change = [&](UnixSeconds before_s, UnixSeconds after_s, bool before) {
    while (after_s - before_s > search.tolerance_s) {
      const UnixSeconds middle_s = 0.5 * (before_s + after_s);
      if (!(middle_s > before_s && middle_s < after_s)) break;
      (is_seen(middle_s) == before ? before_s : after_s) = middle_s;
    }
    return std::pair(before_s, after_s);
  };
  std::vector<SunPeriod> out;
  bool before = is_seen(begin_s);
  if (before) out.push_back({begin_s, end_s, false, false});
  const auto steps = static_cast<std::int64_t>(std::ceil((end_s - begin_s) / search.step_s));
  UnixSeconds last_s = begin_s;
  for (std::int64_t n = 1; n <= steps; ++n) {
    const UnixSeconds time_s = std::min(end_s, begin_s + static_cast<double>(n) * search.step_s);
    const bool now = is_seen(time_s);
    if (now != before) {
      const auto [dark_or_last, first_or_dark] = change(last_s, time_s, before);
      if (now) {
        out.push_back({first_or_dark, end_s, true, false});
      } else {
        out.back().set_s = dark_or_last;
        out.back().sets = true;
      }
    }
    before = now;
    last_s = time_s;
  }
  return out;
}

double seen_s(const std::vector<SunPeriod>& periods) {
  double sum_s = 0;
  for (const SunPeriod& period : periods) sum_s += period.set_s - period.rise_s;
  return sum_s;
}

}  // namespace mars
