#include "mars/raster/elevation/plain_heights.h"

#include <gdal_priv.h>

#include <cmath>
#include <limits>

#include "mars/raster/elevation/band_format.h"
#include "mars/raster/gdal_file.h"
#include "mars/raster/gdal_labels.h"
#include "mars/remote/gdal_remote.h"

namespace mars {

PlainHeights read_plain_heights(const std::string& path) {
  const RasterFile file = find_raster(raster_name(path));
  const RemoteScope remote(file.path);
  const auto dataset = open_raster(file);
  const GdalScope scope;
  if (dataset->GetRasterCount() < 1)
    throw source_error(path, "holds no raster", scope.message(),
                       "name one of its subdatasets (gdalinfo lists them)");
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  const bool is_signed = stores_signed_bytes(band);
  const BandFormat format = band_format(band, path, nodata_values(*dataset, file.label), is_signed);
  PlainHeights plain{band.GetXSize(), band.GetYSize(), {}};
  if (plain.columns > kMostPlainSide_px || plain.rows > kMostPlainSide_px) {
    throw source_error(path,
                       "has " + std::to_string(plain.columns) + " x " + std::to_string(plain.rows) +
                           " pixels, more than " + std::to_string(kMostPlainSide_px) + " on a side",
                       "", "make it smaller (gdal_translate -outsize)");
  }
  plain.heights_m.reserve(static_cast<std::size_t>(plain.columns) * static_cast<std::size_t>(plain.rows));
  std::vector<double> line(static_cast<std::size_t>(plain.columns));
  std::vector<unsigned char> mask(line.size(), 255);
  for (int row = 0; row < plain.rows; ++row) {
    const auto read = [&](GDALRasterBand& from, void* values, GDALDataType type) {
      return from.RasterIO(GF_Read, 0, row, plain.columns, 1, values, plain.columns, 1, type, 0, 0, nullptr) ==
             CE_None;
    };
    if (!read(band, line.data(), GDT_Float64) ||
        (format.masked && !read(*band.GetMaskBand(), mask.data(), GDT_Byte))) {
      throw source_error(path, "cannot read row " + std::to_string(row), scope.message(),
                         "the file may be cut short or damaged: fetch it again");
    }
    for (std::size_t n = 0; n < line.size(); ++n) {
      const double stored = is_signed && line[n] > 127 ? line[n] - 256 : line[n];
      const bool is_missing = mask[n] == 0 || stored == format.nodata_value || !(std::abs(stored) < 1e30) ||
                              format.special_values.has(stored);
      plain.heights_m.push_back(is_missing ? std::numeric_limits<float>::quiet_NaN()
                                           : static_cast<float>(format.scale * stored + format.offset));
    }
  }
  return plain;
}

}  // namespace mars
