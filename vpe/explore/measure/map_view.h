// A flat map of the planet: even in longitude and latitude, its degrees as wide as they are high in the middle.
// Positions are pixels, (0, 0) the upper left corner, pixel centres at +0.5. Pure.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/core/view.h"

namespace vpe::explore {

struct MapView {
  mars::LonLat middle;
  double degrees_per_px = 0.5;  // of latitude
  int width = 512;
  int height = 256;

  // Longitude of a pixel: cos(latitude of the middle) times fewer pixels, but not less than a tenth.
  double lon_degrees_per_px() const;

  // Latitude beyond +-90 is none; longitude is in (-180, 180].
  std::optional<mars::LonLat> place(glm::dvec2 xy) const;
  // The nearest of the positions that a place has.
  glm::dvec2 position(mars::LonLat place) const;

  bool operator==(const MapView& other) const {
    return middle.lon_deg == other.middle.lon_deg && middle.lat_deg == other.middle.lat_deg &&
           degrees_per_px == other.degrees_per_px && width == other.width && height == other.height;
  }
};

struct MapLimits {
  static constexpr double kFinest_deg = 1e-7;  // a pixel
};

// The whole planet in a map of a size.
MapView whole_map(int width, int height);
// Moved by pixels; zoomed about a position (factor > 1: nearer). Both keep the map within the planet and its
// limits.
MapView moved(const MapView& map, glm::dvec2 by_px);
MapView zoomed(const MapView& map, glm::dvec2 xy, double factor);
MapView resized(const MapView& map, int width, int height);

// Outline of the ground that a view sees, corner by corner: where lines of sight along its edge meet the ball
// through the ground below, and its horizon where they pass it. Empty for views that are not in perspective.
std::vector<mars::LonLat> footprint(const core::View& view, double ground_radius_m);

}  // namespace vpe::explore
