// Blocks of auxiliary layers. Private to panorama.
#pragma once

#include <cstdint>
#include <filesystem>
#include <unordered_map>
#include <vector>

#include "panorama/image/tiff_file.h"

namespace panorama {

// Reads many pixels of a file that RasterPlane accepts, and keeps it open. It decodes every tile or strip that
// it needs, and keeps those it used last. For one thread.
class BandReader {
 public:
  // Throws vpe::base::FileError.
  explicit BandReader(const std::filesystem::path& path);

  std::size_t bands() const { return bands_; }

  // Writes the values of all bands of the pixels at columns x + step * n, n < count, of a row: bands() numbers
  // a pixel. The pixels must be inside. Throws vpe::base::FileError.
  void read_row(std::int64_t x, std::int64_t y, std::int64_t step, std::int64_t count, double* out);

 private:
  using Part = std::vector<std::uint8_t>;
  const Part& part(std::uint32_t number);

  TiffFile file_;
  std::size_t bands_ = 1;
  std::size_t value_bytes_ = 4;
  bool is_tiled_ = false;
  std::uint32_t part_width_px_ = 0;
  std::uint32_t part_height_px_ = 0;
  std::unordered_map<std::uint32_t, Part> parts_;
  std::size_t part_bytes_ = 0;  // of all that are kept
};

}  // namespace panorama
