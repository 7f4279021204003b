// Chance that is a function of a seed and of counters.
#pragma once

#include <cstdint>

namespace objects {

// Returns bits in which every bit depends on every bit of x; a bijection.
constexpr std::uint64_t scatter_mix(std::uint64_t x) {
  x = (x ^ (x >> 32U)) * 0xd6e8feb86659fd93ULL;
  x = (x ^ (x >> 29U)) * 0x9fb21c651e98df25ULL;
  return x ^ (x >> 32U);
}

// Returns a number in [0, 1), the same for the same three numbers, a multiple of 2^-53.
constexpr double scatter_chance(std::uint64_t seed, std::uint64_t rock, std::uint64_t draw) {
  std::uint64_t bits = scatter_mix(seed + 0x9e3779b97f4a7c15ULL);
  bits = scatter_mix((bits ^ rock) + 0xc2b2ae3d27d4eb4fULL);
  bits = scatter_mix((bits ^ draw) + 0x165667b19e3779f9ULL);
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

}  // namespace objects
