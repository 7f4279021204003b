// The map of an ISIS3 cube's label (group Mapping): its coordinate system as ISIS means it.
#pragma once

#include <optional>
#include <string>

#include "mars/raster/label_georeference.h"

namespace mars {

// Values of the group, angles in degrees, as counted by the label; radii in metres.
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

// ISIS (its projection classes) puts latitudes of either kind as they are into the equations of the sphere for
// SimpleCylindrical, Sinusoidal, Orthographic and Equirectangular (that one with the local radius at its
// centre), and planetographic latitudes, converted where need be, into those of the ellipsoid for
// PolarStereographic, Mercator, TransverseMercator, LambertConformal and LambertAzimuthalEqualArea.
// West-positive longitudes change sign. GDAL 3.6.2 leaves the sign (the planet is turned), the planetographic
// latitudes on spheres (20 km at 45 degrees on Mars), and takes a sphere for planetocentric latitudes on the
// ellipsoid. Nothing for other projections, or where a radius or a needed parallel is missing.
std::optional<LabelPlace> isis_map(const IsisMapping& mapping);

}  // namespace mars
