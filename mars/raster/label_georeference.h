// Where a raster lies, as far as its own label says it better than GDAL does.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "mars/raster/pds_label.h"

namespace mars {

// Everything absent is left to GDAL.
struct LabelPlace {
  std::string crs;                              // anything SetFromUserInput takes
  std::optional<std::array<double, 6>> to_map;  // geotransform: outer corner of the first pixel and steps
  std::optional<DegreeGrid> grid;               // exact, in place of what the CRS gives within rounding
  double lon_turn_deg = 0;                      // added to the longitude of every meridian of the CRS
  // tan(planetocentric latitude) = centric_scale tan(latitude of the map), where the CRS is that of a sphere.
  std::optional<double> centric_scale;
};

}  // namespace mars
