#include "mars/embedded/spurs.h"

namespace mars::embedded {

Spurs::Spurs(const Points& drawn_m, std::size_t padded, Simd simd, double spacing_m, std::uint32_t seed) {
  constexpr double kWavelengths_m[kSizes] = {17e3, 8.5e3, 4.1e3, 2.0e3, 0.93e3, 0.41e3, 0.17e3};
  for (std::size_t k = 0; k < kSizes; ++k) {
    if (2.0 * spacing_m <= kWavelengths_m[k]) {
      noise(drawn_m, padded, simd, kWavelengths_m[k], seed + static_cast<std::uint32_t>(k) * 0x11U, n_[k]);
    } else {
      n_[k].fill(kMeanNoise);
    }
  }
}

}  // namespace mars::embedded
