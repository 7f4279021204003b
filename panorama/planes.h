// Measurements registered to a panorama's image: what stands behind each pixel's centre.
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

// kRange       distance from the camera to S as it is drawn, metres, float32; within 1e-6 / sin(incidence),
// relative kLonLat      place: longitude east (-180, 180] and planetocentric latitude, degrees, two float64; as
// far off as
//              the range is, along the line of sight
// kElevation   of S there without exaggeration, metres in the planet file's vertical datum, float32
// kSlope       of its facet there, without exaggeration, degrees, float32
// kIncidence   angle between the line of sight and the facet as drawn, degrees, float32: 90 straight on, 0
// along
//              it; not that of the sun
// The sky, and ground without data in kElevation and kSlope, is NaN.
enum class Plane : std::uint8_t { kRange, kLonLat, kElevation, kSlope, kIncidence };

struct PlaneInfo {
  Plane plane = Plane::kRange;
  std::string_view name;  // "range", "lonlat", ...: on the command line and in file names
  std::string_view unit;
  std::string_view meaning;
  SampleFormat format;
};
std::span<const PlaneInfo> all_planes();
const PlaneInfo& info_of(Plane plane);

// "range,lonlat"; each once, in the order of the enumeration. Throws PlanError naming what is unknown.
std::vector<Plane> parse_planes(std::string_view text);

// Where a pixel's line of sight goes: unit, body-fixed. x, y in the image, inside the piece.
glm::dvec3 line_of_sight(const Piece& piece, std::int64_t x, std::int64_t y);

// One pixel of a plane: format.samples numbers, as the format has them, into `out`. Any thread. Throws
// paging::PlanetError.
void measure(Plane plane, const paging::Surface& surface, double exaggeration, const glm::dvec3& camera_m,
             const glm::dvec3& sight, float range_m, std::uint8_t* out);

}  // namespace panorama
