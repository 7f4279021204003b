// A raster file open for reading: handles, place, and what is known of it. Never writes.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "mars/raster/gdal_file.h"
#include "mars/raster/gdal_footprint.h"
#include "mars/raster/gdal_georeference.h"
#include "mars/raster/gdal_labels.h"
#include "mars/raster/gdal_scope.h"
#include "mars/raster/pds_label.h"
#include "mars/sources/source.h"

class GDALDataset;

namespace mars {

// Every const member may be called from any number of threads at once.
class GdalRaster {
 public:
  // Opens anything GDAL reads, and what find_raster() adds to that. Throws SourceError.
  explicit GdalRaster(const std::string& path);

  const std::string& path() const { return file_.path; }
  const Georeference& georeference() const { return *georeference_; }
  const PixelGrid& grid() const { return georeference_->grid(); }
  const Footprint& footprint() const { return *footprint_; }
  const std::optional<PdsLabel>& label() const { return file_.label; }
  const NodataValues& nodata() const { return nodata_; }

  // Name, size and time of all its files, resolution.
  SourceInfo info() const;

  // A handle of one's own, for as long as the lease lives.
  LeasePool<GDALDataset>::Lease lend() const { return handles_.lend(); }

  // Reads pixels of a band (1-based; overview < 0 = full resolution) as T, rows `stride` values apart, and of
  // a band's mask (255 = valid, 0 = not). Throw SourceError.
  template <class T>
  void read(int band, int overview, const PixelWindow& window, int stride, T* values) const;
  void read_mask(int band, int overview, const PixelWindow& window, int stride, unsigned char* values) const;

 private:
  RasterFile file_;
  mutable LeasePool<GDALDataset> handles_;
  NodataValues nodata_;
  std::optional<Georeference> georeference_;
  std::optional<Footprint> footprint_;
};

extern template void GdalRaster::read(int, int, const PixelWindow&, int, float*) const;
extern template void GdalRaster::read(int, int, const PixelWindow&, int, double*) const;
extern template void GdalRaster::read(int, int, const PixelWindow&, int, unsigned char*) const;

}  // namespace mars
