#include "vpe/core/appearance/nodata_pattern.h"

#include <algorithm>
#include <cmath>

namespace vpe::core {

namespace {

constexpr double kLeastPeriod_px = 12;
constexpr double kFinestOctave = 22;

// Returns the share of a pixel of width `wide`, `away` from the middle of a stripe, that the stripe of half
// width `reach` covers.
double covered(double away, double reach, double wide) {
  return std::clamp((reach - away) / wide + 0.5, 0.0, std::min(1.0, 2 * reach / wide));
}

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

double nodata_grey(double along, double pixel) {
  const double detail = std::clamp(-std::log2(kLeastPeriod_px * std::max(pixel, 1e-12)), 0.0, kFinestOctave);
  const double octave = std::floor(detail);
  const double grown = detail - octave;
  const double periods = std::exp2(octave);
  const double wide = std::max(pixel * periods, 1e-6);
  const double phase = along * periods - std::floor(along * periods);
  const double away = std::min(phase, 1 - phase);
  const double stripes = covered(away, 0.25 - 0.125 * grown, wide) + covered(0.5 - away, 0.125 * grown, wide);
  const double dark = stripes + (0.5 - stripes) * smooth_step(0.25, 0.5, wide);
  return kNodataBright + (kNodataDark - kNodataBright) * dark;
}

}  // namespace vpe::core
