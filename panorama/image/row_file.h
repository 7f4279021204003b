// PNG and JPEG files written from the top, some rows at a time, of any size in little memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "vpe/base/file.h"
#include "vpe/base/parallel.h"
#include "vpe/base/rgb.h"

namespace panorama {

inline constexpr std::int64_t kMaxJpegSide_px = 65500;  // libjpeg's own limit

// Writes the rows of one image. For one thread.
class RowWriter {
 public:
  virtual ~RowWriter() = default;
  // Adds whole rows. Throws vpe::base::FileError, std::logic_error for rows that the image does not have.
  virtual void write(std::span<const vpe::base::Rgb> rows) = 0;
  // Ends the file. Throws vpe::base::FileError, std::logic_error when rows are missing.
  virtual void finish() = 0;
};

// Return writers of 8-bit sRGB into a file that is empty and stays open; the caller commits it. An XMP packet
// is written before the pixels unless it is empty. PNG rows are packed by all threads of the pool: the same
// rows in the same calls make the same bytes for any number of threads. Throw vpe::base::FileError.
std::unique_ptr<RowWriter> make_png_writer(vpe::base::OutputFile& file, std::int64_t width_px,
                                           std::int64_t height_px, const std::string& xmp,
                                           vpe::base::ThreadPool& pool);
std::unique_ptr<RowWriter> make_jpeg_writer(vpe::base::OutputFile& file, std::int64_t width_px,
                                            std::int64_t height_px, const std::string& xmp, int quality);

}  // namespace panorama
