// Corrects what GDAL 3.6.2 misses in the labels of ISIS cubes, VICAR and PDS4 files.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mars/raster/label_georeference.h"
#include "mars/raster/pds_label.h"

class GDALDataset;
class GDALRasterBand;

namespace mars {

// Holds stored values that mean nodata, besides GDAL's one nodata value.
struct NodataValues {
  std::vector<double> values;
  double at_most = -std::numeric_limits<double>::infinity();  // this value and all below
  double at_least = std::numeric_limits<double>::infinity();  // this value and all above
  bool any() const { return !values.empty() || at_most > -1e300 || at_least < 1e300; }
  bool has(double stored) const;
};

// Returns the nodata values of a raster. ISIS cubes: NULL, LRS, LIS, HIS and HRS of the stored type (8 bits: 0
// and 255), of which GDAL reports NULL only. PDS labels: all values that they declare missing.
NodataValues nodata_values(GDALDataset& dataset, const std::optional<PdsLabel>& label);

// Returns true if the stored bytes of a band are signed (PIXELTYPE=SIGNEDBYTE): GDAL before 3.7 reads them as unsigned.
bool stores_signed_bytes(GDALRasterBand& band);

// Returns corrections of the georeference that GDAL reads from a label:
// - ISIS3: see isis_map().
// - VICAR and ISIS2 with POSITIVE_LONGITUDE_DIRECTION = WEST: GDAL takes the central longitude for an east one.
// - ISIS2, VICAR and PDS4 with planetographic latitudes on a flattened body: GDAL uses a sphere.
// Throws SourceError (with `path`) for planetographic latitudes on triaxial bodies.
LabelGeoreference label_georeference(const std::string& path, GDALDataset& dataset);

}  // namespace mars
