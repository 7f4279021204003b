// Which file, and which of GDAL's drivers or our own readers, a raster is opened by.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/raster/gdal_scope.h"
#include "mars/raster/label_georeference.h"
#include "mars/raster/pds_label.h"

class GDALDataset;

namespace mars {

struct RasterFile {
  std::string path;                 // the file given, or the label beside it
  std::string gdal_name;            // what GDAL opens: the path, or a virtual dataset over the raw image
  std::vector<std::string> files;   // all that it is made of, where GDAL does not know
  std::optional<PdsLabel> label;    // of PDS images
  std::optional<LabelPlace> place;  // by that label
};

// What GDAL opens is opened by GDAL. A PDS image that has its label beside it (.lbl) is opened by that. Images
// that GDAL cannot read, or reads wrongly (see gdal_misreads), are raw rasters described by their label. Throws
// SourceError.
RasterFile find_raster(const std::string& path);

// A new handle. Throws SourceError.
LeasePool<GDALDataset>::Pointer open_raster(const RasterFile& file);

}  // namespace mars
