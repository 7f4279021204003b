// Auxiliary layers for a web page: whole numbers in a stated step, tile by tile.
//
// A page's layers have every step-th column and row of the image, from step / 2 on: column c of them is column
// c * step + step / 2. Tiles have kLayerTile_px a side. Each band of a tile has its own offset and as few bytes
// a number as its values need, so every value is within half a step of what the layer holds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "panorama/metadata/open_panorama.h"
#include "vpe/base/object_pool.h"

namespace panorama {

inline constexpr std::int64_t kLayerTile_px = 256;
// By default layers are thinned to at most this many pixels.
inline constexpr std::int64_t kMostLayerPixels = std::int64_t{1} << 24;

// Describes a band.
struct PageBand {
  std::string name;  // as PixelProbe's: "range_m", "lon_deg" ...
  // Between neighbouring values; of logarithms with is_log. 0: that of each tile, a part in 2^24 of its values'
  // range.
  double step = 0;
  bool is_log = false;
};

struct PageLayers {
  int step = 1;  // columns and rows of the image to one of the layers
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::vector<PageBand> bands;

  std::int64_t columns() const { return (width_px + kLayerTile_px - 1) / kLayerTile_px; }
  std::int64_t rows() const { return (height_px + kLayerTile_px - 1) / kLayerTile_px; }
};

// Returns the layers of a panorama; without bands if it has none. `step` 0: the smallest power of two that
// keeps to kMostLayerPixels. Opens the files and reads one pixel of each. Throws vpe::base::FileError when one
// cannot be used.
PageLayers layers_of(const PanoramaDescription& description, int step);

// A band of a tile: number 0 is no value, n > 0 is offset + step * (n - 1), or exp() of that with is_log.
struct PackedBand {
  int bytes = 0;  // of each number; 0: no pixel has a value
  double offset = 0;
  double step = 0;
  std::vector<std::uint8_t> data;  // row by row, the lowest byte of a number first
};

// Packs values; those that are not finite, or not above 0 with is_log, are no value. Pure.
PackedBand pack_band(std::span<const double> values, const PageBand& band);

// Reads and packs tiles. All const members may be called from any number of threads.
class LayerPacker {
 public:
  LayerPacker(const PanoramaDescription& description, PageLayers layers);
  ~LayerPacker();
  LayerPacker(const LayerPacker&) = delete;
  LayerPacker& operator=(const LayerPacker&) = delete;

  // Returns the script of a tile: its bands by name. Throws vpe::base::FileError.
  std::string tile_script(std::int64_t column, std::int64_t row) const;

 private:
  struct Readers;

  PanoramaDescription description_;
  PageLayers layers_;
  mutable vpe::base::ObjectPool<Readers> readers_;
};

}  // namespace panorama
