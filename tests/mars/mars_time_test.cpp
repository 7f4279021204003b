// The sun and the clock against the vectors that GISS publishes, and against geometry.
#include "mars/geodesy/mars_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "mars/geodesy/sun.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using test_support::Random;

double west_deg(double lon_deg) { return lon_deg > 0 ? 360 - lon_deg : -lon_deg; }

struct Vector {
  double millis;
  double m, afms, pbs, num, ls, eot, msd, mtc, lon_west, lat_graphic, distance, zenith, azimuth;
};
// Half a unit of the last digit printed.
constexpr double kFive = 0.5001e-5;
constexpr double kSix = 0.5001e-6;

const Vector kVectors[] = {{947116800000.0, 21.74558, 272.74566, 0.00142, 4.44193, 277.18759, -5.18775,
                            44795.99976, 23.99425, 174.72600, -25.22824, 1.393584, 154.26176, 191.03905},
                           {1073137591000.0, 66.06858, 317.09457, 0.01614, 10.22959, 327.32416, -12.77553,
                            46215.54856, 13.16537, 4.70500, -13.42040, 1.477672, 14.20696, 198.97113}};

TEST(MarsTime, GissVectorsToThePrintedDigits) {
  for (const Vector& v : kVectors) {
    const MarsTime t = mars_time(v.millis / 1000);
    const auto reduced = [](double x) { return x - 360 * std::floor(x / 360); };
    EXPECT_NEAR(reduced(t.mean_anomaly_deg), v.m, kFive);
    EXPECT_NEAR(reduced(t.fictitious_mean_sun_deg), v.afms, kFive);
    EXPECT_NEAR(t.perturbers_deg, v.pbs, kFive);
    EXPECT_NEAR(t.equation_of_centre_deg, v.num, kFive);
    EXPECT_NEAR(t.solar_longitude_deg, v.ls, kFive);
    EXPECT_NEAR(t.equation_of_time_deg, v.eot, kFive);
    EXPECT_NEAR(t.sol_date, v.msd, kFive);
    EXPECT_NEAR(t.coordinated_time_h, v.mtc, kFive);
    EXPECT_NEAR(west_deg(t.subsolar_lon_deg), v.lon_west, kFive);
    EXPECT_NEAR(t.subsolar_graphic_lat_deg, v.lat_graphic, kFive);
    EXPECT_NEAR(t.distance_au, v.distance, kSix);
    // Their angles at longitude 0, latitude 0 take the planetographic latitude of the sun.
    const glm::dvec3 sun = direction({t.subsolar_lon_deg, t.subsolar_graphic_lat_deg});
    const SunPosition place = sun_position({0, 0}, sun);
    EXPECT_NEAR(90 - place.elevation_deg, v.zenith, kFive);
    EXPECT_NEAR(place.azimuth_deg, v.azimuth, kFive);
    // sun_direction() inverts sun_position().
    EXPECT_LT(glm::length(sun_direction(LonLat{0, 0}, place.azimuth_deg, place.elevation_deg) - sun), 1e-14);
  }
  EXPECT_NEAR(local_mean_time_h(mars_time(1073137591), -184.702), 0.85190, kFive);
  EXPECT_NEAR(mars_time(1073137591).subsolar_lat_deg, -13.2854, 0.5001e-4);
}

TEST(MarsTime, DirectionsComeBackAtAnyPlace) {
  Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const LonLat at = trial % 10 == 0 ? LonLat{random.uniform(-180, 180), trial % 20 == 0 ? 90.0 : -90.0}
                                      : lon_lat(random.direction());
    const glm::dvec3 sun = random.direction();
    const SunPosition place = sun_position(at, sun);
    EXPECT_GE(place.azimuth_deg, 0);
    EXPECT_LT(place.azimuth_deg, 360);
    EXPECT_LT(glm::length(sun_direction(at, place.azimuth_deg, place.elevation_deg) - sun), 1e-14);
  }
  EXPECT_EQ(sun_position({0, 0}, {1, 0, 0}).elevation_deg, 90);
  EXPECT_EQ(sun_position({0, 0}, {1, 0, 0}).azimuth_deg, 0);
}

