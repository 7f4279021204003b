// Stretches of set bits in columns of voxels (voxel_grid.h).
//
// Typical usage:
//   for_each_stretch(voxels.bits(column), [&](int begin, int end) { use(begin, end); });
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace objects {

// Returns the first bit from `from` on that is set (or clear), or the number of bits. Pure.
inline int next_bit(std::span<const std::uint64_t> words, int from, bool is_set) {
  const int bits = static_cast<int>(words.size() * 64);
  while (from < bits) {
    const std::uint64_t word = words[static_cast<std::size_t>(from) / 64];
    const std::uint64_t rest = (is_set ? word : ~word) >> (from % 64);
    if (rest != 0) return from + std::countr_zero(rest);
    from = (from / 64 + 1) * 64;
  }
  return bits;
}

// Calls visit(begin, end) for each stretch of set bits, upwards.
template <class Visit>
void for_each_stretch(std::span<const std::uint64_t> words, const Visit& visit) {
  const int bits = static_cast<int>(words.size() * 64);
  for (int begin = next_bit(words, 0, true); begin < bits;) {
    const int end = next_bit(words, begin, false);
    visit(begin, end);
    begin = next_bit(words, end, true);
  }
}

}  // namespace objects
