// Where two eyes are that turn with the azimuth: omnidirectional stereo.
//
// Both lie opposite each other on a circle about the panorama's place, each looking along its tangent, so that
// every column has eyes that stand across its direction. Source: Ishiguro, Yamamoto & Tsuji 1992; Google's
// description of ODS.
#pragma once

#include <glm/vec2.hpp>

namespace panorama {

enum class Eye { kLeft, kRight };

// Place of an eye for an azimuth (clockwise from north), metres (east, north) from the panorama's place;
// `base_m` is the distance between both. Looking north, the left eye is in the west.
glm::dvec2 eye_place_m(Eye eye, double azimuth_deg, double base_m);

// The base for an elevation: full up to 45 degrees above and below the horizon, falling to 0 at the zenith and
// nadir, where there is no right and left. Continuous, with a continuous slope.
double faded_base_m(double base_m, double elevation_deg);

}  // namespace panorama
