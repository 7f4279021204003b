// One share of work that is divided among independent runs.
#pragma once

#include <cstdint>

namespace vpe::base {

// Describes the shard `number` (counted from 1) of `of`. Each run handles one shard: --part NUMBER/OF.
struct Shard {
  std::int64_t number = 1;
  std::int64_t of = 1;

  bool is_all() const { return of == 1; }

  // Return the block [begin, end) of `count` items that belongs to this shard. The blocks of all shards follow
  // each other and differ by at most one item.
  std::int64_t begin(std::int64_t count) const {
    // count / of * number would be uneven, count * number may overflow.
    const std::int64_t before = number - 1;
    return count / of * before + count % of * before / of;
  }
  std::int64_t end(std::int64_t count) const { return Shard{number + 1, of}.begin(count); }
};

}  // namespace vpe::base
