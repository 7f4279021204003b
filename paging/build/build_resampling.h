// Measures the reference surface against the sources' own posts.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "paging/build/build_steps.h"

namespace paging {

struct ResamplingReport {
  ResamplingSums sums;
  std::vector<TileResampling> tiles;  // of tiles with source posts, by key and source
};

// Measures the errors at the source posts that lie in these finest tiles (in Morton order).
// Over the whole planet about `most_posts` posts are compared at most. The result is equal for any number of
// threads and adds up over shards. step() is called now and then, from any thread.
ResamplingReport measure_resampling(const SampleInputs& sampling, const StoredTiles& stored,
                                    std::size_t most_posts, std::span<const lod::TileKey> leaves, int threads,
                                    const std::function<void()>& step);

}  // namespace paging
