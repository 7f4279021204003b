#include <vector>

#include "vpe/voxel/columns/refine.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/columns/refine_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/nearest_rays-inl.h"
#include "vpe/voxel/columns/refine_hints-inl.h"
#include "vpe/voxel/columns/row_pixels-inl.h"

#if HWY_ONCE
namespace vpe::voxel {

HWY_EXPORT(refine_row_kernel);
HWY_EXPORT(hints_from_row_kernel);
HWY_EXPORT(hints_from_columns_kernel);
HWY_EXPORT(nearest_in_columns_kernel);

void refine_row(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
                FacetSource& exact_source, float* range, std::vector<int>& unresolved) {
  HWY_DYNAMIC_DISPATCH(refine_row_kernel)(row, a, b, share, source, exact_source, range, unresolved);
}
void hints_from_row(const float* samples, int sample_count, double first, double step, int count, float* a,
                    float* b, float* share) {
  HWY_DYNAMIC_DISPATCH(hints_from_row_kernel)(samples, sample_count, first, step, count, a, b, share);
}
void hints_from_columns(const float* samples, int lines, const float* scale, const float* shift, float y,
                        int count, float* a, float* b, float* share) {
  HWY_DYNAMIC_DISPATCH(hints_from_columns_kernel)(samples, lines, scale, shift, y, count, a, b, share);
}
void nearest_in_columns(int lines, const double* maps, double s, double first_line, double per_spacing,
                        int count, std::int32_t* index) {
  HWY_DYNAMIC_DISPATCH(nearest_in_columns_kernel)(lines, maps, s, first_line, per_spacing, count, index);
}

}  // namespace vpe::voxel
#endif
