// Metadata of TIFF files as GDAL and programs like it show them: names and units of bands, nodata, free items.
#pragma once

#include <tiffio.h>

#include <string>
#include <utility>
#include <vector>

namespace vpe::core {

struct TiffBand {
  std::string name;
  std::string unit;
};

// Holds values of GDAL's tags. Empty members are not written.
struct TiffMetadata {
  std::vector<TiffBand> bands;                             // in the order of the bands
  std::vector<std::pair<std::string, std::string>> items;  // key and value
  std::string nodata;                                      // "nan" or "inf"
  std::string software;
};

// Sets the tags of the page that is written. Returns false when the library refuses one.
bool set_metadata(TIFF* tiff, const TiffMetadata& metadata);

}  // namespace vpe::core
