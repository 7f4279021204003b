// The first hit of a ray on a height map over the plane z = 0, found by trying every cell: an oracle for casters.
//
// It shares nothing with the module's own search. The height over a cell's patch is a polynomial of the ray's parameter of
// degree 6 at most. It is sampled at seven points, brought to Bernstein form, and halved by de Casteljau until a change of
// sign is found, all in long double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

#include "relief/field/height_map.h"

namespace relief::brute {

using Real = long double;
inline constexpr std::size_t kTerms = 7;
using Terms = std::array<Real, kTerms>;

// Returns the Bernstein form of the polynomial with these values at n / 6: first Newton's differences, then each product
// of (6 t - k) in Bernstein form.
inline Terms to_bernstein(const Terms& values) {
  Terms divided = values;
  for (std::size_t order = 1; order < kTerms; ++order)
    for (std::size_t n = kTerms - 1; n >= order; --n)
      divided[n] = (divided[n] - divided[n - 1]) / static_cast<Real>(order);
  // Horner's rule; a factor (6 t - k) is -k (1 - t) + (6 - k) t, and a product of degree d becomes one of d + 1.
  Terms form{};
  form[0] = divided[kTerms - 1];
  for (std::size_t k = kTerms - 1; k-- > 0;) {
    const std::size_t degree = kTerms - 1 - k;  // of the new form
    Terms next{};
    for (std::size_t n = 0; n <= degree; ++n) {
      const Real share = static_cast<Real>(n) / static_cast<Real>(degree);
      const Real low = n < degree ? form[n] * -static_cast<Real>(k) * (1 - share) : 0;
      const Real high = n > 0 ? form[n - 1] * (6 - static_cast<Real>(k)) * share : 0;
      next[n] = low + high + divided[k];
    }
    form = next;
  }
  return form;
}

// Returns the first t in [t0, t1] at which the polynomial gets the sign `sign` (1 or -1), else infinity.
inline Real first_of_sign(const Terms& form, int sign, Real t0, Real t1, int depth) {
  if (std::none_of(form.begin(), form.end(), [sign](Real x) { return x * sign > 0; }))
    return std::numeric_limits<Real>::infinity();
  if (form[0] * sign > 0) return t0;
  if (depth == 0) return form[kTerms - 1] * sign > 0 ? t1 : std::numeric_limits<Real>::infinity();
  Terms row = form;
  Terms left{};
  Terms right{};
  for (std::size_t n = 0; n < kTerms; ++n) {
    left[n] = row[0];
    right[kTerms - 1 - n] = row[kTerms - 1 - n];
    for (std::size_t k = 0; k + 1 < kTerms - n; ++k) row[k] = (row[k] + row[k + 1]) / 2;
  }
  const Real mid = (t0 + t1) / 2;
  const Real found = first_of_sign(left, sign, t0, mid, depth - 1);
  return found <= mid ? found : first_of_sign(right, sign, mid, t1, depth - 1);
}

// Returns the s in [0, length] at which the ray from above the ground goes below it, else infinity; with sign -1 the s at
// which a ray from below comes out.
inline double first_hit(const HeightMap& map, const glm::dvec3& from, const glm::dvec3& d, double length,
                        int sign = 1) {
  const MapLayout& layout = map.layout();
  Real best = std::numeric_limits<Real>::infinity();
  for (int j = 0; j + 1 < layout.rows; ++j) {
    for (int i = 0; i + 1 < layout.columns; ++i) {
      Real s0 = 0;
      Real s1 = std::min(static_cast<Real>(length), best);
      const auto clip = [&](double origin, double rate, double low, double high) {
        if (rate == 0) {
          if (origin < low || origin > high) s1 = -1;
          return;
        }
        const Real a = (static_cast<Real>(low) - origin) / rate;
        const Real b = (static_cast<Real>(high) - origin) / rate;
        s0 = std::max(s0, std::min(a, b));
        s1 = std::min(s1, std::max(a, b));
      };
      const double x0 = layout.x0_m + i * layout.dx_m;
      const double y0 = layout.y0_m + j * layout.dy_m;
      clip(from.x, d.x, x0, x0 + layout.dx_m);
      clip(from.y, d.y, y0, y0 + layout.dy_m);
      if (!(s0 < s1)) continue;
      const Patch patch = map.patch(i, j);
      Terms values;
      for (std::size_t n = 0; n < kTerms; ++n) {
        const Real s = s0 + (s1 - s0) * static_cast<Real>(n) / 6;
        const Real u = (from.x + s * d.x - x0) / layout.dx_m;
        const Real v = (from.y + s * d.y - y0) / layout.dy_m;
        const double ground = patch.height_m(static_cast<double>(u), static_cast<double>(v));
        values[n] = sign * (ground - (from.z + s * d.z));
      }
      const Real t = first_of_sign(to_bernstein(values), 1, 0, 1, 50);
      best = std::min(best, s0 + t * (s1 - s0));
    }
  }
  return static_cast<double>(best);
}

}  // namespace relief::brute
