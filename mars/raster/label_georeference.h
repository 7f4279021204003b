// Georeference that a raster's label defines better than GDAL reads it.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "mars/raster/pds_label.h"

namespace mars {

// Holds what overrides GDAL's georeference; absent parts are taken from GDAL.
struct LabelGeoreference {
  std::string crs;                              // any text that SetFromUserInput accepts
  std::optional<std::array<double, 6>> to_map;  // geotransform: outer corner of the first pixel, and steps
  std::optional<DegreeGrid> grid;               // exact; replaces what the CRS gives within rounding
  double lon_shift_deg = 0;                     // added to the longitude of every meridian of the CRS
  // k in: tan(planetocentric latitude) = k tan(latitude of the map), if the CRS is that of a sphere.
  std::optional<double> centric_scale;
};

}  // namespace mars
