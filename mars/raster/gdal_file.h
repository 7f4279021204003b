// Selects the file and the reader by which a raster is opened: a driver of GDAL, or a virtual dataset of its
// label.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/label_georeference.h"
#include "mars/raster/pds_label.h"

class GDALDataset;

namespace mars {

struct RasterFile {
  std::string path;                // the given file, or the label beside it
  std::string gdal_name;           // what GDAL opens: the path, or a virtual dataset of a raw image
  std::vector<std::string> files;  // all files of the raster; empty: GDAL knows them
  std::optional<PdsLabel> label;   // of PDS images
  std::optional<LabelGeoreference> georeference;  // by that label
};

// Finds how to open a raster. Files that GDAL opens are opened by GDAL. A PDS image with a label beside it
// (.lbl) is opened by the label. Images that GDAL cannot read or misreads (see gdal_misreads()) are described
// as raw rasters by their label. Throws SourceError.
RasterFile find_raster(const std::string& path);

// Returns advice that names the files beside `path` that may be its label or header (PDS4, ISIS3, ENVI), or "".
// Must be called inside a GdalScope.
std::string sibling_advice(const std::string& path);

// Opens a new handle. Throws SourceError.
GdalPool<GDALDataset>::Pointer open_raster(const RasterFile& file);

}  // namespace mars
