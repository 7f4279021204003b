// An image's rows from the top, for images that do not fit into memory. Private to panorama.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "mars/sources/source.h"
#include "panorama/image/xmp_file.h"

namespace panorama {

class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual std::int64_t width_px() const = 0;
  virtual std::int64_t height_px() const = 0;
  // The next row; called height_px() times at most. Throws vpe::base::FileError.
  virtual void read(std::span<vpe::base::Rgb> row) = 0;
};

// Memory of a row or two (PNG, JPEG), of a row of tiles (TIFF, at most max_bytes). Throws
// vpe::base::FileError: damaged, or a kind that cannot be read row by row (interlaced PNG, progressive JPEG),
// with what to do.
std::unique_ptr<RowSource> open_rows(const std::filesystem::path& path, ImageFileFormat format,
                                     std::size_t max_bytes);

std::unique_ptr<RowSource> open_png_rows(const std::filesystem::path& path);
std::unique_ptr<RowSource> open_jpeg_rows(const std::filesystem::path& path);

}  // namespace panorama
