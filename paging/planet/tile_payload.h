// The compressed content of a tile, as a planet file or a patch holds it.
#pragma once

#include <vector>

#include "paging/planet/codec.h"

namespace paging {

// Holds everything that is stored of a tile besides its row in the tile index. The members are what the encoders of
// codec.h and tile_sources.h return.
struct TilePayload {
  Bytes heights;
  Bytes nodata;               // empty when every post has data
  Bytes origin;               // encode_origin(); empty when all posts with data have one source
  std::vector<Bytes> meshes;  // by variant

  bool operator==(const TilePayload&) const = default;
};

}  // namespace paging
