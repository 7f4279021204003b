#include <algorithm>
#include <vector>

#include "vpe/voxel/columns/refine.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/columns/refine_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/block_pixels-inl.h"
#include "vpe/voxel/columns/nearest_rays-inl.h"
#include "vpe/voxel/columns/refine_hints-inl.h"

#if HWY_ONCE
namespace vpe::voxel {

HWY_EXPORT(refine_block_kernel);
HWY_EXPORT(hints_from_row_kernel);
HWY_EXPORT(hints_from_columns_kernel);
HWY_EXPORT(nearest_in_columns_kernel);

namespace {

// Gives hints of one row.
class RowOfHints : public BlockHints {
 public:
  RowOfHints(const float* a, const float* b, const float* share, int count)
      : a_(a), b_(b), share_(share), count_(count) {}
  void get(int /*row*/, float* a, float* b, float* share) override {
    std::copy_n(a_, count_, a);
    std::copy_n(b_, count_, b);
    std::copy_n(share_, count_, share);
  }

 private:
  const float* a_;
  const float* b_;
  const float* share_;
  int count_;
};

}  // namespace

void refine_block(const RayBlock& block, BlockHints& hints, FacetSource& source, FacetSource& exact_source,
                  float* range, std::ptrdiff_t stride, std::vector<UnresolvedPixel>& unresolved) {
  HWY_DYNAMIC_DISPATCH(refine_block_kernel)(block, hints, source, exact_source, range, stride, unresolved);
}
void refine_row(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
                FacetSource& exact_source, float* range, std::vector<int>& unresolved) {
  std::vector<UnresolvedPixel> pixels;
  for (int first = 0; first < row.count; first += kRayBlockColumns) {
    const int count = std::min(kRayBlockColumns, row.count - first);
    RowOfHints hints(a + first, b + first, share + first, count);
    const RayBlock block{
        row.camera_m, row.radius_m, row.first + static_cast<double>(first) * row.step, row.step, {}, count, 1};
    pixels.clear();
    refine_block(block, hints, source, exact_source, range + first, 0, pixels);
    for (const UnresolvedPixel& pixel : pixels) unresolved.push_back(first + pixel.column);
  }
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
