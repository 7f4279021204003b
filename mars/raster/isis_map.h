// Derives the coordinate system of an ISIS3 cube from its label (group Mapping), as ISIS defines it.
#pragma once

#include <optional>
#include <string>

#include "mars/raster/label_georeference.h"

namespace mars {

// Holds the values of the group: angles in degrees as the label counts them, radii in metres.
struct IsisMapping {
  std::string projection;
  double equatorial_radius_m = 0;
  double polar_radius_m = 0;
  bool planetographic = false;
  bool west_positive = false;
  double centre_lon_deg = 0;
  double centre_lat_deg = 0;
  std::optional<double> first_parallel_deg;
  std::optional<double> second_parallel_deg;
  double scale_factor = 1;
};

// Returns the coordinate system, or nullopt for other projections and if a radius or a needed parallel is
// missing.
//
// ISIS (its projection classes) uses latitudes of either kind unchanged in the equations of the sphere for
// SimpleCylindrical, Sinusoidal, Orthographic and Equirectangular (the last with the local radius at its
// centre). It uses planetographic latitudes, converted if necessary, in the equations of the ellipsoid for
// PolarStereographic, Mercator, TransverseMercator, LambertConformal and LambertAzimuthalEqualArea.
// West-positive longitudes change sign.
//
// GDAL 3.6.2 ignores the sign (the planet is rotated) and planetographic latitudes on spheres (20 km at 45
// degrees on Mars), and takes a sphere for planetocentric latitudes on the ellipsoid.
std::optional<LabelGeoreference> isis_map(const IsisMapping& mapping);

}  // namespace mars
