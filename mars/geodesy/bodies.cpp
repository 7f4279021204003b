#include "mars/geodesy/bodies.h"

#include <array>
#include <cctype>
#include <cmath>

#include "mars/geodesy/sphere.h"

namespace mars {
namespace {

// Mars comes first: it is the default where no body is named.
constexpr std::array kBodies{
    Body{"Mars", kMarsRadius_m}, Body{"Moon", 1'737'400},     Body{"Mercury", 2'439'400},
    Body{"Venus", 6'051'800},    Body{"Earth", 6'371'008.8},  Body{"Ceres", 470'000},
    Body{"Vesta", 255'000},      Body{"Io", 1'821'490},       Body{"Europa", 1'560'800},
    Body{"Ganymede", 2'631'200}, Body{"Callisto", 2'410'300}, Body{"Titan", 2'575'000},
    Body{"Enceladus", 252'100},  Body{"Pluto", 1'188'300},    Body{"Charon", 606'000},
    Body{"Phobos", 11'080},
};

bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::tolower(static_cast<unsigned char>(a[i])) != std::tolower(static_cast<unsigned char>(b[i])))
      return false;
  }
  return true;
}

}  // namespace

std::span<const Body> bodies() { return kBodies; }

const Body* find_body(std::string_view name) {
  for (const Body& body : kBodies) {
    if (same(body.name, name)) return &body;
  }
  return nullptr;
}

const Body* find_body(double equatorial_m) {
  const Body* nearest = nullptr;
  double best = 0.01;
  for (const Body& body : kBodies) {
    const double off = std::abs(equatorial_m / body.radius_m - 1);
    if (off > best) continue;
    best = off;
    nearest = &body;
  }
  return nearest;
}

}  // namespace mars