TEST(MarsTime, LeapSeconds) {
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(-1e9), 42.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(63072000), 42.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(78796799), 42.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(78796800), 43.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(947116800), 64.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(1136073599), 64.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(1136073600), 65.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(1483228799), 68.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(1483228800), 69.184);
  EXPECT_DOUBLE_EQ(tt_minus_utc_s(4e9), 69.184);
}

TEST(MarsTime, TheSunIsInTheZenithBelowItAndOnTheHorizonAQuarterAway) {
  Random random(2);
  for (int trial = 0; trial < 500; ++trial) {
    const double when = random.uniform(-2e9, 7e9);
    const MarsTime t = mars_time(when);
    const glm::dvec3 sun = *sun_direction(SunDate{when}, {});
    const LonLat below{t.subsolar_lon_deg, t.subsolar_lat_deg};
    EXPECT_LT(angle_between_rad(direction(below), sun), 1e-9);
    EXPECT_NEAR(local_true_time_h(t, below.lon_deg), 12, 1e-9);
    EXPECT_LE(std::abs(below.lat_deg), 25.2);
    const LonLat edge = destination(below, random.uniform(0, 360), kPi / 2);
    EXPECT_NEAR(sun_position(edge, sun).elevation_deg, 0, 1e-9 / kRadiansPerDegree);
    // The same sun from its season and the hour of any place.
    const LonLat at = lon_lat(random.direction());
    const SunSeason season{t.solar_longitude_deg, local_true_time_h(t, at.lon_deg)};
    EXPECT_LT(angle_between_rad(*sun_direction(season, at), sun), 1e-9);
  }
}

TEST(MarsTime, SeasonsAndHours) {
  const LonLat at{-74, -13};
  // Northern summer, noon: the sun is north, 25.19 - -13 degrees from the zenith.
  const SunPosition noon = sun_position(at, *sun_direction(SunSeason{90, 12}, at));
  EXPECT_NEAR(noon.azimuth_deg, 0, 1e-9);
  EXPECT_NEAR(noon.elevation_deg, 90 - (25.19181 + 13), 1e-4);
  // The equinox, on the equator: 15 degrees an hour, rising in the east.
  for (int hour = 0; hour <= 24; ++hour) {
    const SunPosition sun =
        sun_position({10, 0}, *sun_direction(SunSeason{0, static_cast<double>(hour)}, {10, 0}));
    EXPECT_NEAR(sun.elevation_deg, 90 - std::abs(15.0 * hour - 180), 1e-9);
    if (hour % 12 != 0) {
      EXPECT_NEAR(sun.azimuth_deg, hour < 12 ? 90 : 270, 1e-9);
    }
  }
  EXPECT_NEAR(subsolar_lat_deg(270), -25.19181, 1e-4);
  EXPECT_NEAR(subsolar_lat_deg(180), 0, 1e-12);
  EXPECT_FALSE(sun_direction(LocalSun{}, at).has_value());
}

TEST(MarsTime, TheClockRepeatsEverySol) {
  const double sol_s = 88775.244;
  const MarsTime a = mars_time(1.6e9);
  const MarsTime b = mars_time(1.6e9 + sol_s);
  EXPECT_NEAR(b.sol_date - a.sol_date, 1, 1e-8);
  EXPECT_NEAR(b.coordinated_time_h, a.coordinated_time_h, 1e-6);
  EXPECT_GT(b.solar_longitude_deg, a.solar_longitude_deg);
}

