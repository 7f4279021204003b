// Computes the paths of a group's columns through a height grid, in fixed point along the lines of their major axis.
//
// Part of discrete_kernel.cpp: the first step of walk_grid_discretely().
#if defined(VPE_VOXEL_DISCRETE_PATHS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_DISCRETE_PATHS_INL_H_
#undef VPE_VOXEL_DISCRETE_PATHS_INL_H_
#else
#define VPE_VOXEL_DISCRETE_PATHS_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vpe/voxel/columns/column_paths-inl.h"
#include "vpe/voxel/columns/discrete.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

// Holds what Paths lacks: positions in fixed point, and the lines on which the path is inside the grid.
struct DiscretePaths {
  Paths affine;
  alignas(
      64) std::int32_t position0[kMaxLanes];  // at line 0, half a cell added, so that whole numbers are posts
  alignas(64) std::int32_t position1[kMaxLanes];  // per line, at most one cell
  alignas(64) float first[kMaxLanes];             // whole numbers; last < first: the path has no line here
  alignas(64) float last[kMaxLanes];
};

// Finds the paths of the columns that have rows left. Kinds are 2 * family + (1 if lines rise outward), or -1.
void find_discrete_paths(const HeightGridFrame& f, const ColumnCamera& camera, const ColumnGroup& group,
                         DiscretePaths& out) {
  // A line at the border of two grids belongs to both, so that rounding leaves none out.
  constexpr double kBorder = 1e-6;
  const double scale = camera.radius_m * camera.radius_m / camera.distance_m;
  const double one = std::ldexp(1.0, kDiscreteFraction);
  const double n = f.intervals;
  for (int lane = 0; lane < kMaxLanes; ++lane) {
    const double nx = group.normal[0][lane] * f.du;
    const double ny = group.normal[1][lane] * f.dv;
    const double nc = group.normal[0][lane] * f.u0 + group.normal[1][lane] * f.v0 + group.normal[2][lane];
    const bool columns = std::abs(nx) <= std::abs(ny);
    const double below = away_from_zero(columns ? ny : nx);
    const double at_zero = -nc / below;
    const double per_line = -(columns ? nx : ny) / below;
    Paths& path = out.affine;
    path.x0[lane] = columns ? 0.0 : at_zero;
    path.xk[lane] = columns ? 1.0 : per_line;
    path.y0[lane] = columns ? at_zero : 0.0;
    path.yk[lane] = columns ? per_line : 1.0;
    const auto along = [&](double u, double v) {
      return group.azimuth[0][lane] * u + group.azimuth[1][lane] * v;
    };
    const double s0 = along(f.u0 + f.du * path.x0[lane], f.v0 + f.dv * path.y0[lane]) + group.azimuth[2][lane];
    const double s1 = along(f.du * path.xk[lane], f.dv * path.yk[lane]);
    path.sigma0[lane] = s0 * scale;
    path.sigma1[lane] = s1 * scale;
    double from = 0;
    double to = n;
    cut(at_zero + kBorder, per_line, n + 2 * kBorder, from, to);
    // In front of the camera sigma is positive.
    if (s1 > 0) {
      from = std::max(from, -s0 / away_from_zero(s1));
    } else if (s1 < 0) {
      to = std::min(to, -s0 / away_from_zero(s1));
    } else if (!(s0 > 0)) {
      to = -1;
    }
    const bool has_rows = group.row[lane] < std::min(group.row_end[lane], group.row_stop[lane]);
    const bool is_inside = has_rows && std::ceil(from) <= std::floor(to);
    out.first[lane] = is_inside ? static_cast<float>(std::ceil(from)) : 1.0F;
    out.last[lane] = is_inside ? static_cast<float>(std::floor(to)) : 0.0F;
    out.position0[lane] = is_inside ? static_cast<std::int32_t>(std::lrint((at_zero + 0.5) * one)) : 0;
    out.position1[lane] = is_inside ? static_cast<std::int32_t>(std::lrint(per_line * one)) : 0;
    const bool grows = columns ? below < 0 : below > 0;
    path.kind[lane] = is_inside ? (columns ? 0.0 : 2.0) + (grows ? 1.0 : 0.0) : -1.0;
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
