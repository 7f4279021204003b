// The rays of a block of pixels of a perspective image, as FacetRefiner (facet_refiner-inl.h) takes them.
//
// Part of refine_kernel.cpp.
#if defined(VPE_VOXEL_BLOCK_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_BLOCK_RAYS_INL_H_
#undef VPE_VOXEL_BLOCK_RAYS_INL_H_
#else
#define VPE_VOXEL_BLOCK_RAYS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "vpe/voxel/columns/grid_facets-inl.h"
#include "vpe/voxel/columns/refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Holds one ray for each lane of D. In float a block must be short beside its distance from the camera: rays are sums of the first
// one and multiples of the steps. Pixels are numbered row by row, kRayBlockColumns to a row.
template <class D>
class BlockRays {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using Source = RayBlock;

  explicit BlockRays(const RayBlock& block) : block_(block) {
    const V zero = hn::Zero(D());
    column_ = row_ = per_length_ = zero;
    first_ = step_ = down_ = {zero, zero, zero, zero};
    first_square_ = set(glm::dot(block.first, block.first));
    step_square_ = set(glm::dot(block.step, block.step));
    down_square_ = set(glm::dot(block.down, block.down));
    first_step_ = set(2 * glm::dot(block.first, block.step));
    first_down_ = set(2 * glm::dot(block.first, block.down));
    step_down_ = set(2 * glm::dot(block.step, block.down));
  }

  // Takes the rays of pixels, one for each lane.
  void take(const int* pixels) {
    alignas(64) T columns[64 / sizeof(T)];
    alignas(64) T rows[64 / sizeof(T)];
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) {
      columns[k] = static_cast<T>(pixels[k] % kRayBlockColumns);
      rows[k] = static_cast<T>(pixels[k] / kRayBlockColumns);
    }
    take(hn::Load(D(), columns), hn::Load(D(), rows));
  }
  // Takes the rays of pixels k, k + 1, ... of one row.
  void take_from(int k) {
    take(hn::Iota(D(), static_cast<T>(k % kRayBlockColumns)),
         hn::Set(D(), static_cast<T>(k / kRayBlockColumns)));
  }

  // Returns the direction of a pixel's ray, of unit length.
  glm::dvec3 direction(int pixel) const {
    return glm::normalize(block_.ray(pixel / kRayBlockColumns, pixel % kRayBlockColumns));
  }

  // Prepares on_grid() after a grid was selected.
  void enter(const GridFacets<D>& grid) {
    const auto enter = [&](const glm::dvec3& v) {
      const glm::dvec4 on = grid.on_grid(v);
      return OnGrid<D>{set(on.x), set(on.y), set(on.z), set(on.w)};
    };
    first_ = enter(block_.first);
    step_ = enter(block_.step);
    down_ = enter(block_.down);
  }
  // Returns the lanes' directions in the terms of the grid that was entered.
  OnGrid<D> on_grid() const {
    const auto along = [&](V first, V step, V down) {
      return hn::Mul(hn::MulAdd(column_, step, hn::MulAdd(row_, down, first)), per_length_);
    };
    return {along(first_.x, step_.x, down_.x), along(first_.y, step_.y, down_.y),
            along(first_.z, step_.z, down_.z), along(first_.below, step_.below, down_.below)};
  }

 private:
  static V set(double x) { return hn::Set(D(), static_cast<T>(x)); }

  void take(V column, V row) {
    const D d;
    column_ = column;
    row_ = row;
    const V of_row = hn::MulAdd(row, hn::MulAdd(row, down_square_, first_down_), first_square_);
    const V mixed = hn::MulAdd(row, step_down_, first_step_);
    const V square = hn::MulAdd(column, hn::MulAdd(column, step_square_, mixed), of_row);
    per_length_ = hn::Div(hn::Set(d, T(1)), hn::Sqrt(square));
  }

  const RayBlock& block_;
  V first_square_, step_square_, down_square_;
  V first_step_, first_down_, step_down_;  // products, doubled
  V column_, row_;
  V per_length_;
  OnGrid<D> first_, step_, down_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
