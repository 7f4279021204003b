// A smooth patch over one cell of posts, and where a ray meets it first.
//
// Stage of the pipeline (vpe/voxel/smooth/smooth_caster.h): the last step of a ray. Coordinates (u, v) run from 0 to 1 over
// the cell. Everything is a pure function of values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vpe::voxel {

// Describes the ground at a post, in metres: height, slopes and mixed second derivative for each cell.
struct PatchNode {
  double h = 0;
  double hu = 0;
  double hv = 0;
  double huv = 0;
};

// Holds a polynomial of third degree (bicubic) or first degree (bilinear) in each coordinate.
struct SmoothPatch {
  // coefficient[4 b + a] belongs to u^a v^b: sums over v go on side by side for all powers of u.
  std::array<double, 16> coefficient{};
  bool is_bicubic = true;
  double highest = 0;  // bound of the height over the cell
  // Bounds of the second derivatives over the cell.
  double uu = 0;
  double uv = 0;
  double vv = 0;
  // Bounds of the first ones.
  double u_slope = 0;
  double v_slope = 0;

  struct Value {
    double h = 0;
    double hu = 0;
    double hv = 0;
  };
  Value at(double u, double v) const {
    const auto& c = coefficient;
    if (!is_bicubic) {
      const double low = c[0] + u * c[1];
      const double rise = c[4] + u * c[5];
      return {low + v * rise, c[1] + v * c[5], rise};
    }
    std::array<double, 4> value;
    std::array<double, 4> slope;
    for (std::size_t a = 0; a < 4; ++a) {
      value[a] = c[a] + v * (c[4 + a] + v * (c[8 + a] + v * c[12 + a]));
      slope[a] = c[4 + a] + v * (2 * c[8 + a] + 3 * v * c[12 + a]);
    }
    return {value[0] + u * (value[1] + u * (value[2] + u * value[3])),
            value[1] + u * (2 * value[2] + 3 * u * value[3]),
            slope[0] + u * (slope[1] + u * (slope[2] + u * slope[3]))};
  }
};

// Make patches from the nodes at (0, 0), (1, 0), (0, 1), (1, 1). The bilinear one takes heights alone.
inline SmoothPatch bilinear_patch(double h00, double h10, double h01, double h11) {
  SmoothPatch patch;
  patch.is_bicubic = false;
  auto& c = patch.coefficient;
  c[0] = h00;
  c[1] = h10 - h00;
  c[4] = h01 - h00;
  c[5] = h00 - h10 - h01 + h11;
  patch.highest = std::max(std::max(h00, h10), std::max(h01, h11));
  patch.uv = std::abs(c[5]);
  patch.u_slope = std::max(std::abs(c[1]), std::abs(c[1] + c[5]));
  patch.v_slope = std::max(std::abs(c[4]), std::abs(c[4] + c[5]));
  return patch;
}

