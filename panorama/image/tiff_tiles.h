// Tiles of the pages of TIFF files. Private to panorama.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "panorama/image/tiff_file.h"
#include "panorama/image/tile_source.h"

namespace panorama {

// One image in a TIFF file: the first, or a reduced copy of it.
struct TiffPage {
  std::filesystem::path path;
  std::uint64_t directory = 0;  // where in the file
  ImageLevel level;             // of strips: tiles as wide as the image
  bool is_tiled = false;
};

// The first image and the reduced copies (NewSubfileType 1, in the chain or below the first) that fit to it,
// largest first. Reads directories only. Throws vpe::base::FileError: damaged, or a first image that is not
// 8 or 16 bits, grey or RGB.
std::vector<TiffPage> list_pages(const std::filesystem::path& path);

// Bytes that one tile takes.
std::size_t tile_bytes(const ImageLevel& level);

class TiffTiles : public TileSource {
 public:
  // The pages of one image, largest first.
  explicit TiffTiles(std::vector<TiffPage> pages);

  const std::vector<ImageLevel>& levels() const override { return levels_; }
  // Tiles that a sparse file leaves out are black.
  std::shared_ptr<const Tile> read(int level, std::int64_t column, std::int64_t row) const override;

 private:
  struct Handle {
    explicit Handle(const std::filesystem::path& path) : file(path) {}
    TiffFile file;
    std::vector<std::uint8_t> bytes;
  };
  std::unique_ptr<Handle> take(std::size_t page) const;
  void put_back(std::size_t page, std::unique_ptr<Handle> handle) const;

  std::vector<TiffPage> pages_;
  std::vector<ImageLevel> levels_;
  mutable std::mutex mutex_;
  mutable std::vector<std::vector<std::unique_ptr<Handle>>> idle_;  // by page
};

}  // namespace panorama
