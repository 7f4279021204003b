// Shades a block: turns its normals, heights and texels into colours, as paging::TerrainShader does, in
// vectors.
//
// Part of paint_kernel.cpp, called by paint_ground() (paint_ground-inl.h).
#if defined(VPE_VOXEL_PAINT_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PAINT_SHADING_INL_H_
#undef VPE_VOXEL_PAINT_SHADING_INL_H_
#else
#define VPE_VOXEL_PAINT_SHADING_INL_H_
#endif

#include <hwy/highway.h>

#include "vpe/core/appearance/shading.h"
#include "vpe/voxel/paint/paint_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

template <class V>
struct Triple {
  V x, y, z;
};

template <class V>
HWY_INLINE V dot(const Triple<V>& a, const Triple<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> triple(D d, const glm::dvec3& v) {
  return {hn::Set(d, static_cast<float>(v.x)), hn::Set(d, static_cast<float>(v.y)),
          hn::Set(d, static_cast<float>(v.z))};
}

// Returns the slope of normals of any length at places p, degrees.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V slope(D d, const Triple<V>& normal, const Triple<V>& p) {
  const Triple<V> cross{hn::Sub(hn::Mul(normal.y, p.z), hn::Mul(normal.z, p.y)),
                        hn::Sub(hn::Mul(normal.z, p.x), hn::Mul(normal.x, p.z)),
                        hn::Sub(hn::Mul(normal.x, p.y), hn::Mul(normal.y, p.x))};
  return angle_deg(d, hn::Sqrt(dot(cross, cross)), dot(normal, p));
}

// Returns the aspect, degrees; `undefined` where the ground is flat.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V aspect(D d, const Triple<V>& n, const Triple<V>& p, float undefined) {
  // East (-y, x, 0) and north (-xz, -yz, x^2 + y^2), both as long as the distance from the axis.
  const V flat2 = hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y));
  const V inverse = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(hn::Add(flat2, hn::Mul(p.z, p.z))));
  const V flat = hn::Mul(hn::Sqrt(flat2), inverse);
  const V at_pole = hn::Zero(d);
  const auto pole = hn::Eq(flat2, at_pole);
  // At a pole east is (0, 1, 0).
  const V x = hn::IfThenElse(pole, hn::Set(d, 1.0F), hn::Mul(p.x, inverse));
  const V y = hn::Mul(p.y, inverse);
  const V z = hn::Mul(p.z, inverse);
  const V east = hn::Sub(hn::Mul(x, n.y), hn::Mul(y, n.x));
  const V meridian = hn::Add(hn::Mul(x, n.x), hn::Mul(y, n.y));
  const V shorter = hn::IfThenElse(pole, hn::Set(d, 1.0F), flat);
  const V north = hn::Sub(hn::Mul(flat, n.z), hn::Div(hn::Mul(z, meridian), shorter));
  const V clockwise = angle_deg(d, hn::Div(east, shorter), north);
  const V positive =
      hn::IfThenElse(hn::Lt(clockwise, hn::Zero(d)), hn::Add(clockwise, hn::Set(d, 360.0F)), clockwise);
  // 1e-9 degrees.
  const V tilt2 = hn::Add(hn::Mul(east, east), hn::Mul(north, north));
  return hn::IfThenElse(hn::Lt(tilt2, hn::Set(d, 3e-22F)), hn::Set(d, undefined), positive);
}

// Writes the scale's colours of the block's values to `out`, four floats for each pixel.
inline HWY_NOINLINE void take_scale(const ScaleTable& table, const core::ColourScale& scale, const float* value,
                                    std::uint32_t pixels, float (*out)[4]) {
  const Floats d;
  const Ints di;
  alignas(64) std::int32_t bucket[kBlock];
  alignas(64) float share[kBlock];
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto at =
        hn::Mul(hn::Sub(hn::Load(d, value + i), hn::Set(d, table.first)), hn::Set(d, table.per_unit));
    const auto inside = clamp(d, at, -1, ScaleTable::kInner);
    const auto whole = hn::Floor(inside);
    hn::Store(hn::Sub(inside, whole), d, share + i);
    hn::Store(hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 1)), di, bucket + i);
  }
  const hn::CappedTag<float, 4> four;
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const ScaleTable::Bucket& b = table.buckets[static_cast<std::size_t>(bucket[i])];
    if (b.base[3] != 0.0F) {
      const glm::dvec3 exact = scale(static_cast<double>(value[i]));
      for (int c = 0; c < 3; ++c) out[i][c] = static_cast<float>(exact[c]);
      continue;
    }
    for (std::size_t c = 0; c < 4; c += hn::Lanes(four))
      hn::Store(hn::Add(hn::LoadU(four, b.base.data() + c),
                        hn::Mul(hn::Set(four, share[i]), hn::LoadU(four, b.rise.data() + c))),
                four, out[i] + c);
  }
}

