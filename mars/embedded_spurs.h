// Spurs and gullies of high walls.
#pragma once

#include "mars/embedded_math.h"
#include "mars/embedded_noise.h"

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
  double shift(std::size_t i, double s) const;

  // Relief of the rills, metres; fades out towards the foot.
  double rills_m(std::size_t i, double s) const;

 private:
  static constexpr std::size_t kSizes = 7;
  Lane<float> n_[kSizes];
};

}  // namespace mars::embedded
