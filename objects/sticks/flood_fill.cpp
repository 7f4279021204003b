#include "objects/sticks/flood_fill.h"

#include <algorithm>
#include <vector>

namespace objects {

namespace {

// Spreads from the outside, stretch by stretch of columns.
class OutsideFlood {
 public:
  explicit OutsideFlood(const VoxelGrid& shells) : grid_(shells.grid()), reached_(shells) {}

  // Returns the voxels that are reached, and those of the shells.
  const VoxelGrid& run() {
    const int x_last = grid_.columns_x - 1;
    const int y_last = grid_.columns_y - 1;
    for (int y = 0; y <= y_last; ++y) {
      for (int x = 0; x <= x_last; ++x) {
        if (x == 0 || y == 0 || x == x_last || y == y_last) {
          enter(x, y, 0, grid_.height);
        } else {
          enter(x, y, 0, 1);
          enter(x, y, grid_.height - 1, grid_.height);
        }
        spread();
      }
    }
    return reached_;
  }

 private:
  struct Reached {
    int x, y, begin, end;
  };

  // Marks the free stretches of a column that meet [begin, end).
  void enter(int x, int y, int begin, int end) {
    const std::span<std::uint64_t> words = reached_.bits(reached_.column(x, y));
    for (int at = next_bit(words, begin, false); at < end;) {
      const int past = std::min(next_bit(words, at, true), grid_.height);
      int first = at;
      while (first > 0 && at == begin && is_free(words, first - 1)) --first;
      mark(words, first, past);
      stack_.push_back({x, y, first, past});
      at = next_bit(words, past, false);
    }
  }

  void spread() {
    while (!stack_.empty()) {
      const Reached at = stack_.back();
      stack_.pop_back();
      if (at.x > 0) enter(at.x - 1, at.y, at.begin, at.end);
      if (at.y > 0) enter(at.x, at.y - 1, at.begin, at.end);
      if (at.x + 1 < grid_.columns_x) enter(at.x + 1, at.y, at.begin, at.end);
      if (at.y + 1 < grid_.columns_y) enter(at.x, at.y + 1, at.begin, at.end);
    }
  }

  static bool is_free(std::span<const std::uint64_t> words, int z) {
    return ((words[static_cast<std::size_t>(z) / 64] >> (z % 64)) & 1U) == 0;
  }

  static void mark(std::span<std::uint64_t> words, int begin, int end) {
    for (int z = begin; z < end;) {
      const int word_end = std::min(end, (z / 64 + 1) * 64);
      const int count = word_end - z;
      const std::uint64_t bits =
          count == 64 ? ~std::uint64_t{0} : ((std::uint64_t{1} << count) - 1) << (z % 64);
      words[static_cast<std::size_t>(z) / 64] |= bits;
      z = word_end;
    }
  }

  StickGrid grid_;
  VoxelGrid reached_;
  std::vector<Reached> stack_;
};

}  // namespace

void fill_inside(VoxelGrid& shells) {
  OutsideFlood flood(shells);
  const VoxelGrid& reached = flood.run();
  const int height = shells.grid().height;
  for (std::size_t column = 0; column < shells.columns(); ++column) {
    const std::span<const std::uint64_t> seen = reached.bits(column);
    const std::span<std::uint64_t> words = shells.bits(column);
    for (std::size_t w = 0; w < words.size(); ++w) {
      const int rest = height - static_cast<int>(w) * 64;
      words[w] |= rest >= 64 ? ~seen[w] : ~seen[w] & ((std::uint64_t{1} << rest) - 1);
    }
  }
}

}  // namespace objects
