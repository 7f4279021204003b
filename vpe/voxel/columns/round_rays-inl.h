// The rays of neighbouring pixels of a round image, as FacetRefiner (facet_refiner-inl.h) takes them.
//
// Part of round_refine_kernel.cpp.
#if defined(VPE_VOXEL_ROUND_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_ROUND_RAYS_INL_H_
#undef VPE_VOXEL_ROUND_RAYS_INL_H_
#else
#define VPE_VOXEL_ROUND_RAYS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <glm/vec4.hpp>

#include "vpe/voxel/columns/grid_facets-inl.h"
#include "vpe/voxel/columns/round_refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Holds one ray for each lane of D.
template <class D>
class RoundRays {
 public:
  using T = hn::TFromD<D>;
  using Source = RoundRow;

  explicit RoundRays(const RoundRow& row) : row_(row) {}

  // Takes the rays of pixels, one for each lane, which must outlive their use.
  void take(const int* pixels) { pixels_ = pixels; }

  // Returns the direction of a pixel's ray, of unit length.
  glm::dvec3 direction(int pixel) const { return row_.direction(pixel); }

  // Prepares on_grid() after a grid was selected.
  void enter(const GridFacets<D>& grid) {
    right_ = grid.on_grid(row_.right);
    forward_ = grid.on_grid(row_.forward);
    up_ = grid.on_grid(row_.up);
  }
  // Returns the lanes' directions in the terms of the grid that was entered.
  OnGrid<D> on_grid() const {
    constexpr std::size_t kRoom = 64 / sizeof(T);
    alignas(64) T x[kRoom];
    alignas(64) T y[kRoom];
    alignas(64) T z[kRoom];
    alignas(64) T below[kRoom];
    const D d;
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      const int k = pixels_[lane];
      const glm::dvec4 ray = row_.sine[k] * right_ + row_.cosine[k] * forward_ + up_;
      x[lane] = static_cast<T>(ray.x);
      y[lane] = static_cast<T>(ray.y);
      z[lane] = static_cast<T>(ray.z);
      below[lane] = static_cast<T>(ray.w);
    }
    return {hn::Load(d, x), hn::Load(d, y), hn::Load(d, z), hn::Load(d, below)};
  }

 private:
  const RoundRow& row_;
  const int* pixels_ = nullptr;
  glm::dvec4 right_{}, forward_{}, up_{};
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
