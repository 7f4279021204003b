// The format in which a band of a raster stores heights.
#pragma once

#include <gdal.h>

#include <optional>
#include <string>

#include "mars/raster/gdal_labels.h"
#include "mars/raster/gdal_raster.h"

class GDALRasterBand;

namespace mars {

struct BandFormat {
  GDALDataType type = GDT_Unknown;
  std::optional<double> nodata_value;
  double scale = 1;   // metres per unit of the stored values
  double offset = 0;  // metres at stored value 0
  bool fits_float = false;
  NodataValues special_values;  // other stored values that mean nodata
  bool masked = false;          // a mask or alpha band marks pixels with data
};

// Reads the format of a band, whose unit may be another length than metres. `path` is for messages. Must be called inside
// a GdalScope. Throws SourceError for a colour image, and for a scale or an offset that is no usable number.
BandFormat band_format(GDALRasterBand& band, const std::string& path, const NodataValues& special_values,
                       bool is_signed_byte);

// Reads that of the first band of a raster.
BandFormat band_format(const GdalRaster& raster);

}  // namespace mars
