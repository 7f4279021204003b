// The formula of a panorama: where it shows a direction, for what draws many directions at a time.
//
// Places are in pixels of the image that the numbers are stated for: x right, y down, (0, 0) its upper left corner. A direction
// has components east, north and up. As panorama/projection.h: with azimuth A, clockwise from north, and elevation e,
//   x = turn_px (A - turn_azimuth) / 360 degrees - crop_left_px, y = horizon_px - focal_px e            kEquirectangular
//   the same x,                                                  y = horizon_px - focal_px tan(e)       kCylinder
//   planes between turn_px / facets columns, each the perspective image of its middle with this focal length     kFacets
// All functions are pure; any thread may call them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace objects {

// Describes what a panorama shows.
struct PanoramaFormula {
  enum class Kind : std::uint8_t { kEquirectangular, kCylinder, kFacets };
  Kind kind = Kind::kEquirectangular;
  double width_px = 0;  // of the image; a smaller copy of it may be what is kept
  double height_px = 0;
  double turn_px = 0;  // columns of 360 degrees
  double turn_azimuth_deg = 0;
  double crop_left_px = 0;
  double horizon_px = 0;
  double focal_px = 0;
  int facets = 0;  // of kFacets, else 0

  // Returns x of an azimuth, counted on from that of the image's middle by less than half of a circle.
  double column_px(double azimuth_rad) const;
  // Returns the facet that shows an azimuth, 0 to facets - 1.
  int facet_at(double azimuth_rad) const;
  // Returns the azimuth of a facet's middle.
  double facet_azimuth_rad(int facet) const;
  // Returns the solid angle of a pixel in a direction (any length), steradians; beyond the image's edges as if it went on.
  double pixel_sr(const glm::dvec3& direction) const;
};

}  // namespace objects
