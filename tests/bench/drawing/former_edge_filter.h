// The filter of edges as it was before 2026-11-28: the peer of edge_filter_bench.
#pragma once

#include <span>

#include "vpe/base/parallel.h"
#include "vpe/base/rgb.h"

namespace bench {

// Does what vpe::core::smooth_edges() does, bit by bit, for spans of width * height values.
void smooth_edges_formerly(std::span<vpe::base::Rgb> colour, std::span<const float> inverse_depth, int width,
                           int height, vpe::base::ThreadPool& pool);

}  // namespace bench
