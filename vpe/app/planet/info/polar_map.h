// The projection of the maps of a planet's poles: stereographic, conformal, to kPolarLat_deg.
//
// Typical usage:
//   if (const auto at = polar_place(Pole::kNorth, 0.1, -0.2)) print(at->place.lat_deg);
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "mars/geodesy/sphere.h"

namespace vpe::app {

enum class Pole : std::uint8_t { kNorth, kSouth };

// Limits an inset: it shows what is nearer to its pole than this latitude.
inline constexpr double kPolarLat_deg = 55;

// Describes a place of a map.
struct LitPlace {
  mars::LonLat place;
  double light_azimuth_deg =
      315;  // of the direction that is the upper left one on the map, clockwise from north
};

// Returns what an inset shows at (x, y): right and down from its middle, 1 at its edge. Longitude 0 is below the north pole and
// above the south pole, as seen from above each. Returns nullopt beyond the edge. Pure.
std::optional<LitPlace> polar_place(Pole pole, double x, double y);

// Returns where an inset shows a place; its inverse. Places beyond the edge have a distance of more than 1 from the middle; the
// other pole is at infinity. Pure.
glm::dvec2 polar_point(Pole pole, const mars::LonLat& place);

}  // namespace vpe::app
