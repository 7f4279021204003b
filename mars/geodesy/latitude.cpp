#include "mars/geodesy/latitude.h"

#include <array>
#include <cmath>
#include <utility>

#include "mars/geodesy/bodies.h"
#include "mars/geodesy/sphere.h"

namespace mars {

namespace {

constexpr std::array<std::pair<std::string_view, Spheroid>, 10> kSpheroids{
    {{"Mars", {3'396'190, 3'376'200}},
     {"Moon", {1'737'400, 1'737'400}},
     {"Mercury", {2'440'530, 2'438'260}},
     {"Venus", {6'051'800, 6'051'800}},
     {"Earth", {6'378'136.6, 6'356'751.9}},
     {"Ceres", {487'300, 446'000}},
     {"Ganymede", {2'631'200, 2'631'200}},
     {"Callisto", {2'410'300, 2'410'300}},
     {"Pluto", {1'188'300, 1'188'300}},
     {"Charon", {606'000, 606'000}}}};

// Returns the latitude whose tangent is `factor` times as large.
double with_scaled_tangent(double lat_deg, double factor) {
  const double lat_rad = lat_deg * kRadiansPerDegree;
  return std::abs(lat_deg) >= 90
             ? lat_deg
             : std::atan2(factor * std::sin(lat_rad), std::cos(lat_rad)) / kRadiansPerDegree;
}

double squared_ratio(const Spheroid& spheroid) {
  const double ratio = spheroid.polar_m / spheroid.equatorial_m;
  return ratio * ratio;
}

}  // namespace

double planetocentric_lat_deg(double planetographic_deg, const Spheroid& spheroid) {
  return with_scaled_tangent(planetographic_deg, squared_ratio(spheroid));
}

double planetographic_lat_deg(double planetocentric_deg, const Spheroid& spheroid) {
  return with_scaled_tangent(planetocentric_deg, 1 / squared_ratio(spheroid));
}

std::optional<Spheroid> reference_spheroid(std::string_view body) {
  const Body* found = find_body(body);
  if (found == nullptr) return std::nullopt;
  for (const auto& [name, spheroid] : kSpheroids) {
    if (name == found->name) return spheroid;
  }
  return std::nullopt;
}

}  // namespace mars
