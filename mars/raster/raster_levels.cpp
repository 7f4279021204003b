#include "mars/raster/raster_levels.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/gdal_file.h"
#include "mars/raster/gdal_labels.h"

namespace mars {

namespace {

void check_levels(const std::string& path, const RasterLevels& size, const RasterLevelsLimits& limits) {
  const std::string found = std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels in " +
                            std::to_string(size.levels) + (size.levels == 1 ? " band" : " bands");
  if (std::min({size.width, size.height, size.levels}) < 2)
    throw source_error(path, "cannot read the levels of a volume", "it has " + found,
                       "give a raster with a band for each level, and 2 or more of pixels and bands each way");
  const std::size_t count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) *
                            static_cast<std::size_t>(size.levels);
  if (std::max({size.width, size.height, size.levels}) > limits.side || count > limits.values)
    throw source_error(path, "cannot read the levels of a volume", "it has " + found,
                       "reduce it to at most " + std::to_string(limits.side) + " each way and " +
                           std::to_string(limits.values) + " in all, for example with gdal_translate -outsize");
}

}  // namespace

RasterLevels read_raster_levels(const std::string& path, const RasterLevelsLimits& limits) {
  const GdalScope scope;
  const RasterFile file = find_raster(path);
  const GdalPool<GDALDataset>::Pointer dataset = open_raster(file);
  RasterLevels out;
  out.width = dataset->GetRasterXSize();
  out.height = dataset->GetRasterYSize();
  out.levels = dataset->GetRasterCount();
  check_levels(path, out, limits);
  const NodataValues nodata = nodata_values(*dataset, file.label);
  const auto width = static_cast<std::size_t>(out.width);
  const auto height = static_cast<std::size_t>(out.height);
  out.values.resize(width * height * static_cast<std::size_t>(out.levels));
  std::vector<double> row(width);
  for (int level = 0; level < out.levels; ++level) {
    GDALRasterBand* const band = dataset->GetRasterBand(level + 1);
    const bool is_signed = stores_signed_bytes(*band);
    int has_own = 0;
    const double own = band->GetNoDataValue(&has_own);
    for (int y = 0; y < out.height; ++y) {
      if (band->RasterIO(GF_Read, 0, y, out.width, 1, row.data(), out.width, 1, GDT_Float64, 0, 0) != CE_None)
        throw source_error(path, "cannot read band " + std::to_string(level + 1), scope.message(),
                           "the file may be damaged; fetch or export it again");
      float* const to =
          out.values.data() +
          (static_cast<std::size_t>(level) * height + height - 1 - static_cast<std::size_t>(y)) * width;
      for (std::size_t x = 0; x < width; ++x) {
        const double stored = is_signed && row[x] > 127 ? row[x] - 256 : row[x];
        to[x] = std::isfinite(stored) && !(has_own != 0 && row[x] == own) && !nodata.has(stored)
                    ? static_cast<float>(stored)
                    : 0;
      }
    }
  }
  return out;
}

}  // namespace mars
