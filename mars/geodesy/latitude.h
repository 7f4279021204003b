// Planetographic (on the Earth: geodetic) latitudes: angles between the equator and the normal of an ellipsoid of
// revolution. All other latitudes of the program are planetocentric: angles at the centre.
#pragma once

#include <optional>
#include <string_view>

namespace mars {

// Describes an ellipsoid of revolution.
struct Spheroid {
  double equatorial_m = 0;
  double polar_m = 0;
};

// Convert latitudes of points on the ellipsoid, in degrees, -90 to 90. They are inverse to each other within 1e-13
// degrees for flattenings up to a half.
double planetocentric_lat_deg(double planetographic_deg, const Spheroid& spheroid);
double planetographic_lat_deg(double planetocentric_deg, const Spheroid& spheroid);

// Returns the reference ellipsoid of the body of this name, in upper or lower case, with the radii of the IAU 2015
// (Archinal et al. 2018, tables 4 to 6). Returns nullopt for other bodies and for those of three axes.
std::optional<Spheroid> reference_spheroid(std::string_view body);

}  // namespace mars
