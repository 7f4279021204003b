// Work that is divided among independent runs.
#pragma once

#include <cstdint>

namespace vpe::base {

// Part `number` (from 1) of `of`.
struct Shard {
  std::int64_t number = 1;
  std::int64_t of = 1;

  bool is_all() const { return of == 1; }

  // Which of `count` items are this part's: a block [begin, end); the blocks of all parts follow each other.
  std::int64_t begin(std::int64_t count) const {
    // count / of * number would be uneven, count * number may not fit.
    const std::int64_t before = number - 1;
    return count / of * before + count % of * before / of;
  }
  std::int64_t end(std::int64_t count) const { return Shard{number + 1, of}.begin(count); }
};

}  // namespace vpe::base
