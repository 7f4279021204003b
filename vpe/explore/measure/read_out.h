// What lies under the cursor: the ground that a ray meets, in the numbers of `vpe query`.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "paging/surface/query.h"

namespace vpe::explore {

struct ReadOut {
  paging::PlaceAnswer at;         // longitude in (-180, 180]
  double lon_east_deg = 0;        // the same longitude in [0, 360)
  std::string datum;              // of the elevation, paging::describe_datum()
  bool illustration = false;      // a made-up planet
  glm::dvec3 point_m{0, 0, 0};    // on the ground as it is drawn, body-fixed, from the planet's centre
  std::optional<double> range_m;  // from the camera to the ground as it is drawn; nothing without a camera
};

// Of the first ground along the unit `direction`, as it is drawn with an exaggeration (elevation, slope and
// aspect are those of the planet, never exaggerated); nothing for the sky. For a camera below the ground the
// place is its own, at range 0. The place is right within the error of paging::Surface::cast() along the ray.
// Throws paging::PlanetError. Any thread.
std::optional<ReadOut> read_out(const paging::Surface& surface, const glm::dvec3& camera_m,
                                const glm::dvec3& direction, double exaggeration = 1.0);

// Of a place, as on a map.
ReadOut read_out_at(const paging::Surface& surface, mars::LonLat place, double exaggeration = 1.0);

// As people read it: "Elevation" "-2103.4 m (areoid)". Rounded to what the numbers are good for; "no data"
// where no source has any.
struct ReadOutLine {
  std::string label;
  std::string text;

  bool operator==(const ReadOutLine&) const = default;
};
std::vector<ReadOutLine> read_out_lines(const ReadOut& read_out);

// "950 m", "12.3 km", "0.42 m": at least three digits that count.
std::string length_text(double length_m);

}  // namespace vpe::explore
