// Read-out of the place under the cursor: the ground that a ray meets, with the numbers of `vpe query`.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "paging/surface/query.h"

namespace vpe::explore {

struct ReadOut {
  paging::PlaceAnswer at;   // longitude in (-180, 180]
  double lon_east_deg = 0;  // the same longitude in [0, 360)
  std::string datum;        // of the elevation, paging::describe_datum()
  // short_source_name() of PlaceAnswer::source, or of all of the tile, joined by " or "; may be empty.
  std::string source;
  double source_spacing_m = 0;    // of the posts of PlaceAnswer::source; 0: not known
  bool illustration = false;      // the planet is synthetic
  glm::dvec3 point_m{0, 0, 0};    // on the ground as drawn, body-fixed, from the planet's centre
  std::optional<double> range_m;  // from the camera to the ground as drawn; nullopt without a camera
};

// Reads out the first ground along the unit `direction`, as drawn with an exaggeration. Elevation, slope and
// aspect are never exaggerated. Returns nullopt for the sky. For a camera below the ground the place is its
// own, at range 0. The place is correct within the error of paging::Surface::cast() along the ray. Throws
// paging::PlanetError. May be called from any thread.
std::optional<ReadOut> read_out(const paging::Surface& surface, const glm::dvec3& camera_m,
                                const glm::dvec3& direction, double exaggeration = 1.0);

// Reads out a place, for example on a map.
ReadOut read_out_at(const paging::Surface& surface, mars::LonLat place, double exaggeration = 1.0);

// Returns the name of a source without folders, which are those of the machine that built the planet.
std::string short_source_name(const std::string& source);

// Describes a line for display, such as "Elevation" and "-2103.4 m (areoid)".
struct ReadOutLine {
  std::string label;
  std::string text;

  bool operator==(const ReadOutLine&) const = default;
};

// Returns the read-out as text, rounded to significant digits; "no data" for nodata.
std::vector<ReadOutLine> read_out_lines(const ReadOut& read_out);

// Returns a measured length with at least three significant digits: "950 m", "12.35 km", "0.42 m".
std::string measured_length_text(double length_m);

// Returns longitude and latitude with five decimals of a degree: "137.44170, -4.58950".
std::string coordinates_text(mars::LonLat place);

}  // namespace vpe::explore
