// Memory budget that all open rasters share.
#pragma once

#include <cstddef>

namespace mars {

inline constexpr std::size_t kDefaultRasterMemory = std::size_t{512} << 20;

// Limits the decoded tiles of all rasters together with GDAL's own blocks to about this number of bytes, at
// least 16 MiB, whatever the number of sources. Tiles in use are not evicted. Smaller: rasters are decoded
// again more often; larger: less memory is left for the build. Any thread may call it at any time.
void set_raster_memory(std::size_t bytes);

}  // namespace mars
