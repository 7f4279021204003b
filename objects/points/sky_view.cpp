#include "objects/points/sky_view.h"

#include <cstdint>
#include <span>

namespace objects {

namespace {

// Clears the bits of `view` whose next voxel upwards, in the column that a step leads to, does not see the sky.
void keep_seen_above(std::span<std::uint64_t> view, std::span<const std::uint64_t> next, int height) {
  for (std::size_t w = 0; w < view.size(); ++w) {
    std::uint64_t above = next[w] >> 1 | (w + 1 < next.size() ? next[w + 1] << 63 : 0);
    const int last = height - 1 - static_cast<int>(w) * 64;  // above the highest voxel there is sky
    if (last >= 0 && last < 64) above |= std::uint64_t{1} << last;
    view[w] &= above;
  }
}

// Clears the bits below the highest clear one.
void keep_top(std::span<std::uint64_t> view, int height) {
  bool is_seen = true;
  for (int z = height - 1; z >= 0; --z) {
    std::uint64_t& word = view[static_cast<std::size_t>(z) / 64];
    const std::uint64_t bit = std::uint64_t{1} << (z % 64);
    is_seen = is_seen && (word & bit) != 0;
    if (!is_seen) word &= ~bit;
  }
}

}  // namespace

VoxelGrid sky_view(const VoxelGrid& filled, const glm::ivec3& step) {
  const StickGrid& grid = filled.grid();
  VoxelGrid view(grid);
  // The column that a step leads to comes first.
  for (int row = 0; row < grid.columns_y; ++row) {
    const int y = step.y > 0 ? grid.columns_y - 1 - row : row;
    for (int n = 0; n < grid.columns_x; ++n) {
      const int x = step.x > 0 ? grid.columns_x - 1 - n : n;
      const std::span<std::uint64_t> own = view.bits(view.column(x, y));
      const std::span<const std::uint64_t> solid = filled.bits(filled.column(x, y));
      for (std::size_t w = 0; w < own.size(); ++w) {
        const int rest = grid.height - static_cast<int>(w) * 64;
        own[w] = ~solid[w] & (rest >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << rest) - 1);
      }
      const glm::ivec3 next(x + step.x, y + step.y, 0);
      if (step.x == 0 && step.y == 0)
        keep_top(own, grid.height);
      else if (next.x >= 0 && next.x < grid.columns_x && next.y >= 0 && next.y < grid.columns_y)
        keep_seen_above(own, view.bits(view.column(next.x, next.y)), grid.height);
    }
  }
  return view;
}

bool sees_sky(const VoxelGrid& view, glm::ivec3 voxel, const glm::ivec3& step) {
  const StickGrid& grid = view.grid();
  const glm::ivec3 size(grid.columns_x, grid.columns_y, grid.height);
  while (true) {
    bool is_inside = true;
    for (int k = 0; k < 3; ++k) {
      const bool is_below = voxel[k] < 0;
      const bool is_above = voxel[k] >= size[k];
      if ((is_below && step[k] <= 0) || (is_above && step[k] >= 0)) return true;
      is_inside = is_inside && !is_below && !is_above;
    }
    if (is_inside) return view.is_set(voxel.x, voxel.y, voxel.z);
    voxel += step;
  }
}

}  // namespace objects
