// Which direction each place of a panorama shows.
//
// Places are in pixels: x right, y down, (0, 0) the image's upper left corner, pixel centres at +0.5.
// Azimuth is clockwise from north, elevation up from the horizontal; the image's horizon is level. With
// column t = x + crop_left_px, counted from the start of a turn, and rise v = horizon_px - y:
//   kCylinder         azimuth = turn_azimuth + 360 deg t / turn_px,  tan(elevation) = v / focal_px
//   kEquirectangular  the same azimuth,                              elevation = v / focal_px (radians)
//   kFacets           N planes of w = turn_px / N columns; u = t - (k + 1/2) w on plane k:
//                     azimuth = turn_azimuth + 360 deg (k + 1/2) / N + atan(u / focal_px),
//                     tan(elevation) = v / hypot(u, focal_px)
// core::View has the same cylinder and equirectangular, and each facet is a perspective View.
//
// All functions are pure, may be called from any thread, and expect a map that check() accepts.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "panorama/image/image_limits.h"
#include "vpe/core/view.h"

namespace panorama {

enum class MapKind : std::uint8_t { kCylinder, kEquirectangular, kFacets };

// "cylinder", "equirectangular", "facets".
const char* to_string(MapKind kind);

struct PanoramaLimits {
  static constexpr int kMinFacets = 3;
  static constexpr int kMaxFacets = 64;
  static constexpr double kMaxTurn_px = 1e9;      // also of focal_px and |horizon_px|
  static constexpr double kMaxAzimuth_deg = 1e6;  // of |turn_azimuth_deg|
  static constexpr double kMaxTurns = 2;          // that an image may be wide
};

struct Direction {
  double azimuth_deg = 0;
  double elevation_deg = 0;
};

struct PanoramaMap {
  MapKind kind = MapKind::kCylinder;
  std::int64_t width_px = 0;  // of the image, which may be a part of a turn or more than one
  std::int64_t height_px = 0;
  double turn_px = 0;           // columns of 360 degrees; need not be whole except with facets
  double turn_azimuth_deg = 0;  // at t = 0; facet 0 looks 180 / N degrees to the right of it
  double crop_left_px = 0;      // t of the image's left edge, 0 to turn_px
  double horizon_px = 0;        // y of elevation 0, inside the image or not
  // kCylinder, kFacets: rows per unit of tangent; kEquirectangular: rows per radian.
  double focal_px = 0;
  int facets = 0;  // kFacets only

  // Azimuth in [0, 360). x and y may lie outside of the image; an elevation beyond +-90 is cut there.
  Direction to_direction(double x, double y) const;

  // Where the image shows a direction; nothing where it does not, or for numbers that are not finite.
  // Azimuths may be any number of turns away. Of several columns (images wider than a turn) the leftmost.
  // to_pixel(to_direction(p)) = p within kRoundTrip_px for images up to 100 000 px wide and elevations up to
  // 85 degrees; on a seam of 360 degrees it is the left of the two edges.
  std::optional<glm::dvec2> to_pixel(const Direction& direction) const;

  // The same on an image without edges, x in [-crop_left_px, turn_px - crop_left_px). Rows of the
  // cylinder are huge towards +-90 degrees.
  glm::dvec2 place(const Direction& direction) const;

  double azimuth_span_deg() const { return 360.0 * static_cast<double>(width_px) / turn_px; }
  // Whether the left edge follows the right one, within a pixel.
  bool is_full_turn() const;
  double facet_px() const { return turn_px / facets; }
};
inline constexpr double kRoundTrip_px = 1e-9;

// Empty when the map can be used, else what is wrong with it and what is allowed.
std::string check(const PanoramaMap& map);

// Maps whose left edge is the start of the turn, with square pixels on the horizon. `turn_px` columns to 360
// degrees; facets: `facet_px` to each.
PanoramaMap cylinder_map(std::int64_t width_px, std::int64_t height_px, double turn_px, double left_azimuth_deg,
                         double horizon_px);
PanoramaMap equirectangular_map(std::int64_t width_px, std::int64_t height_px, double turn_px,
                                double left_azimuth_deg, double horizon_px);
// The whole turn, facet 0 centred at start_yaw_deg.
PanoramaMap faceted_map(int facets, std::int64_t facet_px, std::int64_t height_px, double start_yaw_deg,
                        double horizon_px);

// The drawn part of a round view whose camera is level. Throws std::invalid_argument for a perspective view and
// for a camera that is pitched or rolled by more than 1e-9 degrees.
PanoramaMap map_of(const vpe::core::View& view);

// The largest distance in pixels between where a and b show the same directions, over a grid of 9 x 9 places
// that spans a's image; infinite when the images differ in size. Tells whether two descriptions agree.
double largest_difference_px(const PanoramaMap& a, const PanoramaMap& b);

}  // namespace panorama
