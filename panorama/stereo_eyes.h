// Places of two eyes that turn with the azimuth: omnidirectional stereo (ODS).
//
// Both eyes lie opposite each other on a circle about the panorama's viewpoint, and each looks along the
// circle's tangent. So the eyes of every column stand across its direction. Source: Ishiguro, Yamamoto & Tsuji
// 1992; Google's description of ODS.
#pragma once

#include <glm/vec2.hpp>

namespace panorama {

enum class Eye { kLeft, kRight };

// Returns the place of an eye for an azimuth (clockwise from north), in metres (east, north) from the
// viewpoint. `base_m` is the distance between the eyes. For an azimuth of 0 the left eye is in the west.
glm::dvec2 eye_place_m(Eye eye, double azimuth_deg, double base_m);

// Returns the base for an elevation: full up to 45 degrees above and below the horizon, falling to 0 at the
// zenith and nadir, where there is no right and left. Continuous, with a continuous slope.
double faded_base_m(double base_m, double elevation_deg);

}  // namespace panorama
