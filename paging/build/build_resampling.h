// Measures the reference surface against the sources' own posts.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "paging/build/build_steps.h"
#include "paging/planet/tile_sources.h"

namespace paging {

struct ResamplingReport {
  ResamplingSums sums;
  std::vector<TileResampling> tiles;  // of tiles with source posts, by key and source
};

// Measures the errors at the source posts that lie in these finest tiles (in Morton order).
// Posts outside of the wanted caps may be left out. Over the whole planet about `most_posts` posts are compared at
// most. The result is equal for any number of threads and adds up over shards. step() is called now and then, from
// any thread.
ResamplingReport measure_resampling(const SampleInputs& sampling, const StoredTiles& stored,
                                    std::size_t most_posts, const mars::WantedCap& wanted,
                                    std::span<const lod::TileKey> leaves, int threads,
                                    const std::function<void()>& step);

// Returns what the measuring of these finest tiles needs of the sources: caps that touch the tiles if they are not all
// of the planet's, and, where a source is remote, a region. Empty: all.
mars::WantedCap wanted_posts(const BuildOptions& options, const PlanetMeta& meta,
                             std::span<const lod::TileKey> leaves, bool are_some);

}  // namespace paging
