// A raster file open for reading: handles, georeference and metadata. Never writes.
//
// Typical usage:
//   const GdalRaster raster("mola.img");
//   raster.georeference().to_pixels(directions, pixels);
//   raster.read(1, -1, {0, row, raster.grid().width, 1}, raster.grid().width, line.data());
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/gdal_file.h"
#include "mars/raster/gdal_footprint.h"
#include "mars/raster/gdal_georeference.h"
#include "mars/raster/gdal_labels.h"
#include "mars/raster/pds_label.h"
#include "mars/raster/placement/placement.h"
#include "mars/sources/source.h"

class GDALDataset;

namespace mars {

// Any number of threads may call const members at once.
class GdalRaster {
 public:
  // Opens anything that find_raster() finds. A raster without a map is placed by its control points or its RPC, see
  // placement/placement.h. Throws SourceError.
  explicit GdalRaster(const std::string& path, const PlacementOptions& placement = {});

  const std::string& path() const { return file_.path; }
  const Georeference& georeference() const { return *georeference_; }
  const PixelGrid& grid() const { return georeference_->grid(); }
  const Footprint& footprint() const { return *footprint_; }
  // Returns windows outside of which all pixels are nodata, see data_windows(). Sparse GeoTIFFs and mosaics (VRT)
  // tell which parts they have; all other rasters are one window.
  const std::vector<PixelWindow>& windows() const { return windows_; }
  const std::optional<PdsLabel>& label() const { return file_.label; }
  const NodataValues& nodata() const { return nodata_; }

  // Returns true if the stored bytes of a band, counted from 1, are signed (PIXELTYPE=SIGNEDBYTE): GDAL before
  // 3.7 reads them as unsigned.
  bool is_signed_byte(int band) const { return signed_bytes_[static_cast<std::size_t>(band - 1)]; }

  // Returns true if control points or an RPC place it: its pixels are interpolated, and its overviews not its own.
  bool is_placed() const { return placement_ != nullptr; }

  // Returns name, size and time of all its files, the resolution, and how it was placed.
  SourceInfo info() const;

  // Lends a handle that the caller does not share with other threads.
  GdalPool<GDALDataset>::Lease acquire() const { return handles_.acquire(); }

  // read() reads pixels of a band (counted from 1) as T into rows that are `stride` values apart. Signed bytes
  // are signed in float and double, and as stored in unsigned char. read_mask() reads the mask of a band (255 =
  // valid, 0 = nodata). overview < 0 selects full resolution. Throw SourceError.
  template <class T>
  void read(int band, int overview, const PixelWindow& window, int stride, T* values) const;
  void read_mask(int band, int overview, const PixelWindow& window, int stride, unsigned char* values) const;

 private:
  RasterFile file_;
  GdalPool<GDALDataset>::Pointer opened_;  // the first handle, until it is lent
  std::shared_ptr<const Placement> placement_;
  mutable GdalPool<GDALDataset> handles_;
  NodataValues nodata_;
  std::vector<bool> signed_bytes_;  // by band
  std::optional<Georeference> georeference_;
  std::vector<PixelWindow> windows_;
  std::optional<Footprint> footprint_;
};

extern template void GdalRaster::read(int, int, const PixelWindow&, int, float*) const;
extern template void GdalRaster::read(int, int, const PixelWindow&, int, double*) const;
extern template void GdalRaster::read(int, int, const PixelWindow&, int, unsigned char*) const;

}  // namespace mars
