// What all open rasters together may keep in memory.
#pragma once

#include <cstddef>

namespace mars {

inline constexpr std::size_t kDefaultRasterMemory = std::size_t{512} << 20;

// Decoded pieces of all rasters, and GDAL's own blocks, together stay within about this many bytes, whatever
// the number of sources; what is in use at the moment is not given up. At least 16 MiB. Any thread may call it,
// at any time.
void set_raster_memory(std::size_t bytes);

}  // namespace mars
