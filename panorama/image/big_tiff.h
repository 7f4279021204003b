// Tiled BigTIFF files, written tile by tile in any order, of any size in little memory.
//
// Tiles have kTile_px a side, Deflate and a predictor (tile_codec.h). They are packed by the caller, on as many
// threads as it likes, and written as they are by libtiff, which also writes the directories. Reduced pages
// follow the full image, each half as large.
//
// Typical usage:
//   BigTiffWriter writer(file, width_px, height_px, kRgb, {software, xmp});
//   for (...) writer.put(across, down, pack_tile(tile, kRgb));
//   writer.add_reduced_pages(pool, progress);
//   writer.finish();
//   file.commit();
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "panorama/image/tile_codec.h"
#include "vpe/base/file.h"
#include "vpe/base/parallel.h"
#include "vpe/core/image/tiff_handle.h"
#include "vpe/core/image/tiff_metadata.h"

namespace panorama {

// Describes a file besides its pixels.
struct BigTiffTags {
  std::string software;
  std::string xmp;                        // a packet for the first page, or empty
  vpe::core::TiffMetadata metadata = {};  // of the first page
};

// Writes one file. For one thread; packing may run on others.
class BigTiffWriter {
 public:
  // Writes into a file that is empty and stays open until this is destroyed; the caller commits it. Throws
  // vpe::base::FileError.
  BigTiffWriter(vpe::base::OutputFile& file, std::int64_t width_px, std::int64_t height_px,
                const SampleFormat& format, BigTiffTags tags);

  // Return the number of tiles of the full image, until add_reduced_pages() is called.
  std::int64_t tiles_across() const { return page_.across; }
  std::int64_t tiles_down() const { return page_.down; }

  // Adds one tile of the full image, packed by pack_tile(). Pixels beyond the image's edge must repeat the
  // edge. Throws vpe::base::FileError, std::out_of_range.
  void put(std::int64_t across, std::int64_t down, std::span<const std::uint8_t> packed);

  // Adds pages of means of 2 x 2 pixels until one tile holds a page. Call it when every tile of the full image
  // has been put. For kRgb only. Calls `done` now and then with the finished fraction; it may throw to stop.
  // Throws vpe::base::FileError, std::logic_error when tiles are missing.
  void add_reduced_pages(vpe::base::ThreadPool& pool, const std::function<void(double)>& done);

  // Ends the file. Throws vpe::base::FileError, std::logic_error when tiles are missing.
  void finish();

 private:
  struct Page {
    std::int64_t width_px = 0;
    std::int64_t height_px = 0;
    std::int64_t across = 0;
    std::int64_t down = 0;
    std::vector<std::uint64_t> offset;  // of each tile; filled when the page ends
    std::vector<std::uint64_t> bytes;
  };

  [[noreturn]] void fail() const;
  void begin_page(std::int64_t width_px, std::int64_t height_px, bool is_reduced);
  void end_page();
  void put(std::size_t tile, std::span<const std::uint8_t> packed);
  std::vector<std::uint8_t> read(const Page& page, std::size_t tile) const;
  std::vector<std::uint8_t> reduced(const Page& fine, std::int64_t across, std::int64_t down) const;

  vpe::base::OutputFile& file_;
  SampleFormat format_;
  BigTiffTags tags_;
  vpe::core::TiffHandle tiff_;
  Page page_;  // the one that is written
};

}  // namespace panorama
