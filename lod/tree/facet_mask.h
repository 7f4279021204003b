// Flags of posts, asked at any place of the reference surface.
#pragma once

#include <cstddef>
#include <vector>

namespace lod {

// Returns whether a post that spans the reference surface at a place is flagged. The place lies at the fractions
// (x, y), 0 to 1, of the cell whose south-west post is `south_west`, in rows of `side` posts. On a facet three
// posts span it, on an edge two, at a post this one alone. Pure.
inline bool is_flagged(const std::vector<bool>& flags, std::size_t south_west, std::size_t side, double x,
                       double y) {
  const double low = x < y ? x : y;
  const double high = x < y ? y : x;
  if (high < 1 && flags[south_west]) return true;
  if (low > 0 && flags[south_west + side + 1]) return true;
  if (x > y) return flags[south_west + 1];
  return y > x && flags[south_west + side];
}

}  // namespace lod
