// Spurs and gullies of high walls.
#pragma once

#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

// A noise that is left out counts as this, so that crest() and valley() keep their means.
inline constexpr float kMeanNoise = 0.75F;

// 1 on sharp crests, falling to 0 on both sides; 0.4 in the mean.
inline double crest(float n) {
  const double a = n < 0.0F ? static_cast<double>(-n) : static_cast<double>(n);
  return a < 1.25 ? 1.0 - 0.8 * a : 0.0;
}
// 0 in sharp valleys, rising to 1; 0.6 in the mean.
inline double valley(float n) { return 1.0 - crest(n); }

class Spurs {
 public:
  // `drawn_m`: each post pulled back along the wall's fall line, so that the pattern is stretched downhill.
  Spurs(const Points& drawn_m, std::size_t padded, Simd simd, double spacing_m, std::uint32_t seed);

  // Share of the wall's width by which post i is moved towards the rim, where `s` is how far down the wall
  // the post lies (0 rim .. 1 foot): spurs stand out, gullies are cut back. Zero at both ends.
  double shift(std::size_t i, double s) const {
    // Spurs branch: each size rides on the crests of the one above.
    const double c0 = crest(n_[0][i]);
    const double c1 = crest(n_[1][i]);
    const double c2 = valley(n_[2][i]);
    const double c3 = crest(n_[3][i]);
    const double spur = 0.50 * c0 + 0.30 * c1 * (0.4 + c0) + 0.17 * c2 * (0.4 + c1) + 0.09 * c3 * (0.4 + c2);
    return 0.27 * 4.0 * s * (1.0 - s) * (spur - 0.42);
  }

  // Relief of the rills, metres; fades out towards the foot. Zero at both ends.
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
