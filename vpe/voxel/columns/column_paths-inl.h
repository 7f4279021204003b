// Computes the straight paths of a group's columns through a height grid.
//
// Part of column_kernel.cpp and discrete_kernel.cpp: the first step of walk_grid(), before column_steps-inl.h.
#if defined(VPE_VOXEL_COLUMN_PATHS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_PATHS_INL_H_
#undef VPE_VOXEL_COLUMN_PATHS_INL_H_
#else
#define VPE_VOXEL_COLUMN_PATHS_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "vpe/voxel/columns/columns.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Lanes that a group can have here; paths of the others are not computed.
constexpr int kPathLanes = static_cast<int>(hn::MaxLanes(hn::CappedTag<float, kMaxLanes>()));

// Holds the path of each lane through a height grid. Position, sigma, z and w R^2 / |E| are affine in the line
// number k: value = value0 + value1 k.
struct Paths {
  alignas(64) double position0[kMaxLanes];
  alignas(64) double position1[kMaxLanes];  // in [0, 1]
  alignas(64) double sigma0[kMaxLanes];
  alignas(64) double sigma1[kMaxLanes];
  alignas(64) double base0[kMaxLanes];
  alignas(64) double base1[kMaxLanes];
  alignas(64) double depth0[kMaxLanes];
  alignas(64) double depth1[kMaxLanes];
  alignas(64) double x0[kMaxLanes];  // (x, y) = (x0 + xk k, y0 + yk k)
  alignas(64) double xk[kMaxLanes];
  alignas(64) double y0[kMaxLanes];
  alignas(64) double yk[kMaxLanes];
  alignas(64) double from[kMaxLanes];  // lines at which the path is inside the grid
  alignas(64) double to[kMaxLanes];
  alignas(64) double kind[kMaxLanes];  // 2 * family + (1 if k grows outward); -1: outside the grid
};

// Divisors have at least this magnitude.
constexpr double kTiny = 1e-290;
constexpr double kHuge = 1e30;

inline double away_from_zero(double x) { return std::abs(x) < kTiny ? (x < 0 ? -kTiny : kTiny) : x; }

// Clips [from, to] to where 0 <= p + q k <= n.
inline void cut(double p, double q, double n, double& from, double& to) {
  const double inverse = 1.0 / away_from_zero(q);
  const double a = -p * inverse;
  const double b = (n - p) * inverse;
  from = std::max(from, std::min(a, b));
  to = std::min(to, std::max(a, b));
}

// The same for vectors.
using PathTag = hn::CappedTag<double, kMaxLanes / 2>;
using PathVec = hn::Vec<PathTag>;

inline PathVec away_from_zero(PathVec x) {
  const PathTag d;
  const auto tiny = hn::Set(d, kTiny);
  const auto least = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Neg(tiny), tiny);
  return hn::IfThenElse(hn::Lt(hn::Abs(x), tiny), least, x);
}

inline void cut(PathVec p, PathVec q, PathVec n, PathVec& from, PathVec& to) {
  const PathTag d;
  const PathVec inverse = hn::Div(hn::Set(d, 1.0), away_from_zero(q));
  const PathVec a = hn::Mul(hn::Neg(p), inverse);
  const PathVec b = hn::Mul(hn::Sub(n, p), inverse);
  from = hn::Max(from, hn::Min(a, b));
  to = hn::Min(to, hn::Max(a, b));
}

