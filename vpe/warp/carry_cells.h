// Any new view: cells between four neighbouring pixels are drawn as triangles. Private to vpe/warp; carry.h has the
// contract.
#pragma once

#include "vpe/warp/carry.h"

namespace vpe::warp {

// Carries cell by cell, with the memory of `pixels`. Expects checked arguments, and `into` with its sizes.
void carry_cells(const core::View& from, const core::Frame& frame, const core::View& to,
                 const CarryOptions& options, base::ThreadPool& pool, MovedPixels& pixels, CarriedImage& into);

}  // namespace vpe::warp
