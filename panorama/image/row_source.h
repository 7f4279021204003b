// Readers of an image's rows from the top, for images that do not fit in memory. Private to panorama.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "panorama/image/xmp_file.h"
#include "vpe/base/rgb.h"

namespace panorama {

// Reads one image. For one thread.
class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual std::int64_t width_px() const = 0;
  virtual std::int64_t height_px() const = 0;
  // Reads the next row. May be called height_px() times at most. Throws vpe::base::FileError.
  virtual void read(std::span<vpe::base::Rgb> row) = 0;
};

// Opens an image. Takes memory for a row or two (PNG, JPEG) or for a row of tiles (TIFF, at most max_bytes).
// Throws vpe::base::FileError, with what to do: damaged, or a kind that cannot be read row by row (interlaced
// PNG, progressive JPEG).
std::unique_ptr<RowSource> open_rows(const std::filesystem::path& path, ImageFileFormat format,
                                     std::size_t max_bytes);

std::unique_ptr<RowSource> open_png_rows(const std::filesystem::path& path);
std::unique_ptr<RowSource> open_jpeg_rows(const std::filesystem::path& path);

}  // namespace panorama
