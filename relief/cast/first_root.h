// The first root of a function of one variable with bounds of its slope.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "relief/field/interval_algebra.h"

namespace relief {

inline constexpr double kNoRoot = std::numeric_limits<double>::infinity();

// Returns the smallest t in [0, 1] at which the parabola through (0, f0), (1/2, f_mid), (1, f1) is 0, else kNoRoot. A
// change of sign always has a root.
inline double first_parabola_root(double f0, double f_mid, double f1) {
  if (f0 == 0) return 0;
  const double a = 2 * (f0 - 2 * f_mid + f1);
  const double b = 4 * f_mid - 3 * f0 - f1;
  const bool changes_sign = (f0 > 0) != (f1 > 0) || f1 == 0;
  const double discriminant = b * b - 4 * a * f0;
  if (!changes_sign) {
    // Two roots: towards 0 at first, and turned back before the end.
    if (f0 > 0 ? !(b < 0 && a > 0 && b + 2 * a > 0) : !(b > 0 && a < 0 && b + 2 * a < 0)) return kNoRoot;
    if (discriminant < 0) return kNoRoot;
  }
  const double root = std::sqrt(std::max(discriminant, 0.0));
  // The two roots are twice / (2 a) and 2 f0 / twice, without cancellation.
  const double twice = b > 0 ? -(b + root) : root - b;
  const double t0 = 2 * f0 / twice;
  const double t1 = twice / (2 * a);
  const bool is_in0 = t0 >= 0 && t0 <= 1;
  const bool is_in1 = t1 >= 0 && t1 <= 1;
  if (is_in0 && is_in1) return std::min(t0, t1);
  if (is_in0) return t0;
  if (is_in1) return t1;
  if (!changes_sign) return kNoRoot;
  // Rounding has put the root beyond an end, or the parabola is flat.
  return std::abs(f0) < std::abs(f1) ? 0 : 1;
}

// Returns a root in [a, b] of a function that changes its sign there: Newton's steps with `f.derivative(s)` from the
// chord, halving where a step leaves the bracket or is slow.
template <class Function>
double bracketed_root(const Function& f, double a, double b, double fa, double fb) {
  double s = a + (b - a) * (fa / (fa - fb));
  for (int step = 0; step < 100; ++step) {
    if (!(s > a && s < b)) s = 0.5 * (a + b);
    const double value = f.value(s);
    if (value == 0 || !(s > a && s < b)) return s;
    const double before = b - a;
    if ((value > 0) == (fa > 0)) {
      a = s;
      fa = value;
    } else {
      b = s;
      fb = value;
    }
    if (b - a <= 4e-16 * std::max(std::abs(a), std::abs(b))) break;
    const double next = s - value / f.derivative(s);
    if (std::abs(next - s) <= 2e-16 * std::abs(s)) return next > a && next < b ? next : s;
    // Newton's steps stay on one side of a curve: every fourth one halves what is left.
    s = step % 4 == 3 && b - a > 0.5 * before ? 0.5 * (a + b) : next;
  }
  return std::abs(fa) < std::abs(fb) ? a : b;
}

// Returns the first root in [a, b], else kNoRoot. `f.value(s)` is the function, `f.derivative(s)` its slope, and
// `f.slope(a, b)` an interval that holds its slopes from a to b. A part is left out only where the slope shows that it has no root;
// rounding of the values decides where the function only touches 0.
template <class Function>
double first_root(const Function& f, double a, double b) {
  struct Bracket {
    double a, b, fa, fb;
  };
  constexpr std::size_t kDepth = 128;
  std::array<Bracket, kDepth> waiting;
  std::size_t count = 0;
  waiting[count++] = {a, b, f.value(a), f.value(b)};
  while (count > 0) {
    const Bracket bracket = waiting[--count];
    if (bracket.fa == 0) return bracket.a;
    const bool changes_sign = (bracket.fa > 0) != (bracket.fb > 0) || bracket.fb == 0;
    const Interval slope = f.slope(bracket.a, bracket.b);
    if (slope.low > 0 || slope.high < 0) {
      if (changes_sign) return bracketed_root(f, bracket.a, bracket.b, bracket.fa, bracket.fb);
      continue;
    }
    const double length = bracket.b - bracket.a;
    if (!changes_sign) {
      // Between the lines of least and greatest slope through both ends the function is at least this far from 0.
      const double turn = bracket.fa > 0 ? 1 : -1;
      const double down = turn > 0 ? slope.low : -slope.high;
      const double up = turn > 0 ? slope.high : -slope.low;
      const double fa = turn * bracket.fa;
      const double fb = turn * bracket.fb;
      if (!(up > down) || fa * up - fb * down + down * up * length > 0) continue;
    }
    const double m = 0.5 * (bracket.a + bracket.b);
    if (count + 2 > kDepth || length <= 4e-16 * std::max(std::abs(bracket.a), std::abs(bracket.b)) ||
        !(m > bracket.a) || !(m < bracket.b)) {
      if (changes_sign) return bracketed_root(f, bracket.a, bracket.b, bracket.fa, bracket.fb);
      continue;
    }
    const double fm = f.value(m);
    waiting[count++] = {m, bracket.b, fm, bracket.fb};
    waiting[count++] = {bracket.a, m, bracket.fa, fm};
  }
  return kNoRoot;
}

}  // namespace relief