inline SmoothPatch bicubic_patch(const PatchNode& n00, const PatchNode& n10, const PatchNode& n01,
                                 const PatchNode& n11) {
  // Rows: value and slope by u at both ends, each as a cubic in v.
  const auto cubic = [](double p, double m, double q, double k) {
    const double rise = q - p;
    return std::array<double, 4>{p, m, 3 * rise - 2 * m - k, m + k - 2 * rise};
  };
  const std::array<double, 4> f0 = cubic(n00.h, n00.hv, n01.h, n01.hv);
  const std::array<double, 4> f1 = cubic(n10.h, n10.hv, n11.h, n11.hv);
  const std::array<double, 4> g0 = cubic(n00.hu, n00.huv, n01.hu, n01.huv);
  const std::array<double, 4> g1 = cubic(n10.hu, n10.huv, n11.hu, n11.huv);
  SmoothPatch patch;
  auto& c = patch.coefficient;
  for (std::size_t b = 0; b < 4; ++b) {
    const double rise = f1[b] - f0[b];
    c[4 * b] = f0[b];
    c[4 * b + 1] = g0[b];
    c[4 * b + 2] = 3 * rise - 2 * g0[b] - g1[b];
    c[4 * b + 3] = g0[b] + g1[b] - 2 * rise;
  }
  // Derivatives lie within differences of the Bezier points.
  std::array<double, 16> p;
  const auto corner = [&p](std::size_t at, const PatchNode& n, double x, double y, std::size_t along,
                           std::size_t up) {
    const double u = x * n.hu / 3;
    const double v = y * n.hv / 3;
    p[at] = n.h;
    p[along] = n.h + u;
    p[up] = n.h + v;
    p[along + up - at] = n.h + u + v + x * y * n.huv / 9;
  };
  corner(0, n00, 1, 1, 4, 1);
  corner(12, n10, -1, 1, 8, 13);
  corner(3, n01, 1, -1, 7, 2);
  corner(15, n11, -1, -1, 11, 14);
  patch.highest = *std::max_element(p.begin(), p.end());
  const auto raise = [](double& most, double value) { most = std::max(most, std::abs(value)); };
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t n = 0; n < 2; ++n) {
      raise(patch.uu, p[4 * n + k] - 2 * p[4 * n + 4 + k] + p[4 * n + 8 + k]);
      raise(patch.vv, p[4 * k + n] - 2 * p[4 * k + n + 1] + p[4 * k + n + 2]);
    }
    for (std::size_t n = 0; n < 3; ++n) {
      raise(patch.u_slope, p[4 * n + 4 + k] - p[4 * n + k]);
      raise(patch.v_slope, p[4 * k + n + 1] - p[4 * k + n]);
      if (k < 3) raise(patch.uv, p[4 * n + k] - p[4 * n + 4 + k] - p[4 * n + k + 1] + p[4 * n + 5 + k]);
    }
  }
  patch.uu *= 6;
  patch.vv *= 6;
  patch.uv *= 9;
  patch.u_slope *= 3;
  patch.v_slope *= 3;
  return patch;
}

// Describes a ray about a place of it, at t = 0, in metres along it: distance from the planet's centre, and place in the
// cell as ratios (u0 + t u1) / (w0 + t w1).
struct RayInCell {
  double rr = 0;      // square of the distance from the centre at t = 0
  double rd = 0;      // half of its derivative there
  double base_m = 0;  // distance from the centre at which heights are 0
  double u0 = 0, u1 = 0;
  double v0 = 0, v1 = 0;
  double w0 = 1, w1 = 0;
};

// Holds the height of a ray over a patch at a place of it, and its derivative.
struct OverPatch {
  double value = 0;
  double slope = 0;
};

inline OverPatch over_patch(const RayInCell& ray, const SmoothPatch& patch, double t) {
  const double per_w = 1 / (ray.w0 + t * ray.w1);
  const double u = (ray.u0 + t * ray.u1) * per_w;
  const double v = (ray.v0 + t * ray.v1) * per_w;
  const double r = std::sqrt(std::max(ray.rr + t * (2 * ray.rd + t), 0.0));
  const SmoothPatch::Value ground = patch.at(u, v);
  const double u_rate = (ray.u1 - u * ray.w1) * per_w;
  const double v_rate = (ray.v1 - v * ray.w1) * per_w;
  const double rise = r > 0 ? (ray.rd + t) / r : 0;
  return {r - ray.base_m - ground.h, rise - (ground.hu * u_rate + ground.hv * v_rate)};
}

// Returns about where the cubic with these values and slopes at 0 and 1 is 0, for values of unlike signs.
inline double cubic_root(double f0, double m0, double f1, double m1) {
  const double rise = f1 - f0;
  const double c2 = 3 * rise - 2 * m0 - m1;
  const double c3 = m0 + m1 - 2 * rise;
  double x = -f0 / rise;
  for (int step = 0; step < 3; ++step) {
    const double slope = m0 + x * (2 * c2 + 3 * x * c3);
    x -= (f0 + x * (m0 + x * (c2 + x * c3))) / slope;
  }
  return x;
}

inline constexpr double kNoMeeting = std::numeric_limits<double>::infinity();

