// Rasters that are registered to a panorama's image: range, place, elevation of what each pixel shows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace panorama {

// A TIFF or BigTIFF, tiled or in rows, with one band or more of 32- or 64-bit floating point numbers that lie
// together. NaN stands for sky and everything else that has no value.
class RasterPlane {
 public:
  // Reads the header. Throws vpe::base::FileError: damaged, another kind, or not of this size.
  RasterPlane(std::filesystem::path path, std::int64_t width_px, std::int64_t height_px);

  // The bands' values at a pixel of the image. Reads one tile or strip. Throws vpe::base::FileError.
  std::vector<double> at(std::int64_t column, std::int64_t row) const;

 private:
  std::filesystem::path path_;
};

}  // namespace panorama
