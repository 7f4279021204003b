// Spurs and gullies of high walls.
#pragma once

#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

// Value that replaces an omitted noise, so that crest() and valley() keep their means.
inline constexpr float kMeanNoise = 0.75F;

// Returns 1 on sharp crests, falling to 0 on both sides; 0.4 on average.
inline double crest(float n) {
  const double a = n < 0.0F ? static_cast<double>(-n) : static_cast<double>(n);
  return a < 1.25 ? 1.0 - 0.8 * a : 0.0;
}

// Returns 0 in sharp valleys, rising to 1; 0.6 on average.
inline double valley(float n) { return 1.0 - crest(n); }

// Computes the pattern of spurs and gullies on walls.
class Spurs {
 public:
  // `drawn_m` are the posts, moved back along the fall line of the wall so that the pattern is stretched
  // downhill.
  Spurs(const Points& drawn_m, std::size_t padded, Simd simd, double spacing_m, std::uint32_t seed) {
    constexpr double kWavelengths_m[kSizes] = {17e3, 8.5e3, 4.1e3, 2.0e3, 0.93e3, 0.41e3, 0.17e3};
    for (std::size_t k = 0; k < kSizes; ++k) {
      if (2.0 * spacing_m <= kWavelengths_m[k]) {
        noise(drawn_m, padded, simd, kWavelengths_m[k], seed + static_cast<std::uint32_t>(k) * 0x11U, n_[k]);
      } else {
        n_[k].fill(kMeanNoise);
      }
    }
  }

  // Returns the share of the wall's width by which post i is moved towards the rim: spurs stand out, gullies
  // are cut back. `s` is the position on the wall, 0 at the rim and 1 at the foot. Zero at both ends.
  double shift(std::size_t i, double s) const {
    // Spurs branch: each size is strongest on the crests of the next larger one.
    const double c0 = crest(n_[0][i]);
    const double c1 = crest(n_[1][i]);
    const double c2 = valley(n_[2][i]);
    const double c3 = crest(n_[3][i]);
    const double spur = 0.50 * c0 + 0.30 * c1 * (0.4 + c0) + 0.17 * c2 * (0.4 + c1) + 0.09 * c3 * (0.4 + c2);
    return 0.27 * 4.0 * s * (1.0 - s) * (spur - 0.42);
  }

  // Returns the height of the rills in metres. It fades out towards the foot and is zero at both ends.
  double rills_m(std::size_t i, double s) const {
    const double c3 = crest(n_[3][i]);
    const double c4 = valley(n_[4][i]);
    const double there = clamp01(s * 12.0) * clamp01(2.6 - 2.6 * s);
    return there * (62.0 * (c4 - 0.6) * (0.35 + c3) + 28.0 * (crest(n_[5][i]) - 0.4) * (0.3 + c4) +
                    10.0 * (valley(n_[6][i]) - 0.6));
  }

 private:
  static constexpr std::size_t kSizes = 7;
  Lane<float> n_[kSizes];
};

}  // namespace mars::embedded