TEST(SunText, ReadsDates) {
  const auto at = [](const char* text) {
    const auto sun = parse_sun(text);
    EXPECT_TRUE(sun && std::holds_alternative<SunDate>(*sun)) << text << " " << sun_problem(text);
    EXPECT_EQ(sun_problem(text), "");
    return sun && std::holds_alternative<SunDate>(*sun) ? std::get<SunDate>(*sun).time_s : NAN;
  };
  EXPECT_EQ(at("1970-01-01"), 0);
  EXPECT_EQ(at("2000-01-06T00:00Z"), 947116800);
  EXPECT_EQ(at("2004-01-03T13:46:31Z"), 1073137591);
  EXPECT_EQ(at("2004-01-03t13:46:31z"), 1073137591);
  EXPECT_EQ(at("2026-11-20T12:00"), at("2026-11-20T12:00:00Z"));
  EXPECT_EQ(at("2026-11-20T14:30+02:30"), at("2026-11-20T12:00Z"));
  EXPECT_EQ(at("2026-11-20T01:00-11:00"), at("2026-11-20T12:00Z"));
  EXPECT_NEAR(at("2026-11-20T12:00:00.25Z"), at("2026-11-20T12:00Z") + 0.25, 1e-6);
  EXPECT_EQ(at("2026-11-20T24:00"), at("2026-11-21"));
  EXPECT_EQ(at("2016-12-31T23:59:60Z"), at("2017-01-01"));
  EXPECT_EQ(at("2024-02-29"), 1709164800);
  EXPECT_EQ(at("1900-01-01"), -2208988800.0);
  EXPECT_EQ(at("2199-12-31"), 7258032000.0);
}

TEST(SunText, ReadsSeasonsAndLocal) {
  EXPECT_EQ(parse_sun("Ls90,15:00"), SunSpec(SunSeason{90, 15}));
  EXPECT_EQ(parse_sun("LS90,15:00"), SunSpec(SunSeason{90, 15}));
  EXPECT_EQ(parse_sun("ls251.5,06:30:36"), SunSpec(SunSeason{251.5, 6.51}));
  EXPECT_EQ(parse_sun("Ls0,00:00"), SunSpec(SunSeason{0, 0}));
  EXPECT_EQ(parse_sun("Ls360,24:00"), SunSpec(SunSeason{360, 24}));
  EXPECT_EQ(parse_sun("local"), SunSpec(LocalSun{}));
  EXPECT_EQ(parse_sun("Local"), SunSpec(LocalSun{}));
}

TEST(SunText, ExplainsErrors) {
  const auto expect = [](std::string text, const char* part) {
    EXPECT_FALSE(parse_sun(text).has_value()) << text;
    EXPECT_NE(sun_problem(text).find(part), std::string::npos) << text << ": " << sun_problem(text);
  };
  for (const char* text : {"", "noon", "localx", "26-11-20", "2026-11", "2026-1-2", "2026/11/20", "-026-11-20",
                           "+2026-11-20", " 2026-11-20", "20261120"}) {
    expect(text, "neither local nor a date nor Ls and a time");
  }
  expect(std::string(100000, 'l'), "neither");
  expect("1899-12-31", "1900 to 2199");
  expect("2200-01-01", "1900 to 2199");
  for (const char* text : {"2026-02-29", "2026-13-01", "2026-00-01", "2026-01-00", "2026-04-31"}) {
    expect(text, "no such day");
  }
  expect("2026-11-20 12:00", "expected T");
  expect("2026-11-20x", "expected T");
  for (const char* text :
       {"2026-11-20T", "2026-11-20T12", "2026-11-20T1:00", "2026-11-20T25:00", "2026-11-20T12:60",
        "2026-11-20T12:00:61", "2026-11-20T12:00:60", "2026-11-20T24:00:01", "2026-11-20T12:00:00."}) {
    expect(text, "expected a time from 00:00 to 24:00");
  }
  for (const char* text :
       {"2026-11-20T12:00X", "2026-11-20T12:00Zx", "2026-11-20T12:00+2", "2026-11-20T12:00+0200",
        "2026-11-20T12:00+15:00", "2026-11-20T12:00+02:60", "2026-11-20T12:00+02:00Z"}) {
    expect(text, "expected Z or an offset");
  }
  for (const char* text :
       {"Ls", "Ls,15:00", "Ls-1,15:00", "Ls361,15:00", "Lsnan,15:00", "Ls1e2,15:00", "Ls9.9.9,1:00"}) {
    expect(text, text == std::string("Ls1e2,15:00") ? "expected a comma" : "from 0 to 360 after Ls");
  }
  expect("Ls90", "expected a comma");
  expect("Ls90 15:00", "expected a comma");
  for (const char* text : {"Ls90,", "Ls90,15", "Ls90,24:01", "Ls90,15:00Z", "Ls90,15:00:60", "Ls90,-1:00"}) {
    expect(text, "expected a local true solar time");
  }
}

}  // namespace
}  // namespace mars
