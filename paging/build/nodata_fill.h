// Heights of the ground where no source has data.
#pragma once

#include <span>
#include <vector>

#include "paging/build/build_steps.h"

namespace paging {

// Replaces heights that are NaN, where no source has data, by a continuation of the data around them, so that
// the drawn ground has no walls at the edge of the data. heights_m are those of a tile's posts, row by row, and
// level[n] is the level at whose spacing post n was sampled: that of the coarsest finest tile that has it, which
// may be coarser or finer than the tile.
//
// The height of a post at level l is the first of these that has data: the sources at the spacing of l; the
// mean of the eight posts of level l around it; its one, two or four neighbours on the lines of level l - 1,
// each found in the same way. Of these, those with no data near them weigh a quarter. It is fill_m if there is
// no data down to the corners of the cube. So it is a function of the post and its level alone: tiles agree on
// the posts that they share. Throws mars::SourceError.
void fill_nodata(const SampleInputs& sampling, const lod::TileKey& key, std::span<const int> level,
                 std::vector<double>& heights_m);

}  // namespace paging
