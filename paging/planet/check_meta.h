// Compares what the table `meta` states with the tiles. Used by PlanetFile and verify().
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "paging/planet/planet_meta.h"

namespace paging {

// Returns what in `meta` must not be relied on, or an empty text: counts and levels that are not those of the
// tiles, and bounds of the radius that do not hold. Bounds farther out than necessary are accepted.
std::string unsafe_meta(const PlanetMeta& meta, std::span<const lod::TileInfo> tiles,
                        std::span<const std::int64_t> image_keys);

// Returns everything in `meta` that differs from what its builder computes. `levels` is what
// summarize_levels() finds.
std::vector<std::string> wrong_meta(const PlanetMeta& meta, std::span<const lod::TileInfo> tiles,
                                    std::vector<LevelSummary> levels);

}  // namespace paging
