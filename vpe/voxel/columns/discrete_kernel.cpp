#include "vpe/voxel/columns/discrete.h"

#include <algorithm>
#include <cmath>

// One binary for every x86-64: this file is compiled once for each of these (the last is the baseline).
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/columns/discrete_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/discrete_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

template <RowKind kKind, bool kBlends>
void walk_discretely_as(const HeightGridFrame& f, HeightGridSource& source, const ColumnCamera& camera,
                        const glm::dvec3& up, const Rows& rows, double blend_from_m, ColumnGroup& group) {
  DiscretePaths paths;
  find_discrete_paths(f, camera, group, paths);
  for (int kind = 0; kind < 4; ++kind) {
    float low = static_cast<float>(f.intervals);
    float high = 0;
    bool is_crossed = false;
    for (int lane = 0; lane < kMaxLanes; ++lane) {
      if (paths.affine.kind[lane] != kind) continue;
      is_crossed = true;
      low = std::min(low, paths.first[lane]);
      high = std::max(high, paths.last[lane]);
    }
    if (!is_crossed) continue;
    const HeightGridLines<float>& lines = source.lines(static_cast<LineFamily>(kind / 2));
    find_bases(f, lines.reference, camera, up, paths.affine);
    DiscreteWalk<kKind, kBlends> walk(lines, f.intervals, paths, kind, camera, rows, blend_from_m, group);
    const bool is_outward_up = (kind & 1) != 0;
    walk.run(static_cast<int>(is_outward_up ? low : high), static_cast<int>(is_outward_up ? high : low));
    walk.store();
  }
}

template <RowKind kKind>
void walk_discretely(const HeightGridFrame& f, HeightGridSource& source, const ColumnCamera& camera,
                     const glm::dvec3& up, const Rows& rows, double blend_from_m, ColumnGroup& group) {
  if (blend_from_m > 0) {
    walk_discretely_as<kKind, true>(f, source, camera, up, rows, blend_from_m, group);
  } else {
    walk_discretely_as<kKind, false>(f, source, camera, up, rows, 0, group);
  }
}

void walk_grid_discretely_kernel(const HeightGridFrame& f, HeightGridSource& source, const ColumnCamera& camera,
                                 const glm::dvec3& up, const Rows& rows, double blend_from_m,
                                 ColumnGroup& group) {
  switch (rows.kind) {
    case RowKind::kEven:
      return walk_discretely<RowKind::kEven>(f, source, camera, up, rows, blend_from_m, group);
    case RowKind::kTable:
      return walk_discretely<RowKind::kTable>(f, source, camera, up, rows, blend_from_m, group);
    case RowKind::kSector:
      return walk_discretely<RowKind::kSector>(f, source, camera, up, rows, blend_from_m, group);
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::voxel {

HWY_EXPORT(walk_grid_discretely_kernel);

void walk_grid_discretely(const HeightGridFrame& frame, HeightGridSource& source, const ColumnCamera& camera,
                          const glm::dvec3& up, const Rows& rows, double blend_from_m, ColumnGroup& group) {
  HWY_DYNAMIC_DISPATCH(walk_grid_discretely_kernel)(frame, source, camera, up, rows, blend_from_m, group);
}

}  // namespace vpe::voxel
#endif
