// What rises need of a row of posts: series of the angle at the planet's centre. Private to vpe/map/viewshed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "vpe/map/viewshed/rise.h"

namespace vpe::map {

inline constexpr float kMostRiseHeight_m = 1e9F;
inline constexpr float kLeastCentreDistance = 1e-3F;  // of ground, in radii
inline constexpr double kPiSquare = std::numbers::pi * std::numbers::pi;
inline constexpr int kRiseTerms = 8;

using RiseSeries = std::array<float, kRiseTerms>;

// Returns coefficients of the powers of q = a^2 in two series without their pole at a = pi: of 2 tan(a / 2) / a and of
// a / sin(a), each times 1 - q / pi^2. Up to a = pi / 2 the terms left out are below 1e-8.
constexpr RiseSeries without_pole(bool of_tangent) {
  // Absolute values of the Bernoulli numbers B2, B4, ...
  constexpr std::array<double, kRiseTerms> kBernoulli = {1.0 / 6,  1.0 / 30,     1.0 / 42, 1.0 / 30,
                                                         5.0 / 66, 691.0 / 2730, 7.0 / 6,  3617.0 / 510};
  RiseSeries result{};
  double factorial = 1;
  double power = 1;  // of 4
  double before = 0;
  for (int n = 0; n < kRiseTerms; ++n) {
    double coefficient = 1;
    if (of_tangent || n > 0) {
      const int m = of_tangent ? n + 1 : n;  // of the term a^(2 m)
      factorial *= (2.0 * m - 1) * (2.0 * m);
      power *= 4;
      const double b = kBernoulli[static_cast<std::size_t>(m) - 1];
      coefficient = of_tangent ? 4 * (power - 1) * b / factorial : (power - 2) * b / factorial;
    }
    result[static_cast<std::size_t>(n)] = static_cast<float>(coefficient - before / kPiSquare);
    before = coefficient;
  }
  return result;
}

inline constexpr RiseSeries kRiseTangent = without_pole(true);
inline constexpr RiseSeries kRiseSine = without_pole(false);

// Holds the numbers of a view and of a row that its posts share, as floats.
struct RiseRow {
  RiseRow(const RiseView& view, int across)
      : observer_m(static_cast<float>(view.observer_m)),
        across_squared(static_cast<float>(across) * static_cast<float>(across)),
        reach_squared(static_cast<float>(view.reach_squared)) {
    if (std::isinf(view.radius_m)) return;
    radius_m = static_cast<float>(view.radius_m);
    curvature = static_cast<float>(1 / view.radius_m);
    const double angle = view.spacing_m / view.radius_m;
    to_q = static_cast<float>(angle * angle);
    half_spacing_m = static_cast<float>(0.5 * view.spacing_m * angle);
    lowest_m = std::max(-kMostRiseHeight_m, radius_m * (kLeastCentreDistance - 1));
  }

  float observer_m;
  float across_squared;      // posts
  float reach_squared;       // posts
  float radius_m = 0;        // 0: a plane
  float curvature = 0;       // 1 / m
  float to_q = 0;            // square of the angle at the centre of one post
  float half_spacing_m = 0;  // dip of one post, metres
  float lowest_m = -kMostRiseHeight_m;
};

}  // namespace vpe::map
