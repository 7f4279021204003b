// Octaves of noise that all detail shares.
#pragma once

#include "mars/embedded/block.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

// Holds noise of wavelengths of 2^k metres, standard deviation 1, for k from `first` on. Those from kOutlineOctave on are
// present at every spacing.
inline constexpr int kFirstOctave = 1;
inline constexpr int kOutlineOctave = 14;
inline constexpr int kLastOctave = 15;
struct Octaves {
  int first = kOutlineOctave;
  std::array<Lane<float>, kLastOctave + 1> n;
};

// Sets the octaves that posts of a spacing show: wavelengths of two spacings and more.
inline void add_octaves(const Block& block, double spacing_m, Octaves& out) {
  out.first = kFirstOctave;
  while (out.first < kOutlineOctave && static_cast<double>(1 << out.first) < 2.0 * spacing_m) ++out.first;
  for (int k = out.first; k <= kLastOctave; ++k)
    noise(block, static_cast<double>(1 << k), 0x500U + static_cast<std::uint32_t>(k) * 0x1dU,
          out.n[static_cast<std::size_t>(k)]);
}

}  // namespace mars::embedded