// Returns the first t of [0, length] at which the ray is at or below the patch, else kNoMeeting. No crossing is missed
// but by the rounding of heights: a part is left out only where the bound of the second derivative excludes it. A ray
// that begins below the patch meets it at 0. Parts shorter than `shortest` are not divided.
inline double first_meeting(const RayInCell& ray, const SmoothPatch& patch, double length, double shortest) {
  struct End {
    double t;
    OverPatch g;
  };
  End a{0, over_patch(ray, patch, 0)};
  if (a.g.value <= 0) return 0;
  End b{length, over_patch(ray, patch, length)};

  // Bound of the second derivative along the ray: |h''| of the patch over a path that is straight in the chart but not even,
  // and that of the distance from the centre, which is convex.
  const double wa = ray.w0;
  const double wb = ray.w0 + length * ray.w1;
  const double least_w = std::min(wa, wb);
  // Places turn at rates that are monotone on the way.
  const double per_w2 = 1 / (least_w * least_w);
  const double du = std::abs(ray.u1 * ray.w0 - ray.u0 * ray.w1) * per_w2;
  const double dv = std::abs(ray.v1 * ray.w0 - ray.v0 * ray.w1) * per_w2;
  const double turn = 2 * std::abs(ray.w1) / least_w;
  const double chart_bend = patch.uu * du * du + 2 * patch.uv * du * dv + patch.vv * dv * dv +
                            (patch.u_slope * du + patch.v_slope * dv) * turn;
  // r'' = (r^2 - (r r')^2) / r^3, at most 1 / r.
  const double nearest2 = std::max(ray.rr - ray.rd * ray.rd, 0.0);
  const double rb2 = ray.rr + length * (2 * ray.rd + length);
  const double least2 = ray.rd < 0 && ray.rd + length > 0 ? nearest2 : std::min(ray.rr, rb2);
  const double up_bend = 1 / std::sqrt(std::max(least2, 1e-300));
  const double bend = chart_bend + up_bend;

  // The far halves that wait.
  std::array<End, 64> waiting;
  std::size_t count = 0;
  for (;;) {
    const double l = b.t - a.t;
    bool goes_on = false;
    if (b.g.value > 0) {
      // Above the parabola below the chord, f >= chord - bend / 2 (t - a) (b - t), and above both tangents less the same.
      const double low = std::min(a.g.value, b.g.value) - 0.125 * bend * l * l;
      goes_on = low < 0 && l > shortest;
      if (goes_on) {
        // The slope may show that it is nowhere below the nearer end.
        if (a.g.slope - bend * l >= 0 || b.g.slope + bend * l <= 0) goes_on = false;
      }
      if (!goes_on) {
        if (count == 0) return kNoMeeting;
        a = b;
        b = waiting[--count];
        continue;
      }
    } else {
      // One crossing if the slope keeps its sign.
      const double steepest_up = std::min(a.g.slope, b.g.slope) + bend * l;
      const double from_both = 0.5 * (a.g.slope + b.g.slope + bend * l);
      if (std::min(steepest_up, from_both) < 0 || l <= shortest || count + 1 >= waiting.size()) {
        // Newton's steps within the bracket, from the root of the cubic through both ends.
        double lo = a.t;
        double hi = b.t;
        double t = lo + l * cubic_root(a.g.value, l * a.g.slope, b.g.value, l * b.g.slope);
        for (int step = 0; step < 60; ++step) {
          if (!(t > lo && t < hi)) t = 0.5 * (lo + hi);
          const OverPatch g = over_patch(ray, patch, t);
          (g.value > 0 ? lo : hi) = t;
          if (g.value == 0 || hi - lo <= 0.25 * shortest) break;
          const double next = t - g.value / g.slope;
          // A step is off by half the bend times its square, over the slope.
          const bool is_there = 0.5 * bend * (next - t) * (next - t) <= 0.25 * shortest * std::abs(g.slope);
          t = step % 8 == 7 && !is_there ? 0.5 * (lo + hi) : next;
          if (is_there) break;
        }
        return std::clamp(t, lo, hi);
      }
      goes_on = true;
    }
    if (count + 1 >= waiting.size()) return b.g.value > 0 ? kNoMeeting : b.t;
    const double m = 0.5 * (a.t + b.t);
    const End middle{m, over_patch(ray, patch, m)};
    waiting[count++] = b;
    b = middle;
  }
}

}  // namespace vpe::voxel
