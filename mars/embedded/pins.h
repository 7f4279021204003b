// Corrections that take the detail to zero at the posts of the data, and its mean to zero over their areas.
#pragma once

#include "mars/embedded/surface.h"

namespace mars::embedded {

// Adds the groups of relief to `out`, each less its own value at the four posts around, faded with the distance from
// them. Sets all of `out`.
void sum_pinned(const Block& block, const MeasuredMars& mars, double detail_m, const Ground& ground,
                const Relief& relief, Lane<float>& out);

// Subtracts from `detail_m` the mean that sum_pinned() and craters have over the areas of posts.
void subtract_means(const Block& block, const MeasuredMars& mars, double spacing_m, const Ground& ground,
                    Lane<float>& detail_m);

}  // namespace mars::embedded
