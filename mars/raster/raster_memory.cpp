#include "mars/raster/raster_memory.h"

#include <gdal.h>

#include <algorithm>
#include <atomic>

#include "mars/raster/gdal_tiles.h"

namespace mars {

void set_raster_memory(std::size_t bytes) {
  bytes = std::max(bytes, std::size_t{16} << 20);
  // GDAL's cache only serves the tiles that share a row of its blocks, because decoded tiles are kept here.
  GDALSetCacheMax64(static_cast<GIntBig>(bytes / 4));
  TileStore::common().set_limit(bytes - bytes / 4);
}

TileStore& TileStore::common() {
  static TileStore store(kDefaultRasterMemory - kDefaultRasterMemory / 4);
  return store;
}

std::uint64_t TileStore::next_cache() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace mars
