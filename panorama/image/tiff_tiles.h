// Tiles of the pages of TIFF files. Private to panorama.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "panorama/image/tiff_file.h"
#include "panorama/image/tile_source.h"
#include "vpe/base/object_pool.h"

namespace panorama {

// Describes one image in a TIFF file: the first one, or a reduced copy of it.
struct TiffPage {
  std::shared_ptr<const TiffFile> file;  // stays open, so that all handles are of one file
  std::uint64_t directory = 0;           // offset in the file
  ImageLevel level;                      // strips count as tiles as wide as the image
  bool is_tiled = false;
};

// Returns the first image and those reduced copies of it (NewSubfileType 1, in the chain or below the first)
// whose size fits to it, largest first. Reads directories only. Throws vpe::base::FileError: damaged, or a
// first image that is not 8 or 16 bits, grey or RGB.
std::vector<TiffPage> list_pages(const std::filesystem::path& path);

// Returns the memory of one tile.
std::size_t tile_bytes(const ImageLevel& level);

// Reads tiles of the pages of one image. Every thread that reads has a handle of its own.
class TiffTiles : public TileSource {
 public:
  // Takes the pages of one image, largest first.
  explicit TiffTiles(std::vector<TiffPage> pages);

  const std::vector<ImageLevel>& levels() const override { return levels_; }
  // Returns a tile. Tiles that a sparse file leaves out are black.
  std::shared_ptr<const Tile> read(int level, std::int64_t column, std::int64_t row) const override;

 private:
  struct Handle {
    explicit Handle(const TiffFile& open) : file(TiffFile::Same{open}) {}
    TiffFile file;
    std::vector<std::uint8_t> bytes;
  };
  static std::unique_ptr<Handle> open(const TiffPage& page);

  std::vector<TiffPage> pages_;
  std::vector<ImageLevel> levels_;
  mutable std::deque<vpe::base::ObjectPool<Handle>> handles_;  // by page
};

}  // namespace panorama
