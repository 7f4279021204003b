// Sols, and the rise and set of the sun, against closed forms.
#include "mars/geodesy/sun_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/support/support.h"

namespace mars {
namespace {

using test_support::Random;

constexpr UnixSeconds kDate_s = 1795780800;  // 2026-11-27T12:00Z
constexpr UnixSeconds kOppositionOf2003_s = 1073137591;

SunSeen above(double elevation_deg) {
  return [elevation_deg](const SunPosition& sun) { return sun.elevation_deg > elevation_deg; };
}

double rad(double angle_deg) { return angle_deg * kRadiansPerDegree; }

// Returns the hours between noon (LTST) and the crossing of an elevation, for the declination of a time.
double hours_from_noon(double elevation_deg, double lat_deg, UnixSeconds time_s) {
  const double declination_deg = mars_time(time_s).subsolar_lat_deg;
  const double cosine =
      (std::sin(rad(elevation_deg)) - std::sin(rad(declination_deg)) * std::sin(rad(lat_deg))) /
      (std::cos(rad(declination_deg)) * std::cos(rad(lat_deg)));
  return std::acos(cosine) / kRadiansPerDegree / 15;
}

constexpr double kSolSecondsPerHour = kSol_s / 24;

TEST(LocalSol, BeginsAtMeanMidnightAndHoldsTheTime) {
  Random random(20261127);
  for (int n = 0; n < 1000; ++n) {
    const UnixSeconds time_s = random.uniform(-2e9, 7e9);
    const double lon_deg = random.uniform(-180, 180);
    const Sol sol = local_sol(time_s, lon_deg);
    EXPECT_LE(sol.begin_s, time_s + 1e-4);
    EXPECT_GT(sol.end_s, time_s - 1e-4);
    EXPECT_NEAR(sol.end_s - sol.begin_s, kSol_s, 1.001);  // with a leap second
    const double hour = local_mean_time_h(mars_time(sol.begin_s), lon_deg);
    EXPECT_LT(std::min(hour, 24 - hour) * kSolSecondsPerHour, 1e-4);
    EXPECT_EQ(local_sol(0.5 * (sol.begin_s + sol.end_s), lon_deg).number, sol.number);
    EXPECT_EQ(local_sol(sol.end_s + 1, lon_deg).number, sol.number + 1);
  }
}

TEST(LocalSol, AtTheMeridianItIsTheSolDateOfGiss) {
  EXPECT_EQ(local_sol(kOppositionOf2003_s, 0).number, 46215);  // MSD 46215.54856
  EXPECT_NEAR(local_sol(kOppositionOf2003_s, 0).begin_s, kOppositionOf2003_s - 0.54856 * kSol_s,
              0.5001e-5 * kSol_s);
}

TEST(SunAt, TheSecondVectorOfGissAtLongitudeZero) {
  // GISS takes the planetographic declination: 0.135 degrees farther south.
  const SunPosition sun = sun_at(kOppositionOf2003_s, {0, 0});
  EXPECT_NEAR(90 - sun.elevation_deg, 14.20696, 0.14);
  EXPECT_NEAR(sun.azimuth_deg, 198.97113, 0.5);
  // At the subsolar point it is in the zenith.
  const MarsTime time = mars_time(kOppositionOf2003_s);
  EXPECT_NEAR(sun_at(kOppositionOf2003_s, {time.subsolar_lon_deg, time.subsolar_lat_deg}).elevation_deg, 90,
              1e-5);
}

TEST(SunRadius, IsThatOfTheNominalSun) {
  EXPECT_NEAR(sun_radius_deg(1), 959.63 / 3600, 2e-6 * 60);  // 959.63 arc seconds, Auwers
  EXPECT_NEAR(sun_radius_deg(2), sun_radius_deg(1) / 2, 1e-5);
}

TEST(SunPeriods, AWallOfKnownHeightInClosedForm) {
  for (const double lat_deg : {-50.0, -4.59, 0.0, 22.5, 60.0}) {
    for (const double east_deg : {0.0, 3.0, 12.0}) {
      const LonLat place{137.44, lat_deg};
      // A wall to the east, a lower one to the west.
      const double west_deg = 0.5 * east_deg;
      const SunSeen seen = [&](const SunPosition& sun) {
        return sun.elevation_deg > (sun.azimuth_deg < 180 ? east_deg : west_deg);
      };
      const Sol sol = local_sol(kDate_s, place.lon_deg);
      const auto periods = sun_periods(place, sol.begin_s, sol.end_s, seen);
      ASSERT_EQ(periods.size(), 1U);
      const SunPeriod p = periods[0];
      EXPECT_TRUE(p.rises && p.sets);
      const double rise_h = 12 - hours_from_noon(east_deg, lat_deg, p.rise_s);
      const double set_h = 12 + hours_from_noon(west_deg, lat_deg, p.set_s);
      EXPECT_NEAR(local_true_time_h(mars_time(p.rise_s), place.lon_deg) * 3600, rise_h * 3600, 0.02);
      EXPECT_NEAR(local_true_time_h(mars_time(p.set_s), place.lon_deg) * 3600, set_h * 3600, 0.02);
      EXPECT_TRUE(seen(sun_at(p.rise_s, place)));
      EXPECT_FALSE(seen(sun_at(p.rise_s - 0.01, place)));
      EXPECT_TRUE(seen(sun_at(p.set_s, place)));
      EXPECT_FALSE(seen(sun_at(p.set_s + 0.01, place)));
    }
  }
}

TEST(SunPeriods, PolarDayAndNight) {
  // Ls 90: the sun is 25.2 degrees north.
  UnixSeconds solstice_s = kDate_s;
  while (std::abs(mars_time(solstice_s).solar_longitude_deg - 90) > 0.5) solstice_s += 86400;
  const Sol sol = local_sol(solstice_s, 10);
  const auto north = sun_periods({10, 80}, sol.begin_s, sol.end_s, above(0));
  ASSERT_EQ(north.size(), 1U);
  EXPECT_FALSE(north[0].rises || north[0].sets);
  EXPECT_EQ(north[0].rise_s, sol.begin_s);
  EXPECT_EQ(north[0].set_s, sol.end_s);
  EXPECT_EQ(seen_s(north), sol.end_s - sol.begin_s);
  EXPECT_TRUE(sun_periods({10, -80}, sol.begin_s, sol.end_s, above(0)).empty());
  EXPECT_EQ(seen_s({}), 0);
  // At the poles themselves.
  EXPECT_EQ(sun_periods({10, 90}, sol.begin_s, sol.end_s, above(0)).size(), 1U);
  EXPECT_TRUE(sun_periods({10, -90}, sol.begin_s, sol.end_s, above(0)).empty());
}

TEST(SunPeriods, SeveralBehindMountains) {
  const LonLat place{20, 70};
  UnixSeconds solstice_s = kDate_s;
  while (std::abs(mars_time(solstice_s).solar_longitude_deg - 90) > 0.5) solstice_s += 86400;
  const Sol sol = local_sol(solstice_s, place.lon_deg);
  // Peaks of two degrees each thirty degrees hide the sun of the polar day.
  const SunSeen seen = [](const SunPosition& sun) { return std::fmod(sun.azimuth_deg + 15, 30) > 2; };
  const auto periods = sun_periods(place, sol.begin_s, sol.end_s, seen);
  EXPECT_GE(periods.size(), 12U);
  EXPECT_LE(periods.size(), 13U);
  for (std::size_t n = 1; n < periods.size(); ++n) EXPECT_GT(periods[n].rise_s, periods[n - 1].set_s);
}

TEST(SunPeriods, BetweenRiseAndSetTheSunIsAboveTheSkyline) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(kSeed);
  Random random(kSeed);
  for (int n = 0; n < 50; ++n) {
    const LonLat place{random.uniform(-180, 180), random.uniform(-89, 89)};
    const double height_deg = random.uniform(0, 8);
    const double phase_deg = random.uniform(0, 360);
    const SunSeen seen = [&](const SunPosition& sun) {
      return sun.elevation_deg > height_deg * std::sin(rad(3 * (sun.azimuth_deg + phase_deg)));
    };
    const Sol sol = local_sol(random.uniform(0, 4e9), place.lon_deg);
    const auto periods = sun_periods(place, sol.begin_s, sol.end_s, seen);
    for (int k = 0; k < 1000; ++k) {
      const UnixSeconds time_s = random.uniform(sol.begin_s, sol.end_s);
      const bool within = std::ranges::any_of(
          periods, [&](const SunPeriod& p) { return time_s >= p.rise_s && time_s <= p.set_s; });
      EXPECT_EQ(within, seen(sun_at(time_s, place))) << place.lon_deg << "," << place.lat_deg << " " << time_s;
    }
  }
}

TEST(SunPeriods, AnEmptySearchLooksOnce) {
  EXPECT_TRUE(sun_periods({0, 0}, kDate_s, kDate_s, above(91)).empty());
  EXPECT_EQ(seen_s(sun_periods({0, 0}, kDate_s, kDate_s, above(-91))), 0);
}

TEST(SunPeriods, BadInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto search = [&](double begin_s, double end_s, double step_s, double tolerance_s) {
    return sun_periods({0, 0}, begin_s, end_s, above(0), {step_s, tolerance_s});
  };
  EXPECT_THROW(search(nan, 1, 60, 1), std::invalid_argument);
  EXPECT_THROW(search(0, infinity, 60, 1), std::invalid_argument);
  EXPECT_THROW(search(1, 0, 60, 1), std::invalid_argument);
  for (const double bad : {0.0, -1.0, nan}) {
    EXPECT_THROW(search(0, 1, bad, 1), std::invalid_argument);
    EXPECT_THROW(search(0, 1, 60, bad), std::invalid_argument);
  }
  EXPECT_THROW(search(0, 1e9, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace mars
