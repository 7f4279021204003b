// The second eye: rows of both images correspond. Private to vpe/warp; carry.h has the contract.
#pragma once

#include "vpe/warp/carry.h"

namespace vpe::warp {

// Returns true if `to` differs from `from` by a shift along the right axis and in the principal point's column alone.
bool rows_correspond(const core::View& from, const core::View& to);

// Carries row by row. Expects rows_correspond(), checked arguments, and `into` with its sizes.
void carry_rows(const core::View& from, const core::Frame& frame, const core::View& to,
                const CarryOptions& options, base::ThreadPool& pool, CarriedImage& into);

}  // namespace vpe::warp
