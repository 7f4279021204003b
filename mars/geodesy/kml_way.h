// Ways in KML files: lines, tracks and tours of virtual globes.
//
// Read are, wherever they stand in the file: the coordinates of <LineString>, the <gx:coord> of <gx:Track>, and the
// <Camera> or <LookAt> of each <gx:FlyTo> of a <gx:Tour>. Prefixes of names do not matter. Everything else is skipped.
// (OGC KML 2.3, 12-007r2.)
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace mars {

// Holds how a tour looks from or at a point.
struct KmlView {
  double heading_deg = 0;  // clockwise from north
  double tilt_deg = 0;     // 0: straight down, 90: to the horizon; 0 to 180
  double roll_deg = 0;     // of a Camera, -180 to 180
  std::optional<double>
      range_m;  // of a LookAt: distance of the camera from the point; nullopt: a Camera is at it
  std::optional<double> duration_s = std::nullopt;  // of the flight to the view

  bool operator==(const KmlView&) const = default;
};

// Holds a point of a way.
struct KmlPoint {
  LonLat place;              // longitude in (-180, 180], latitude as it stands in the file
  double altitude_m = 0;     // 0 where the file has none, and of views that are clamped to the ground
  bool is_absolute = false;  // the altitude counts from the datum, not from the ground
  std::optional<KmlView> view = std::nullopt;  // of a tour
};

struct KmlWay {
  enum class Kind : std::uint8_t { kLineString, kTrack, kTour };
  Kind kind = Kind::kLineString;
  std::vector<KmlPoint> points;  // at least one
};

// Returns "LineString", "gx:Track" or "gx:Tour".
const char* to_string(KmlWay::Kind kind);

inline constexpr std::size_t kLargestKml_bytes = std::size_t{64} << 20;

// Returns the ways of a file in its order; there is at least one. `name` is the file's name in messages. Throws
// std::runtime_error, which names the file, the way, the point and what was expected, for text that is not XML, has no
// way or more than kLargestKml_bytes, and for coordinates, angles and distances that are no numbers or beyond their
// range: longitudes from -360 to 360, latitudes from -90 to 90, altitudes and ranges within 1e10 m. Pure but for GDAL's
// state of errors.
std::vector<KmlWay> parse_kml(std::string_view text, const std::string& name);

}  // namespace mars