// Returns the values that a colour source shows at pixels i and after.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V shown_value(D d, const PaintJob& job, paging::ColourSource what, const Block& block, int i,
                         const Triple<V>& normal, V height) {
  if (what == paging::ColourSource::kElevation || what == paging::ColourSource::kDifference) return height;
  // A vector of doubles holds half as many places as a vector of floats.
  const Doubles dd;
  const Halves dh;
  alignas(64) float place[3][kBlock];
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < static_cast<int>(hn::Lanes(d)); k += static_cast<int>(hn::Lanes(dd)))
      hn::Store(hn::DemoteTo(dh, hn::Load(dd, block.shown[c] + i + k)), dh, place[c] + k);
  }
  const Triple<V> p{hn::Load(d, place[0]), hn::Load(d, place[1]), hn::Load(d, place[2])};
  if (what == paging::ColourSource::kSlope) return slope(d, normal, p);
  return aspect(d, normal, p, job.scale->undefined_value);
}

// Colours the whole block, after take_posts() or take_facets(), and take_texels() or take_colours().
inline HWY_NOINLINE void paint_shading(const PaintJob& job, Block& block) {
  const paging::ShadingParams& shading = *job.shading;
  const bool of_image = paging::shows_image(shading.colour_source);
  const bool scaled = job.scale != nullptr;
  const bool posts = job.needs.posts || job.needs.facets;
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  alignas(64) float light[kBlock];
  alignas(64) float value[kBlock];
  alignas(64) float hue[kBlock][4];
  if (posts) {
    const auto sun = triple(d, shading.sun);
    for (int i = 0; i < kBlock; i += lanes) {
      hn::Vec<Floats> x, y, z, height;
      hn::LoadInterleaved4(d, block.post[i], x, y, z, height);
      const Triple<hn::Vec<Floats>> normal{x, y, z};
      if (scaled)
        hn::Store(shown_value(d, job, of_image ? shading.hue : shading.colour_source, block, i, normal, height),
                  d, value + i);
      if (!shading.lit) continue;
      const auto cosine = hn::Div(dot(normal, sun), hn::Sqrt(dot(normal, normal)));
      auto incidence = hn::Max(cosine, hn::Zero(d));
      if (shading.shadows) incidence = hn::Mul(incidence, hn::Load(d, block.sun + i));
      hn::Store(hn::Sqrt(line(d, incidence, shading.ambient, shading.diffuse)), d, light + i);
    }
  }
  if (scaled) take_scale(*job.scale, *shading.scale, value, block.ground, of_image ? hue : block.texel);
  for (int i = 0; i < kBlock; i += lanes) {
    Triple<hn::Vec<Floats>> colour = triple(d, shading.plain);
    auto unused = hn::Zero(d);
    if (of_image || scaled) hn::LoadInterleaved4(d, block.texel[i], colour.x, colour.y, colour.z, unused);
    if (of_image && scaled) {
      // core::colourised
      const auto most = hn::Max(hn::Max(colour.x, colour.y), colour.z);
      Triple<hn::Vec<Floats>> tint;
      hn::LoadInterleaved4(d, hue[i], tint.x, tint.y, tint.z, unused);
      const auto strongest = hn::Max(hn::Max(tint.x, tint.y), tint.z);
      const auto black = hn::Le(strongest, hn::Zero(d));
      const auto by = hn::Div(most, hn::IfThenElse(black, hn::Set(d, 1.0F), strongest));
      colour = {hn::IfThenElse(black, most, hn::Mul(tint.x, by)),
                hn::IfThenElse(black, most, hn::Mul(tint.y, by)),
                hn::IfThenElse(black, most, hn::Mul(tint.z, by))};
    }
    if (shading.lit) {
      const auto factor = hn::Load(d, light + i);
      colour = {hn::Mul(colour.x, factor), hn::Mul(colour.y, factor), hn::Mul(colour.z, factor)};
    }
    hn::Store(colour.x, d, block.red + i);
    hn::Store(colour.y, d, block.green + i);
    hn::Store(colour.z, d, block.blue + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#endif
