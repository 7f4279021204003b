#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/voxel/columns/columns.h"

// One binary for every x86-64: this file is compiled once for each of these (the last is the baseline).
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/columns/column_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/column_expand-inl.h"
#include "vpe/voxel/columns/column_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, kMaxLanes>;
using DoubleTag = hn::CappedTag<double, kMaxLanes / 2>;

template <RowKind kKind>
void walk_as(const HeightGridFrame& f, HeightGridSource& source, const ColumnCamera& camera,
             const glm::dvec3& up, const Rows& rows, ColumnGroup& group) {
  Paths paths;
  find_paths(f, camera, group, paths);
  Foot foot;
  if (up.z > 0) {
    foot.inside = true;
    foot.depth = 1.0 / (up.z * camera.ground_m);
    foot.x = (up.x / up.z - f.u0) / f.du;
    foot.y = (up.y / up.z - f.v0) / f.dv;
  }
  unsigned kinds = 0;
  for (int lane = 0; lane < kPathLanes; ++lane) {
    if (paths.kind[lane] >= 0) kinds |= 1U << static_cast<int>(paths.kind[lane]);
  }
  for (int kind = 0; kind < 2 * kFamilies; ++kind) {
    if (((kinds >> kind) & 1U) == 0) continue;
    const auto family = static_cast<LineFamily>(kind / 2);
    const bool outward_up = (kind & 1) != 0;
    double from = kHuge;
    double to = -kHuge;
    for (int lane = 0; lane < kPathLanes; ++lane) {
      if (paths.kind[lane] != kind) continue;
      from = std::min(from, paths.from[lane]);
      to = std::max(to, paths.to[lane]);
    }
    const int least = family == LineFamily::kDiagonals ? -f.intervals : 0;
    // One line more on either side, so that rounding of the ends leaves out no event.
    const int low = std::clamp(static_cast<int>(std::floor(from - 1e-3)), least, f.intervals);
    const int high = std::clamp(static_cast<int>(std::ceil(to + 1e-3)), least, f.intervals);
    int first = outward_up ? low : high;
    const int last = outward_up ? high : low;
    if (foot.inside) {
      const double at = foot.on(family);
      // Outward all lines lie on one side of the foot's.
      const double nearest = outward_up ? first - at : at - first;
      if (nearest < kExactLines && needs_exact(f, camera)) {
        const double reach = outward_up ? at + kExactLines : at - kExactLines;
        int until = static_cast<int>(outward_up ? std::ceil(reach) : std::floor(reach));
        until = outward_up ? std::min(until, last) : std::max(until, last);
        if (until != first) {
          const HeightGridLines<double>& lines = source.exact_lines(family);
          const DepthPlane& plane = lines.reference;
          find_bases(f, plane, camera, up, paths);
          const double height = foot.height(plane, camera);
          for (int lane0 = 0; lane0 < static_cast<int>(hn::Lanes(FloatTag()));
               lane0 += static_cast<int>(hn::Lanes(DoubleTag()))) {
            HorizonWalk<DoubleTag, kKind> walk(lines, family, f.intervals, paths, kind, lane0, camera, rows,
                                               group);
            if (!walk.any()) continue;
            walk.start_at_foot(at, height);
            walk.run(first, until);
            walk.store();
          }
          first = until;
        }
      }
    }
    if (first == last) continue;
    const HeightGridLines<float>& lines = source.lines(family);
    find_bases(f, lines.reference, camera, up, paths);
    const bool begins = foot.inside && first == (outward_up ? low : high);
    HorizonWalk<FloatTag, kKind> walk(lines, family, f.intervals, paths, kind, 0, camera, rows, group);
    if (!walk.any()) continue;
    if (begins)
      walk.start_at_foot(static_cast<float>(foot.on(family)),
                         static_cast<float>(foot.height(lines.reference, camera)));
    walk.run(first, last);
    walk.store();
  }
}

void walk_grid_kernel(const HeightGridFrame& f, HeightGridSource& source, const ColumnCamera& camera,
                      const glm::dvec3& up, const Rows& rows, ColumnGroup& group) {
  switch (rows.kind) {
    case RowKind::kEven: return walk_as<RowKind::kEven>(f, source, camera, up, rows, group);
    case RowKind::kTable: return walk_as<RowKind::kTable>(f, source, camera, up, rows, group);
    case RowKind::kSector: return walk_as<RowKind::kSector>(f, source, camera, up, rows, group);
  }
}

int column_lanes_kernel() { return static_cast<int>(hn::Lanes(FloatTag())); }
int value_step_kernel() { return kValueStep; }
const char* column_target_kernel() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::voxel {

bool needs_exact(const HeightGridFrame& frame, const ColumnCamera& camera) {
  return camera.distance_m - camera.ground_m < kExactLines * std::max(frame.du, frame.dv) * camera.radius_m;
}

HWY_EXPORT(walk_grid_kernel);
HWY_EXPORT(update_least_slope_kernel);
HWY_EXPORT(expand_rows_kernel);
HWY_EXPORT(copy_rows_kernel);
HWY_EXPORT(column_lanes_kernel);
HWY_EXPORT(value_step_kernel);
HWY_EXPORT(column_target_kernel);

void walk_grid(const HeightGridFrame& frame, HeightGridSource& source, const ColumnCamera& camera,
               const glm::dvec3& up, const Rows& rows, ColumnGroup& group) {
  HWY_DYNAMIC_DISPATCH(walk_grid_kernel)(frame, source, camera, up, rows, group);
}
void update_least_slope(const Rows& rows, ColumnGroup& group) {
  HWY_DYNAMIC_DISPATCH(update_least_slope_kernel)(rows, group);
}
void expand_rows(const Rows& rows, ColumnGroup& group, int first, int last, float* out, std::ptrdiff_t stride) {
  HWY_DYNAMIC_DISPATCH(expand_rows_kernel)(rows, group, first, last, out, stride);
}
void copy_rows(const float* from, std::ptrdiff_t from_stride, float* to, std::ptrdiff_t to_stride, int columns,
               int rows, bool stream) {
  HWY_DYNAMIC_DISPATCH(copy_rows_kernel)(from, from_stride, to, to_stride, columns, rows, stream);
}
int column_lanes() { return HWY_DYNAMIC_DISPATCH(column_lanes_kernel)(); }
int value_step() { return HWY_DYNAMIC_DISPATCH(value_step_kernel)(); }
const char* column_target() { return HWY_DYNAMIC_DISPATCH(column_target_kernel)(); }

}  // namespace vpe::voxel
#endif
