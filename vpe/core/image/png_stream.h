// PNG files written row by row: the one writer of PNG in the program.
//
// Typical usage:
//   PngStream stream(width_px, height_px, {.xmp = packet, .pool = &pool},
//                    [&](std::span<const std::uint8_t> bytes) { file.write(bytes); });
//   for (...) stream.write(rows);
//   stream.finish();
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vpe/base/parallel.h"

namespace vpe::core {

enum class PngPacking : std::uint8_t {
  // Blocks of rows of about 1 MB that zlib packs one by one, in parallel. Memory: the rows of one write().
  kBlocks,
  // All rows in one piece by libdeflate, in half the time of zlib. Memory: all rows once more, and packed.
  // Where the program was built without libdeflate, or for images over 256 MB, this is kBlocks: the pixels are
  // equal, the files are not.
  kWhole,
};

struct PngStreamOptions {
  int channels = 3;  // 3 = RGB, 4 = RGBA; 8 bits each, sRGB
  // 1 to 9. Larger: smaller files, slower (see ImageOptions::png_compression).
  int compression = 1;
  PngPacking packing = PngPacking::kBlocks;
  std::string xmp = {};              // a packet that is written before the pixels; may be empty
  base::ThreadPool* pool = nullptr;  // packs blocks; null: the calling thread does
};

// Filters each row once, against its left neighbours or the row above, whichever differs less, and packs rows
// to a PNG. The same rows in the same calls make the same bytes, for any number of threads. For one thread.
class PngStream {
 public:
  // Receives the file's bytes in order. What it throws leaves write() and finish().
  using Sink = std::function<void(std::span<const std::uint8_t>)>;

  // Writes everything that precedes the pixels. Sides are at least 1.
  PngStream(std::int64_t width_px, std::int64_t height_px, PngStreamOptions options, Sink sink);
  PngStream(const PngStream&) = delete;
  PngStream& operator=(const PngStream&) = delete;

  // Adds whole rows. Throws std::logic_error for a part of a row and for more rows than the image has.
  void write(std::span<const std::uint8_t> rows);

  // Ends the file. Throws std::logic_error when rows are missing, ImageError when memory runs out.
  void finish();

 private:
  void write_chunk(std::string_view type, std::span<const std::uint8_t> data);
  void write_blocks(std::span<const std::uint8_t> rows);
  void write_whole();

  PngStreamOptions options_;
  Sink sink_;
  std::size_t row_bytes_;
  std::int64_t height_px_;
  std::int64_t rows_written_ = 0;
  std::vector<std::uint8_t> above_;           // the last row written; zeros before the first
  std::unique_ptr<std::uint8_t[]> filtered_;  // kWhole: all rows, each behind the number of its filter
  std::uint32_t checksum_ = 1;                // kBlocks: Adler-32 of all filtered rows so far
};

}  // namespace vpe::core
