// Tiled BigTIFF files, written tile by tile in any order, of any size in little memory.
//
// Sources: the BigTIFF description of Aware Systems and TIFF 6. Tiles of kTile_px, Deflate with predictor; the
// directories stand at the end of the file. Reduced pages follow the full image, each half as large.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "panorama/image/tile_codec.h"
#include "vpe/base/file.h"
#include "vpe/base/parallel.h"

namespace panorama {

struct BigTiffTags {
  std::string software;
  std::string xmp;       // a packet, or empty
  bool no_data = false;  // floating point: NaN is where there is nothing (as GDAL says it)
};

class BigTiffWriter {
 public:
  // Into a file that is empty and stays open; the caller commits it. Throws vpe::base::FileError.
  BigTiffWriter(vpe::base::OutputFile& file, std::int64_t width_px, std::int64_t height_px,
                const SampleFormat& format, BigTiffTags tags);

  std::int64_t tiles_across() const { return pages_.front().across; }
  std::int64_t tiles_down() const { return pages_.front().down; }

  // One tile of the full image, packed. What lies beyond the image's edge repeats the edge. Throws
  // vpe::base::FileError.
  void put(std::int64_t across, std::int64_t down, std::span<const std::uint8_t> packed);

  // Means of 2 x 2 pixels, page by page until one tile holds all; kRgb only, when every tile has been put.
  // `done` is called now and then with the share that is ready, and may throw.
  void add_reduced_pages(vpe::base::ThreadPool& pool, const std::function<void(double)>& done);

  // Writes the directories. Throws std::logic_error when tiles are missing.
  void finish();

 private:
  struct Page {
    std::int64_t width_px = 0;
    std::int64_t height_px = 0;
    std::int64_t across = 0;
    std::int64_t down = 0;
    std::vector<std::uint64_t> offset;  // 0: not there yet
    std::vector<std::uint64_t> bytes;
  };

  static Page page_of(std::int64_t width_px, std::int64_t height_px);
  void append(std::span<const std::uint8_t> bytes);
  void put(Page& page, std::size_t tile, std::span<const std::uint8_t> packed);
  std::vector<std::uint8_t> read(const Page& page, std::size_t tile) const;
  std::vector<std::uint8_t> reduced(const Page& fine, std::int64_t across, std::int64_t down) const;
  // Returns where the link to the next directory stands.
  std::uint64_t write_directory(const Page& page, bool is_reduced, std::uint64_t link);

  vpe::base::OutputFile& file_;
  SampleFormat format_;
  BigTiffTags tags_;
  std::vector<Page> pages_;
  std::uint64_t end_ = 0;
};

}  // namespace panorama
