// What GDAL 3.6.2 leaves out of the labels of ISIS cubes, VICAR and PDS4 files, and of masks.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mars/raster/label_georeference.h"
#include "mars/raster/pds_label.h"

class GDALDataset;

namespace mars {

// Stored values that are no data, besides GDAL's one no-data value.
struct NodataValues {
  std::vector<double> values;
  double at_most = -std::numeric_limits<double>::infinity();  // this and below
  double at_least = std::numeric_limits<double>::infinity();  // this and above
  bool any() const { return !values.empty() || at_most > -1e300 || at_least < 1e300; }
  bool has(double stored) const;
};

// ISIS cubes: NULL, LRS, LIS, HIS and HRS of the type they are stored in (8 bits: 0 and 255); GDAL names NULL
// only. PDS labels: all that they call missing.
NodataValues nodata_values(GDALDataset& dataset, const std::optional<PdsLabel>& label);

// Corrections of the place that GDAL reads from a label:
//   - ISIS3: see isis_map().
//   - VICAR and ISIS2 with POSITIVE_LONGITUDE_DIRECTION = WEST: GDAL takes the central longitude for an east
//   one.
//   - ISIS2, VICAR and PDS4 with planetographic latitudes on a flattened body, where GDAL uses a sphere.
// Throws SourceError (with `path`) for planetographic latitudes on bodies with three axes.
LabelPlace place_of(const std::string& path, GDALDataset& dataset);

}  // namespace mars