// Sums and products are rounded one by one, so that paths have the same bits for all instruction sets.
inline void find_paths(const HeightGridFrame& f, const ColumnCamera& camera, const ColumnGroup& group,
                       Paths& out) {
  const PathTag d;
  const auto set = [&](double x) { return hn::Set(d, x); };
  const PathVec zero = hn::Zero(d);
  const PathVec one = set(1.0);
  const PathVec scale = set(camera.radius_m * camera.radius_m / camera.distance_m);
  const PathVec n = set(f.intervals);
  const PathVec f_u0 = set(f.u0);
  const PathVec f_v0 = set(f.v0);
  const PathVec f_du = set(f.du);
  const PathVec f_dv = set(f.dv);
  std::fill(out.kind + kPathLanes, out.kind + kMaxLanes, -1.0);
  alignas(64) double unresolved[kMaxLanes];
  for (int lane = 0; lane < kPathLanes; ++lane)
    unresolved[lane] = group.row[lane] < std::min(group.row_end[lane], group.row_stop[lane]) ? 1.0 : 0.0;
  for (int lane = 0; lane < kPathLanes; lane += static_cast<int>(hn::Lanes(d))) {
    const PathVec ax = hn::Load(d, group.azimuth[0] + lane);
    const PathVec ay = hn::Load(d, group.azimuth[1] + lane);
    const PathVec az = hn::Load(d, group.azimuth[2] + lane);
    const PathVec n0 = hn::Load(d, group.normal[0] + lane);
    const PathVec n1 = hn::Load(d, group.normal[1] + lane);
    const PathVec nx = hn::Mul(n0, f_du);
    const PathVec ny = hn::Mul(n1, f_dv);
    const PathVec nc =
        hn::Add(hn::Add(hn::Mul(n0, f_u0), hn::Mul(n1, f_v0)), hn::Load(d, group.normal[2] + lane));
    // x = x0 + xk k, y = y0 + yk k; outward is where the cross product p' x p points along the normal.
    const auto diagonal = hn::Ge(hn::Mul(nx, ny), zero);
    const auto wide = hn::Le(hn::Abs(nx), hn::Abs(ny));
    const auto columns = hn::AndNot(diagonal, wide);
    const auto rows = hn::Not(hn::Or(diagonal, wide));
    const PathVec below =
        away_from_zero(hn::IfThenElse(diagonal, hn::Add(nx, ny), hn::IfThenElse(wide, ny, nx)));
    const PathVec first = hn::Div(hn::Neg(nc), below);
    const PathVec m = hn::Div(hn::IfThenElse(diagonal, ny, hn::Neg(hn::IfThenElse(wide, nx, ny))), below);
    const PathVec x0 = hn::IfThenElse(columns, zero, first);
    const PathVec xk = hn::IfThenElse(columns, one, m);
    const PathVec y0 = hn::IfThenElse(rows, zero, first);
    const PathVec yk = hn::IfThenElse(diagonal, hn::Sub(m, one), hn::IfThenElse(wide, m, one));
    const auto grows = hn::Or(hn::And(rows, hn::Gt(below, zero)), hn::AndNot(rows, hn::Lt(below, zero)));
    const PathVec u = hn::Add(f_u0, hn::Mul(f_du, x0));
    const PathVec v = hn::Add(f_v0, hn::Mul(f_dv, y0));
    const PathVec s0 = hn::Add(hn::Add(hn::Mul(ax, u), hn::Mul(ay, v)), az);
    const PathVec s1 = hn::Add(hn::Mul(ax, hn::Mul(f_du, xk)), hn::Mul(ay, hn::Mul(f_dv, yk)));
    PathVec from = set(-kHuge);
    PathVec to = set(kHuge);
    cut(x0, xk, n, from, to);
    cut(y0, yk, n, from, to);
    // sigma is positive in front of the camera. It is constant along paths that point straight up, which occur
    // on other faces below a camera exactly over the middle of a face.
    const PathVec front = hn::Div(hn::Neg(s0), away_from_zero(s1));
    const auto rises = hn::Gt(s1, zero);
    const auto falls = hn::Lt(s1, zero);
    const auto behind = hn::Not(hn::Or(hn::Or(rises, falls), hn::Gt(s0, zero)));
    from = hn::IfThenElse(rises, hn::Max(from, front), from);
    to = hn::IfThenElse(falls, hn::Min(to, front), to);
    to = hn::IfThenElse(behind, from, to);
    const auto inside = hn::And(hn::Lt(from, to), hn::Gt(hn::Load(d, unresolved + lane), zero));
    hn::Store(hn::IfThenElse(columns, y0, x0), d, out.position0 + lane);
    hn::Store(m, d, out.position1 + lane);
    hn::Store(hn::Mul(s0, scale), d, out.sigma0 + lane);
    hn::Store(hn::Mul(s1, scale), d, out.sigma1 + lane);
    hn::Store(x0, d, out.x0 + lane);
    hn::Store(xk, d, out.xk + lane);
    hn::Store(y0, d, out.y0 + lane);
    hn::Store(yk, d, out.yk + lane);
    hn::Store(from, d, out.from + lane);
    hn::Store(to, d, out.to + lane);
    const PathVec family = hn::IfThenElse(diagonal, set(4.0), hn::IfThenElse(wide, zero, set(2.0)));
    const PathVec kind = hn::Add(family, hn::IfThenElse(grows, one, zero));
    hn::Store(hn::IfThenElse(inside, kind, set(-1.0)), d, out.kind + lane);
  }
}

// Computes heights along the paths relative to the reference plane of their posts.
void find_bases(const HeightGridFrame& f, const DepthPlane& plane, const ColumnCamera& camera,
                const glm::dvec3& up, Paths& out) {
  const double scale = camera.radius_m * camera.radius_m / camera.distance_m;
  for (int lane = 0; lane < kPathLanes; ++lane) {
    const double x0 = out.x0[lane];
    const double xk = out.xk[lane];
    const double y0 = out.y0[lane];
    const double yk = out.yk[lane];
    const double w = plane.w0 + plane.wx * x0 + plane.wy * y0;
    const double wk = plane.wx * xk + plane.wy * yk;
    const double along = up.x * (f.u0 + f.du * x0) + up.y * (f.v0 + f.dv * y0) + up.z;
    out.base0[lane] = (along - camera.distance_m * w) * scale;
    out.base1[lane] = (up.x * f.du * xk + up.y * f.dv * yk - camera.distance_m * wk) * scale;
    out.depth0[lane] = w * scale;
    out.depth1[lane] = wk * scale;
  }
}

// Holds the camera's foot, the point of the ground below the camera, in the coordinates of a grid.
struct Foot {
  bool inside = false;  // the foot lies in the hemisphere of this face
  double x = 0;
  double y = 0;
  double depth = 0;  // w of the reference surface there

  // Returns the line number of the foot in a family.
  double on(LineFamily family) const {
    return family == LineFamily::kColumns ? x : (family == LineFamily::kRows ? y : x - y);
  }
  // Returns the height of the foot in the form of a post, H.
  double height(const DepthPlane& plane, const ColumnCamera& camera) const {
    return (plane.w0 + plane.wx * x + plane.wy * y - depth) * camera.radius_m * camera.radius_m;
  }
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
