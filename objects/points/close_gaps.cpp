#include "objects/points/close_gaps.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "objects/sticks/flood_fill.h"

namespace objects {

namespace {

using WordSpan = std::span<std::uint64_t>;

// Makes each entry of a line the union (or intersection) of itself and the next window - 1 ones, in steps that double.
// An entry has `stride` words. What lies behind the line counts as empty, so near its end intersections are too large
// and must not be used.
template <class Join>
void window_entries(WordSpan line, std::size_t stride, std::size_t window, const Join& join) {
  const auto add_from = [&](std::size_t entries) {
    const std::size_t ahead = entries * stride;
    for (std::size_t n = 0; n + ahead < line.size(); ++n) line[n] = join(line[n], line[n + ahead]);
  };
  std::size_t done = 1;
  for (; 2 * done <= window; done *= 2) add_from(done);
  if (done < window) add_from(window - done);
}

// Does the same with the bits of a column.
template <class Join>
void window_bits(WordSpan column, std::size_t window, const Join& join) {
  const auto add_from = [&](std::size_t bits) {
    for (std::size_t w = 0; w < column.size(); ++w) {
      const std::uint64_t next = w + 1 < column.size() ? column[w + 1] : 0;
      column[w] = join(column[w], column[w] >> bits | next << (64 - bits));
    }
  };
  std::size_t done = 1;
  for (; 2 * done <= window; done *= 2) add_from(done);
  if (done < window) add_from(window - done);
}

// Does it along all three axes of a grid.
template <class Join>
void window_grid(VoxelGrid& voxels, std::size_t window, const Join& join) {
  const auto columns_x = static_cast<std::size_t>(voxels.grid().columns_x);
  const auto columns_y = static_cast<std::size_t>(voxels.grid().columns_y);
  const std::size_t words = voxels.words();
  for (std::size_t column = 0; column < voxels.columns(); ++column)
    window_bits(voxels.bits(column), window, join);
  // The columns of a row lie one behind the other.
  for (std::size_t y = 0; y < columns_y; ++y)
    window_entries({voxels.bits(y * columns_x).data(), columns_x * words}, words, window, join);
  std::vector<std::uint64_t> line(columns_y * words);
  for (std::size_t x = 0; x < columns_x; ++x) {
    for (std::size_t y = 0; y < columns_y; ++y)
      std::copy_n(voxels.bits(y * columns_x + x).begin(), words,
                  line.begin() + static_cast<std::ptrdiff_t>(y * words));
    window_entries(line, words, window, join);
    for (std::size_t y = 0; y < columns_y; ++y)
      std::copy_n(line.begin() + static_cast<std::ptrdiff_t>(y * words), words,
                  voxels.bits(y * columns_x + x).begin());
  }
}

}  // namespace

void close_gaps(VoxelGrid& voxels, int reach) {
  if (reach <= 0) return fill_inside(voxels);
  const StickGrid& grid = voxels.grid();
  // Voxel v is written to v + 2 * reach, so that windows that only look ahead centre the union at v + reach, and then
  // the intersection at v.
  VoxelGrid wide({grid.columns_x + 2 * reach, grid.columns_y + 2 * reach, grid.height + 2 * reach, 1});
  const auto shift = static_cast<std::size_t>(2 * reach);
  for (int y = 0; y < grid.columns_y; ++y) {
    for (int x = 0; x < grid.columns_x; ++x) {
      const std::span<const std::uint64_t> from = std::as_const(voxels).bits(voxels.column(x, y));
      const WordSpan to = wide.bits(wide.column(x + 2 * reach, y + 2 * reach));
      std::uint64_t carried = 0;
      for (std::size_t w = 0; w < to.size(); ++w) {
        const std::uint64_t word = w < from.size() ? from[w] : 0;
        to[w] = word << shift | carried;
        carried = word >> (64 - shift);
      }
    }
  }
  const std::size_t window = shift + 1;
  window_grid(wide, window, std::bit_or<>());
  fill_inside(wide);
  window_grid(wide, window, std::bit_and<>());
  for (int y = 0; y < grid.columns_y; ++y) {
    for (int x = 0; x < grid.columns_x; ++x) {
      const std::span<const std::uint64_t> from = std::as_const(wide).bits(wide.column(x, y));
      const WordSpan to = voxels.bits(voxels.column(x, y));
      for (std::size_t w = 0; w < to.size(); ++w) {
        const int rest = grid.height - static_cast<int>(w) * 64;
        to[w] = from[w] & (rest >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << rest) - 1);
      }
    }
  }
}

}  // namespace objects
