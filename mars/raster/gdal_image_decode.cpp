#include "mars/raster/gdal_image_decode.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>

#include "vpe/base/quantile.h"

namespace mars {
namespace {

constexpr int kStretchSide = 512;  // side in pixels of the sample that sets the stretch
constexpr double kStretchTail = 0.005;

ImageFormat read_format(const GdalRaster& raster) {
  const GdalScope scope;
  const auto dataset = raster.acquire();
  ImageFormat format;
  std::array<int, 3> rgb{};
  const int bands = dataset->GetRasterCount();
  for (int i = 1; i <= bands; ++i) {
    const GDALColorInterp colour = dataset->GetRasterBand(i)->GetColorInterpretation();
    if (colour >= GCI_RedBand && colour <= GCI_BlueBand)
      rgb[static_cast<std::size_t>(colour - GCI_RedBand)] = i;
    if (colour == GCI_AlphaBand) format.alpha_band = i;
  }
  GDALRasterBand* first = dataset->GetRasterBand(1);
  if (rgb[0] != 0 && rgb[1] != 0 && rgb[2] != 0) {
    format.colour_bands.assign(rgb.begin(), rgb.end());
  } else if (bands >= 3 && (format.alpha_band == 0 || format.alpha_band > 3)) {
    format.colour_bands = {1, 2, 3};
  } else {
    format.colour_bands = {1};
  }
  format.bytes = true;
  for (const int i : format.colour_bands) {
    format.bytes =
        format.bytes && dataset->GetRasterBand(i)->GetRasterDataType() == GDT_Byte && !raster.is_signed_byte(i);
  }
  format.masked = format.alpha_band == 0 && (first->GetMaskFlags() & GMF_ALL_VALID) == 0;
  const GDALColorTable* table = first->GetColorTable();
  if (format.colour_bands.size() == 1 && table != nullptr && format.bytes) {
    format.palette.resize(256);
    for (int i = 0; i < std::min(256, table->GetColorEntryCount()); ++i) {
      const GDALColorEntry& e = *table->GetColorEntry(i);
      const auto byte = [](short value) { return static_cast<std::uint8_t>(std::clamp<int>(value, 0, 255)); };
      format.palette[static_cast<std::size_t>(i)] = {{byte(e.c1), byte(e.c2), byte(e.c3)}, byte(e.c4)};
    }
  }
  for (int i = 0; i < first->GetOverviewCount(); ++i) {
    for (int level = 1; level < 30; ++level) {
      const PixelGrid grid = raster.grid().reduced(level);
      const bool all = std::all_of(format.colour_bands.begin(), format.colour_bands.end(), [&](int band) {
        GDALRasterBand* overview = dataset->GetRasterBand(band)->GetOverview(i);
        return overview != nullptr && overview->GetXSize() == grid.width && overview->GetYSize() == grid.height;
      });
      // Averages of palette indices are no colours, and masks need not have overviews.
      if (all && format.palette.empty() && !format.masked && format.alpha_band == 0)
        format.overviews.emplace(level, i);
    }
  }
  return format;
}

// Sets the stretch from percentiles of a coarse sample of the whole image, over all colour bands so that hues
// are kept.
void find_stretch(const GdalRaster& raster, ImageFormat& format) {
  const PixelGrid& grid = raster.grid();
  const int columns = std::min(grid.width, kStretchSide);
  const int rows = std::min(grid.height, kStretchSide);
  std::vector<double> values;
  std::vector<double> line(static_cast<std::size_t>(grid.width));
  std::vector<unsigned char> mask(static_cast<std::size_t>(grid.width), 255);
  for (const int band : format.colour_bands) {
    for (int r = 0; r < rows; ++r) {
      const int row = static_cast<int>((2L * r + 1) * grid.height / (2L * rows));
      raster.read(band, -1, {0, row, grid.width, 1}, grid.width, line.data());
      if (format.masked) raster.read_mask(band, -1, {0, row, grid.width, 1}, grid.width, mask.data());
      for (int c = 0; c < columns; ++c) {
        const auto column = static_cast<std::size_t>((2L * c + 1) * grid.width / (2L * columns));
        if (mask[column] != 0 && std::abs(line[column]) < 1e30 && !format.nodata.has(line[column]))
          values.push_back(line[column]);
      }
    }
  }
  if (values.empty()) return;
  format.low = vpe::base::quantile_round(values, kStretchTail);
  format.high = vpe::base::quantile_round(values, 1 - kStretchTail);
  if (format.high <= format.low) format.high = format.low + 1;
}

}  // namespace

ImageFormat image_format(const GdalRaster& raster) {
  ImageFormat format = read_format(raster);
  // Special pixels of 8 bits are black and white, which is right for saturated ones.
  if (!format.bytes) format.nodata = raster.nodata();
  // GDAL makes no mask of a negative nodata value of bytes.
  if (raster.is_signed_byte(format.colour_bands[0])) {
    const GdalScope scope;
    const auto dataset = raster.acquire();
    int has_nodata = 0;
    const double value = dataset->GetRasterBand(format.colour_bands[0])->GetNoDataValue(&has_nodata);
    if (has_nodata != 0) format.nodata.values.push_back(value > 127 ? value - 256 : value);
  }
  if (!format.bytes) find_stretch(raster, format);
  return format;
}

void decode(const GdalRaster& raster, const ImageFormat& format, int overview, const PixelWindow& window,
            int stride, Pixel* pixels) {
  const auto count = static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows);
  const auto at = [&](std::size_t i) -> Pixel& {
    const auto columns = static_cast<std::size_t>(window.columns);
    return pixels[i / columns * static_cast<std::size_t>(stride) + i % columns];
  };
  const bool all_valid = !format.masked && format.alpha_band == 0;
  for (std::size_t i = 0; i < count; ++i) at(i) = {{}, static_cast<std::uint8_t>(all_valid ? 255 : 0)};
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t k = 0; k < format.colour_bands.size(); ++k) {
    const int band = format.colour_bands[k];
    const bool grey = format.colour_bands.size() == 1;
    const auto set = [&](std::size_t i, std::uint8_t value) {
      if (grey) {
        at(i).colour = {value, value, value};
      } else {
        at(i).colour[k] = value;
      }
    };
    if (format.masked) {
      // A pixel has data if any band has: nodata values such as 0 are common in single bands of colours.
      raster.read_mask(band, overview, window, window.columns, bytes.data());
      for (std::size_t i = 0; i < count; ++i) {
        if (bytes[i] != 0) at(i).alpha = 255;
      }
    }
    if (format.bytes) {
      raster.read(band, overview, window, window.columns, bytes.data());
      for (std::size_t i = 0; i < count; ++i) set(i, bytes[i]);
    } else {
      std::vector<double> values(count);
      raster.read(band, overview, window, window.columns, values.data());
      for (std::size_t i = 0; i < count; ++i) {
        const double t = (values[i] - format.low) / (format.high - format.low);
        set(i, std::isnan(t) ? std::uint8_t{0}
                             : static_cast<std::uint8_t>(std::lround(255 * std::clamp(t, 0.0, 1.0))));
        if (!(std::abs(values[i]) < 1e30) || format.nodata.has(values[i])) at(i).alpha = 0;
      }
    }
  }
  if (format.alpha_band != 0) {
    raster.read(format.alpha_band, overview, window, window.columns, bytes.data());
    for (std::size_t i = 0; i < count; ++i) at(i).alpha = bytes[i];
  }
  if (!format.palette.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t visible = at(i).alpha;
      at(i) = format.palette[at(i).colour[0]];
      if (visible == 0) at(i).alpha = 0;
    }
  }
}

}  // namespace mars
