// A flat map of the planet: linear in longitude and latitude, with degrees as wide as high in the middle.
// Positions are in pixels, (0, 0) is the upper left corner, pixel centres are at +0.5. All functions are pure.
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

  // Returns the longitude of a pixel's width: degrees_per_px / cos(latitude of the middle), with the cosine
  // taken as at least 0.1.
  double lon_degrees_per_px() const;

  // Returns the place at a position, with longitude in (-180, 180], or nullopt beyond the poles.
  std::optional<mars::LonLat> place(glm::dvec2 xy) const;
  // Returns the position of a place, the nearest to the middle of those that are a full circle apart.
  glm::dvec2 position(mars::LonLat place) const;

  bool operator==(const MapView& other) const {
    return middle.lon_deg == other.middle.lon_deg && middle.lat_deg == other.middle.lat_deg &&
           degrees_per_px == other.degrees_per_px && width == other.width && height == other.height;
  }
};

struct MapLimits {
  static constexpr double kFinest_deg = 1e-7;  // a pixel
};

// Returns a map of the whole planet.
MapView whole_map(int width, int height);
// Move by pixels, zoom about a position (factor > 1: in), and resize. All keep the map within the planet and
// its limits.
MapView moved(const MapView& map, glm::dvec2 by_px);
MapView zoomed(const MapView& map, glm::dvec2 xy, double factor);
MapView resized(const MapView& map, int width, int height);

// Returns the outline of the ground in a view, corner by corner: the points where lines of sight along its edge
// meet the sphere through the ground below, or the sphere's horizon where they miss it. Empty for views that
// are not in perspective.
std::vector<mars::LonLat> footprint(const core::View& view, double ground_radius_m);

}  // namespace vpe::explore
