// A small planet with a canyon, a crater, a deep basin and hills, for tests of culling.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "tests/paging/planet_fixture.h"

namespace test_support {

inline const glm::dvec3 kCanyon = mars::direction({-70.0, -11.0});
inline const glm::dvec3 kCrater = mars::direction({137.4, -5.4});
inline const glm::dvec3 kBasin = mars::direction({70.0, -42.0});
inline const glm::dvec3 kPole{0, 0, 1};

inline double rough_height(const glm::dvec3& d) {
  constexpr double kRadius_m = mars::kMarsRadius_m;
  const auto step = [](double x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x); };
  double h = 0.3 * bumpy_height(d);
  const auto east = [](const glm::dvec3& at) { return glm::normalize(glm::cross(glm::dvec3(0, 0, 1), at)); };
  {
    // Runs east, 20 km wide at the rim, 5 km deep, with bends and side valleys.
    const glm::dvec3 e = east(kCanyon);
    const double x = glm::dot(d - kCanyon, e) * kRadius_m;
    const double y = glm::dot(d - kCanyon, glm::cross(kCanyon, e)) * kRadius_m;
    if (glm::dot(d, kCanyon) > 0.99) {
      const double bend = 4000.0 * std::sin(x / 9000.0);
      const double spurs = 2500.0 * std::sin(x / 1700.0) * std::sin(x / 5300.0 + 1.0);
      h -= 5000.0 * (1.0 - step((std::abs(y - bend) - 2500.0 - spurs) / 7000.0)) *
           (1.0 - step((std::abs(x) - 150000.0) / 30000.0));
    }
  }
  {
    const double r = glm::length(d - kCrater) * kRadius_m / 15000.0;
    h += r < 1.0 ? -2500.0 + 3200.0 * std::pow(r, 4) : 700.0 * std::exp(-4.0 * (r - 1.0));
  }
  h -= 7000.0 * (1.0 - step((glm::length(d - kBasin) * kRadius_m - 300000.0) / 300000.0));
  h += 120.0 * std::sin(d.x * kRadius_m / 900.0) * std::sin(d.y * kRadius_m / 1100.0 + 0.4) *
       std::cos(d.z * kRadius_m / 1000.0);
  return h;
}

// Builds it with posts of some 320 m within 40 km of the canyon, the crater, the basin and the north pole.
inline std::shared_ptr<const paging::PlanetFile> build_rough(const std::filesystem::path& path) {
  const FakeElevation source(rough_height, [](const mars::Cap& cap) {
    for (const glm::dvec3& at : {kCanyon, kCrater, kBasin, kPole}) {
      if (glm::length(cap.centre - at) < cap.radius_rad + 0.012) return 350.0;
    }
    return 1e9;
  });
  return build_fake(path, source, 60000);
}

}  // namespace test_support
