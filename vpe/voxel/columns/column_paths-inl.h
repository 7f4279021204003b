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

double away_from_zero(double x) { return std::abs(x) < kTiny ? (x < 0 ? -kTiny : kTiny) : x; }

// Clips [from, to] to where 0 <= p + q k <= n.
void cut(double p, double q, double n, double& from, double& to) {
  const double inverse = 1.0 / away_from_zero(q);
  const double a = -p * inverse;
  const double b = (n - p) * inverse;
  from = std::max(from, std::min(a, b));
  to = std::min(to, std::max(a, b));
}

inline void find_paths(const HeightGridFrame& f, const ColumnCamera& camera, const ColumnGroup& group,
                       Paths& out) {
  const double scale = camera.radius_m * camera.radius_m / camera.distance_m;
  const double n = f.intervals;
  std::fill(out.kind + kPathLanes, out.kind + kMaxLanes, -1.0);
  for (int lane = 0; lane < kPathLanes; ++lane) {
    const double ax = group.azimuth[0][lane];
    const double ay = group.azimuth[1][lane];
    const double az = group.azimuth[2][lane];
    const double nx = group.normal[0][lane] * f.du;
    const double ny = group.normal[1][lane] * f.dv;
    const double nc = group.normal[0][lane] * f.u0 + group.normal[1][lane] * f.v0 + group.normal[2][lane];
    // x = x0 + xk k, y = y0 + yk k; outward is where the cross product p' x p points along the normal.
    const bool diagonal = nx * ny >= 0;
    const bool columns = std::abs(nx) <= std::abs(ny);
    const double below = away_from_zero(diagonal ? nx + ny : (columns ? ny : nx));
    const double first = -nc / below;
    const double m = diagonal ? ny / below : (columns ? -nx / below : -ny / below);
    const double x0 = !diagonal && columns ? 0.0 : first;
    const double xk = !diagonal && columns ? 1.0 : m;
    const double y0 = !diagonal && !columns ? 0.0 : first;
    const double yk = diagonal ? m - 1.0 : (columns ? m : 1.0);
    const bool grows = diagonal || columns ? below < 0 : below > 0;
    const double u = f.u0 + f.du * x0;
    const double v = f.v0 + f.dv * y0;
    const double du = f.du * xk;
    const double dv = f.dv * yk;
    const double s0 = ax * u + ay * v + az;
    const double s1 = ax * du + ay * dv;
    double from = -kHuge;
    double to = kHuge;
    cut(x0, xk, n, from, to);
    cut(y0, yk, n, from, to);
    // sigma is positive in front of the camera. It is constant along paths that point straight up, which occur
    // on other faces below a camera exactly over the middle of a face.
    if (s1 > 0) {
      from = std::max(from, -s0 / away_from_zero(s1));
    } else if (s1 < 0) {
      to = std::min(to, -s0 / away_from_zero(s1));
    } else if (!(s0 > 0)) {
      to = from;
    }
    const bool inside = from < to && group.row[lane] < std::min(group.row_end[lane], group.row_stop[lane]);
    out.position0[lane] = diagonal ? x0 : (columns ? y0 : x0);
    out.position1[lane] = m;
    out.sigma0[lane] = s0 * scale;
    out.sigma1[lane] = s1 * scale;
    out.x0[lane] = x0;
    out.xk[lane] = xk;
    out.y0[lane] = y0;
    out.yk[lane] = yk;
    out.from[lane] = from;
    out.to[lane] = to;
    const double family = diagonal ? 2.0 : (columns ? 0.0 : 1.0);
    out.kind[lane] = inside ? 2.0 * family + (grows ? 1.0 : 0.0) : -1.0;
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
