// Finds the samples of a fan about the pixels of a round image.
//
// Part of round_refine_kernel.cpp.
#if defined(VPE_VOXEL_ROUND_HINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_ROUND_HINTS_INL_H_
#undef VPE_VOXEL_ROUND_HINTS_INL_H_
#else
#define VPE_VOXEL_ROUND_HINTS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

#include <algorithm>
#include <glm/geometric.hpp>

#include "vpe/voxel/columns/round_refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Returns the angle of (x, y) in (-pi, pi], within some 3e-7.
template <class D>
hn::Vec<D> direction_angle(D d, hn::Vec<D> y, hn::Vec<D> x) {
  const auto ax = hn::Abs(x);
  const auto ay = hn::Abs(y);
  const auto steep = hn::Gt(ay, ax);
  const auto least = hn::Set(d, 1e-30F);
  const auto quotient = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), least));
  const auto eighth = hn::Atan(d, quotient);
  const auto quarter = hn::IfThenElse(steep, hn::Sub(hn::Set(d, 1.57079633F), eighth), eighth);
  const auto half = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 3.14159265F), quarter), quarter);
  return hn::CopySign(half, y);
}

// Finds the four samples about each pixel of a row, as many pixels at once as D has lanes. D is a vector of float.
template <class D>
class FanHints {
 public:
  using V = hn::Vec<D>;

  // Holds the samples below and above a pixel's elevation, on either side of its azimuth, and where the pixel lies between.
  struct Samples {
    V below_a, below_b, above_a, above_b;
    V across;  // share of the way from a to b
    V upward;  // from below to above
  };

  FanHints(const RoundRow& row, const FanSamples& fan) : row_(row), fan_(fan) {
    const auto in_fan = [&](const glm::dvec3& v, V out[3]) {
      out[0] = set(glm::dot(v, fan.north));
      out[1] = set(glm::dot(v, fan.east));
      out[2] = set(glm::dot(v, fan.up));
    };
    in_fan(row.right, right_);
    in_fan(row.forward, forward_);
    in_fan(row.up, up_);
  }

  // Returns the samples about pixels k, k + 1, ...; lanes beyond the row take its last one.
  Samples at(int k) const {
    const D d;
    alignas(64) float sine[16];
    alignas(64) float cosine[16];
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int lane = 0; lane < lanes; ++lane) {
      const int pixel = std::min(k + lane, row_.count - 1);
      sine[lane] = static_cast<float>(row_.sine[pixel]);
      cosine[lane] = static_cast<float>(row_.cosine[pixel]);
    }
    const V s = hn::Load(d, sine);
    const V c = hn::Load(d, cosine);
    const auto along = [&](int axis) {
      return hn::MulAdd(s, right_[axis], hn::MulAdd(c, forward_[axis], up_[axis]));
    };
    const V x = along(0);
    const V y = along(1);
    const V azimuth = direction_angle(d, y, x);
    const V elevation = direction_angle(d, along(2), hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y))));
    V turn = hn::Sub(azimuth, set(fan_.first_azimuth));
    turn = hn::IfThenElse(hn::Lt(turn, hn::Zero(d)), hn::Add(turn, set(2 * mars::kPi)), turn);
    alignas(64) float column[16];
    alignas(64) float line[16];
    hn::Store(hn::Mul(turn, set(1 / fan_.azimuth_step)), d, column);
    hn::Store(hn::Mul(hn::Sub(elevation, set(fan_.first_elevation)), set(1 / fan_.elevation_step)), d, line);
    alignas(64) float found[4][16];
    alignas(64) float shares[2][16];
    for (int lane = 0; lane < lanes; ++lane) pick(column[lane], line[lane], lane, found, shares);
    return {hn::Load(d, found[0]), hn::Load(d, found[1]),  hn::Load(d, found[2]),
            hn::Load(d, found[3]), hn::Load(d, shares[0]), hn::Load(d, shares[1])};
  }

 private:
  static V set(double x) { return hn::Set(D(), static_cast<float>(x)); }

  void pick(float column, float line, int lane, float (&found)[4][16], float (&shares)[2][16]) const {
    const int last = fan_.columns - 1;
    int a = static_cast<int>(column);  // at least 0
    int b = a + 1;
    float across = column - static_cast<float>(a);
    if (fan_.is_full_circle) {
      // Rounding may lead just past the circle.
      if (a > last) a -= fan_.columns;
      if (b > last) b -= fan_.columns;
    } else {
      a = std::min(a, last);
      b = std::min(b, last);
    }
    const int low = static_cast<int>(line + 1) - 1;  // at least -1
    shares[0][lane] = across;
    shares[1][lane] = std::clamp(line - static_cast<float>(low), 0.0F, 1.0F);
    found[0][lane] = sample(a, low);
    found[1][lane] = sample(b, low);
    found[2][lane] = sample(a, low + 1);
    found[3][lane] = sample(b, low + 1);
  }

  float sample(int column, int row) const {
    const int set_row = std::clamp(row, fan_.first_row[column], fan_.end_row[column] - 1);
    return fan_.range_m[static_cast<std::ptrdiff_t>(set_row) * fan_.columns + column];
  }

  const RoundRow& row_;
  const FanSamples& fan_;
  V right_[3], forward_[3], up_[3];
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
