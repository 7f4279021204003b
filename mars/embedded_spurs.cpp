#include "mars/embedded_spurs.h"

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

double Spurs::shift(std::size_t i, double s) const {
  // Spurs branch: each size rides on the crests of the one above.
  const double c0 = crest(n_[0][i]);
  const double c1 = crest(n_[1][i]);
  const double c2 = valley(n_[2][i]);
  const double c3 = crest(n_[3][i]);
  const double spur = 0.50 * c0 + 0.30 * c1 * (0.4 + c0) + 0.17 * c2 * (0.4 + c1) + 0.09 * c3 * (0.4 + c2);
  return 0.27 * 4.0 * s * (1.0 - s) * (spur - 0.42);
}

double Spurs::rills_m(std::size_t i, double s) const {
  const double c3 = crest(n_[3][i]);
  const double c4 = valley(n_[4][i]);
  const double there = clamp01(s * 12.0) * clamp01(2.6 - 2.6 * s);
  return there * (62.0 * (c4 - 0.6) * (0.35 + c3) + 28.0 * (crest(n_[5][i]) - 0.4) * (0.3 + c4) +
                  10.0 * (valley(n_[6][i]) - 0.6));
}

}  // namespace mars::embedded
