// Auxiliary layers of a panorama: measurements at the centre of each pixel of its image.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "paging/surface/surface.h"
#include "panorama/image/tile_codec.h"
#include "panorama/panorama_plan.h"

namespace panorama {

// Identifies an auxiliary layer. Layers describe the reference surface as it is drawn (with exaggeration) where
// nothing else is said. The sky is NaN in all of them; kElevation and kSlope are NaN at nodata, too.
enum class Plane : std::uint8_t {
  // Distance from the camera to the reference surface along the line of sight, in metres; float32. Error by
  // exact rays: at most 1e-6 / sin(incidence), relative.
  kRange,
  // Place of that point: longitude east (-180, 180] and planetocentric latitude, in degrees; two float64.
  // Error: that of the range, along the line of sight.
  kLonLat,
  // Elevation of the reference surface there without exaggeration, in metres in the planet file's vertical
  // datum; float32.
  kElevation,
  // Slope of its facet there without exaggeration, in degrees; float32.
  kSlope,
  // Angle between the line of sight and the facet as drawn, in degrees; float32. 90: the line of sight is
  // perpendicular to the facet, 0: parallel. It has nothing to do with the sun.
  kIncidence,
  // 1 where the elevation is synthetic, 0 where it is that of data; float32. NaN where the planet file does not tell, and
  // at nodata.
  kSynthetic,
};

// Describes a layer for the command line and for files.
struct PlaneInfo {
  Plane plane = Plane::kRange;
  std::string_view name;  // "range", "lonlat", ...: on the command line and in file names
  std::string_view unit;
  std::string_view meaning;
  SampleFormat format;
};
// Returns all layers, in the order of the enumeration.
std::span<const PlaneInfo> all_planes();
const PlaneInfo& info_of(Plane plane);

// Parses names separated by commas, as in "range,lonlat". Returns each layer once, in the order of the
// enumeration. Throws PlanError that names an unknown layer.
std::vector<Plane> parse_planes(std::string_view text);

// Returns the direction of a pixel's line of sight: unit, body-fixed. x and y are pixels of the image inside
// the piece.
glm::dvec3 line_of_sight(const Piece& piece, std::int64_t x, std::int64_t y);

// Computes one pixel of a layer: writes format.samples numbers of the layer's format to `out`. `camera_m` and
// `sight` are body-fixed; range_m is infinite for the sky. Any thread. Throws paging::PlanetError.
void measure(Plane plane, const paging::Surface& surface, double exaggeration, const glm::dvec3& camera_m,
             const glm::dvec3& sight, float range_m, std::uint8_t* out);

}  // namespace panorama
