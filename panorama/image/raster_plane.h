// Files of auxiliary layers, which are registered to a panorama's image: range, place, elevation of each pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace panorama {

// Reads a TIFF or BigTIFF, tiled or in rows, with one band or more of 32- or 64-bit floating point numbers that
// lie together. NaN stands for the sky and everything else without a value. Any thread may call any const
// member.
//
// at() opens the file, reads one tile or strip and closes it again, so that no file stays open and calls need
// no locks. That suits single queries, as below a cursor. PlaneReader reads many pixels.
class RasterPlane {
 public:
  // Reads the header. Throws vpe::base::FileError: damaged, another kind, or not of this size.
  RasterPlane(std::filesystem::path path, std::int64_t width_px, std::int64_t height_px);

  // Returns the values of all bands at a pixel of the image. Throws vpe::base::FileError.
  std::vector<double> at(std::int64_t column, std::int64_t row) const;

 private:
  std::filesystem::path path_;
};

// Reads many values of the first band of such a file, which it keeps open. For one thread.
class PlaneReader {
 public:
  // Reads the header. Keeps decoded tiles or strips of at most about `budget_bytes`, and at least the last one. Throws as
  // RasterPlane.
  PlaneReader(std::filesystem::path path, std::int64_t width_px, std::int64_t height_px,
              std::size_t budget_bytes);
  ~PlaneReader();
  PlaneReader(PlaneReader&&) noexcept;
  PlaneReader& operator=(PlaneReader&&) noexcept;

  // Returns the value at a pixel of the image. Throws vpe::base::FileError.
  double at(std::int64_t column, std::int64_t row);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace panorama
