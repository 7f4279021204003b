// Converts the bands of an image to colours.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "mars/raster/gdal_grid.h"
#include "mars/raster/gdal_raster.h"

namespace mars {

struct Pixel {
  std::array<std::uint8_t, 3> colour{};
  std::uint8_t alpha = 0;  // share of the pixel that has data, 255 = all
};

// Describes which bands make the colour, and how.
struct ImageFormat {
  std::vector<int> colour_bands;  // one (grey or palette) or three
  int alpha_band = 0;             // 0 = none
  bool masked = false;            // a mask or nodata value marks pixels with data
  bool bytes = false;             // stored as 8 bits and shown unchanged
  double low = 0, high = 255;     // else values are stretched between these
  std::vector<Pixel> palette;
  NodataValues nodata;           // stored values that are nodata, for all but 8 bits
  std::map<int, int> overviews;  // level -> GDAL overview of exactly that size
};

// Reads the format. Values of more than 8 bits are stretched between the 0.5 and 99.5 percentiles of a coarse
// sample of the whole image. Throws SourceError.
ImageFormat image_format(const GdalRaster& raster);

// Reads pixels into rows that are `stride` apart. overview < 0 selects full resolution. Throws SourceError.
void decode(const GdalRaster& raster, const ImageFormat& format, int overview, const PixelWindow& window,
            int stride, Pixel* pixels);

}  // namespace mars
