// S against the sources' own posts.
#pragma once

#include <span>
#include <vector>

#include "paging/build/build_steps.h"

namespace paging {

// By level, from 0 on: errors at the source posts that lie in these finest tiles (along the curve), of at most
// about options.resampling_posts over the whole planet. Equal for any number of threads, and adds up over
// parts. step() is called now and then, from any thread.
std::vector<ResamplingSum> measure_resampling(const BuildContext& context, std::span<const lod::TileKey> leaves,
                                              int threads, const std::function<void()>& step);

}  // namespace paging
