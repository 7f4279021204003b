// A tile of an image layer as a planet file stores it: colours as JPEG, and the share of the layer in each texel.
//
// Typical usage:
//   const Bytes packed = encode_layer_tile(colours, shares, 90);
//   const LayerTile tile = decode_layer_tile(packed);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "paging/planet/codec.h"
#include "vpe/base/rgb.h"

namespace paging {

// Holds 257 x 257 texels, as ImageTile has them. A layer that has nodata in the whole tile has no texels.
struct LayerTile {
  std::vector<vpe::base::Rgb> texels;
  std::vector<std::uint8_t>
      shares;  // 0: the layer has no data there, 255: it covers all below it; empty: 255 everywhere

  bool is_empty() const { return texels.empty(); }
};

// Packs a tile: one byte that says what follows, the shares as a zstd frame where they differ from 255, and the JPEG.
// Nodata texels take the colour of a texel beside them, so that the JPEG has no edge at the boundary of the data;
// their colours do not count. Both spans have 257 * 257 elements. `quality` is that of JPEG.
Bytes encode_layer_tile(std::span<const vpe::base::Rgb> texels, std::span<const std::uint8_t> shares,
                        int quality);

// Unpacks such a tile. The shares are the same, the colours those of the JPEG. Throws CodecError for bytes that
// encode_layer_tile() did not write, and ImageError for a damaged JPEG.
LayerTile decode_layer_tile(std::span<const std::uint8_t> packed);

}  // namespace paging
