// Maps between the pixels of a panorama and directions.
//
// Places are in pixels: x right, y down, (0, 0) the image's upper left corner, pixel centres at +0.5.
// Azimuth is clockwise from north, elevation up from the horizontal; the image's horizon is level. With
// column t = x + crop_left_px, counted from the start of a full circle, and rise v = horizon_px - y:
//   kCylinder         azimuth = turn_azimuth + 360 deg t / turn_px,  tan(elevation) = v / focal_px
//   kEquirectangular  the same azimuth,                              elevation = v / focal_px (radians)
//   kFacets           N planes of w = turn_px / N columns; u = t - (k + 1/2) w on plane k:
//                     azimuth = turn_azimuth + 360 deg (k + 1/2) / N + atan(u / focal_px),
//                     tan(elevation) = v / hypot(u, focal_px)
// core::View has the same cylinder and equirectangular projection, and each facet is a perspective View.
//
// All functions are pure, may be called from any thread, and expect a map that check() accepts.
//
// Typical usage:
//   const PanoramaMap map = cylinder_map(6000, 2000, 6000, -180, 1200);
//   const Direction direction = map.to_direction(x, y);
//   if (const auto pixel = map.to_pixel(direction)) ...
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "panorama/image/image_limits.h"
#include "vpe/core/view.h"

namespace panorama {

enum class MapKind : std::uint8_t { kCylinder, kEquirectangular, kFacets };

// Returns "cylinder", "equirectangular" or "facets".
const char* to_string(MapKind kind);

struct PanoramaLimits {
  static constexpr int kMinFacets = 3;
  static constexpr int kMaxFacets = 64;
  static constexpr double kMaxTurn_px = 1e9;      // also of focal_px and |horizon_px|
  static constexpr double kMaxAzimuth_deg = 1e6;  // of |turn_azimuth_deg|
  static constexpr double kMaxTurns = 2;          // largest width of an image in full circles
};

struct Direction {
  double azimuth_deg = 0;
  double elevation_deg = 0;
};

// Describes the directions that an image shows.
struct PanoramaMap {
  MapKind kind = MapKind::kCylinder;
  std::int64_t width_px = 0;  // of the image, which may be a part of a full circle or more than one
  std::int64_t height_px = 0;
  double turn_px = 0;           // columns of 360 degrees; whole only with facets
  double turn_azimuth_deg = 0;  // at t = 0; the middle of facet 0 is 180 / N degrees to the right of it
  double crop_left_px = 0;      // t of the image's left edge, 0 to turn_px
  double horizon_px = 0;        // y of elevation 0, inside the image or not
  // kCylinder, kFacets: rows per unit of tangent; kEquirectangular: rows per radian.
  double focal_px = 0;
  int facets = 0;  // kFacets only

  // Returns the direction of a place, azimuth in [0, 360). x and y may lie outside the image; an elevation
  // beyond +-90 is clamped.
  Direction to_direction(double x, double y) const;

  // Returns the place where the image shows a direction; nullopt where it does not, or for numbers that are not
  // finite. Azimuths may be any number of full circles away. Of several columns (images wider than a full
  // circle) the leftmost is returned. to_pixel(to_direction(p)) = p within kRoundTrip_px for images up to 100
  // 000 px wide and elevations up to 85 degrees; on a seam of 360 degrees it is the left of the two edges.
  std::optional<glm::dvec2> to_pixel(const Direction& direction) const;

  // Returns the place on an image without edges, x in [-crop_left_px, turn_px - crop_left_px). Rows of the
  // cylinder grow without bound towards +-90 degrees.
  glm::dvec2 place(const Direction& direction) const;

  double azimuth_span_deg() const { return 360.0 * static_cast<double>(width_px) / turn_px; }
  // Returns whether the left edge follows the right one, within a pixel.
  bool is_full_turn() const;
  double facet_px() const { return turn_px / facets; }
};
inline constexpr double kRoundTrip_px = 1e-9;

// Returns an empty text when the map can be used, else what is wrong with it and what is allowed.
std::string check(const PanoramaMap& map);

// Return maps whose left edge is at t = 0, with square pixels on the horizon.
PanoramaMap cylinder_map(std::int64_t width_px, std::int64_t height_px, double turn_px, double left_azimuth_deg,
                         double horizon_px);
PanoramaMap equirectangular_map(std::int64_t width_px, std::int64_t height_px, double turn_px,
                                double left_azimuth_deg, double horizon_px);
// Returns a map of the full circle in facets of `facet_px` columns, facet 0 centred at start_yaw_deg.
PanoramaMap faceted_map(int facets, std::int64_t facet_px, std::int64_t height_px, double start_yaw_deg,
                        double horizon_px);

// Returns the map of the drawn part of a round view whose camera is level. Throws std::invalid_argument for a
// perspective view and for a camera that is pitched or rolled by more than 1e-9 degrees.
PanoramaMap map_of(const vpe::core::View& view);

// Returns the largest distance in pixels between the places where a and b show the same directions, over a grid
// of 9 x 9 places that spans a's image; infinity when the images differ in size. Use it to test whether two
// descriptions agree.
double largest_difference_px(const PanoramaMap& a, const PanoramaMap& b);

}  // namespace panorama
