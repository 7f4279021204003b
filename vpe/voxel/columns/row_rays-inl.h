// The rays of neighbouring pixels of a perspective image, as FacetRefiner (facet_refiner-inl.h) takes them.
//
// Part of refine_kernel.cpp.
#if defined(VPE_VOXEL_ROW_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_ROW_RAYS_INL_H_
#undef VPE_VOXEL_ROW_RAYS_INL_H_
#else
#define VPE_VOXEL_ROW_RAYS_INL_H_
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

// Holds one ray for each lane of D. In float a row must be short beside its distance from the camera: rays are sums of the first
// one and multiples of the step.
template <class D>
class RowRays {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using Source = RayRow;

  explicit RowRays(const RayRow& row) : row_(row) {
    const V zero = hn::Zero(D());
    lane_ = per_length_ = zero;
    first_ = step_ = {zero, zero, zero, zero};
    first_square_ = set(glm::dot(row.first, row.first));
    mixed_ = set(2 * glm::dot(row.first, row.step));
    step_square_ = set(glm::dot(row.step, row.step));
  }

  // Takes the rays of pixels, one for each lane.
  void take(const int* pixels) {
    alignas(64) T index[64 / sizeof(T)];
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) index[k] = static_cast<T>(pixels[k]);
    take(hn::Load(D(), index));
  }
  // Takes the rays of pixels k, k + 1, ...
  void take_from(int k) { take(hn::Iota(D(), static_cast<T>(k))); }

  // Returns the direction of a pixel's ray, of unit length.
  glm::dvec3 direction(int pixel) const {
    return glm::normalize(row_.first + static_cast<double>(pixel) * row_.step);
  }

  // Prepares on_grid() after a grid was selected.
  void enter(const GridFacets<D>& grid) {
    const glm::dvec4 first = grid.on_grid(row_.first);
    const glm::dvec4 step = grid.on_grid(row_.step);
    first_ = {set(first.x), set(first.y), set(first.z), set(first.w)};
    step_ = {set(step.x), set(step.y), set(step.z), set(step.w)};
  }
  // Returns the lanes' directions in the terms of the grid that was entered.
  OnGrid<D> on_grid() const {
    const auto along = [&](V first, V step) { return hn::Mul(hn::MulAdd(lane_, step, first), per_length_); };
    return {along(first_.x, step_.x), along(first_.y, step_.y), along(first_.z, step_.z),
            along(first_.below, step_.below)};
  }

 private:
  static V set(double x) { return hn::Set(D(), static_cast<T>(x)); }

  void take(V index) {
    const D d;
    lane_ = index;
    const V square = hn::MulAdd(index, hn::MulAdd(index, step_square_, mixed_), first_square_);
    per_length_ = hn::Div(hn::Set(d, T(1)), hn::Sqrt(square));
  }

  const RayRow& row_;
  V first_square_, mixed_, step_square_;
  V lane_;
  V per_length_;
  OnGrid<D> first_, step_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
