// Paints sky and haze over a block of pixels: core::sky_colour, core::air_m and core::haze_colour in vectors,
// within 0.5/255 of them (tests/voxel/image_painter_test).
//
// Part of paint_kernel.cpp: the last step of a block.
#if defined(VPE_VOXEL_PAINT_AIR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PAINT_AIR_INL_H_
#undef VPE_VOXEL_PAINT_AIR_INL_H_
#else
#define VPE_VOXEL_PAINT_AIR_INL_H_
#endif

#include <hwy/highway.h>

#include "vpe/core/appearance/shading.h"
#include "vpe/core/appearance/sky.h"
#include "vpe/voxel/paint/paint_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

// Holds intermediate values of the block's rays, computed in double and stored as float. Processing half
// vectors of double throughout costs more.
struct alignas(64) RayAir {
  float a[kBlock], b[kBlock], c[kBlock], d[kBlock], e[kBlock];
};

// Paints the block's sky. Requires ray_angles().
inline HWY_NOINLINE void paint_sky(const PaintJob& job, Block& block) {
  const core::SkyAir& air = core::air_of(job.request->settings.atmosphere);
  const double height = std::max(job.camera_radius_m - job.radius_m, 0.0);
  const double r = job.radius_m + height;
  const double limb = core::limb_mass(air, job.radius_m);
  const auto colour_depth = static_cast<float>(core::colour_depth(air, height));
  const auto sun_depth = static_cast<float>(-0.3 * air.zenith_depth);
  const double sun_up = glm::dot(job.request->sun, job.up);
  RayAir rays;
  const Doubles dd;
  const Halves dh;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(dd))) {
    const auto rise = hn::Load(dd, block.rise + i);
    const auto sunward = hn::Load(dd, block.sunward + i);
    // In double: floats lose the ray's height seen from far cameras, and the sun's disc in 1 less a small
    // number.
    const auto down = hn::Max(hn::Neg(rise), hn::Zero(dd));
    const auto level = hn::Sub(hn::Set(dd, 1.0), hn::Mul(down, down));
    const auto per_root = inverse_root(dd, hn::Max(level, hn::Set(dd, 1e-18)));
    const auto deeper = hn::Add(hn::Set(dd, 1.0), hn::Mul(level, per_root));
    const auto drop = hn::Mul(hn::Mul(hn::Mul(down, down), hn::Set(dd, r)), inverse(dd, deeper));
    const auto lowest = hn::Max(hn::Sub(hn::Set(dd, height), drop), hn::Set(dd, air.lowest_m));
    const auto scaled = hn::Mul(lowest, hn::Set(dd, 1.0 / air.scale_height_m));
    hn::Store(hn::DemoteTo(dh, scaled), dh, rays.a + i);
    hn::Store(hn::DemoteTo(dh, hn::Sub(hn::Set(dd, height / air.scale_height_m), scaled)), dh, rays.b + i);
    const auto place_sun = hn::Mul(hn::Add(hn::Set(dd, sun_up), hn::Mul(down, sunward)), per_root);
    hn::Store(hn::DemoteTo(dh, place_sun), dh, rays.c + i);
    hn::Store(hn::DemoteTo(dh, hn::Sub(hn::Set(dd, 1.0), sunward)), dh, rays.d + i);
    hn::Store(hn::DemoteTo(dh, rise), dh, rays.e + i);
  }
  const Floats d;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto density = exponential(d, hn::Neg(hn::Load(d, rays.a + i)));
    const auto falls = line(d, clamp(d, hn::Load(d, rays.b + i), 0, 1), limb, limb);
    const auto rise = hn::Load(d, rays.e + i);
    const auto climbs = hn::Div(hn::Set(d, 1.0F), line(d, hn::Max(rise, hn::Zero(d)), 1 / limb, 1));
    const auto mass = hn::IfThenElse(hn::Lt(rise, hn::Zero(d)), falls, climbs);
    const auto thickness = hn::Mul(density, mass);
    const auto depth = hn::Mul(thickness, hn::Set(d, colour_depth));
    const auto day = line(d, smooth_step(d, hn::Load(d, rays.c + i), core::kDawnSine, core::kDaySine),
                          core::kNight, 1 - core::kNight);
    const auto beside = hn::Load(d, rays.d + i);
    const auto near = hn::Max(hn::Sub(hn::Set(d, 1.0F), beside), hn::Zero(d));
    const auto near2 = hn::Mul(near, near);
    const auto near4 = hn::Mul(near2, near2);
    const auto near8 = hn::Mul(near4, near4);
    const auto glow = hn::Mul(hn::Mul(near8, near8), near8);
    const auto share = clamp(d, hn::Mul(depth, hn::Set(d, 0.5F)), 0, 1);
    const auto veil = hn::Mul(hn::Sub(hn::Set(d, 1.0F), exponential(d, hn::Neg(depth))), day);
    const auto disc =
        hn::Mul(hn::Sub(hn::Set(d, 1.0F), smooth_step(d, beside, 1 - air.disc_full, 1 - air.disc_rim)),
                exponential(d, hn::Mul(thickness, hn::Set(d, sun_depth))));
    float* const out[3] = {block.red + i, block.green + i, block.blue + i};
    const auto sky = hn::Gt(hn::Load(d, block.is_sky + i), hn::Zero(d));
    for (int c = 0; c < 3; ++c) {
      const auto dust = line(d, glow, air.dust[c], air.glow[c] - air.dust[c]);
      const auto zenith = hn::Set(d, static_cast<float>(air.zenith[c]));
      const auto clear = hn::Mul(hn::Add(zenith, hn::Mul(share, hn::Sub(dust, zenith))), veil);
      const auto sun = hn::Set(d, static_cast<float>(air.sun[c]));
      const auto colour = hn::Add(clear, hn::Mul(disc, hn::Sub(sun, clear)));
      hn::Store(hn::IfThenElse(sky, hn::Mul(hn::Set(d, 255.0F), colour), hn::Load(d, out[c])), d, out[c]);
    }
  }
}

// Paints haze over the block's ground. Requires ray_angles().
inline HWY_NOINLINE void paint_haze(const PaintJob& job, double visibility_m, Block& block) {
  const double r = job.camera_radius_m;
  const double camera_height = r - job.radius_m;
  const double top = job.radius_m + core::kAirTop_m;
  const glm::dvec3& sun = job.request->sun;
  const glm::dvec3& haze = core::air_of(job.request->settings.atmosphere).haze;
  // A height above the sphere loses less to rounding as rise / (sqrt(radius^2 + rise) + radius).
  const auto rise_at = [&](double height) { return height * (2 * job.radius_m + height); };
  RayAir rays;
  const Doubles dd;
  const Halves dh;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(dd))) {
    // The part of the ray below the top of the air. Floats suffice after this.
    const auto range = hn::PromoteTo(dd, hn::Load(dh, block.range + i));
    const auto half = hn::Mul(hn::Load(dd, block.rise + i), hn::Set(dd, -r));
    const auto under = hn::Sub(hn::Mul(half, half), hn::Set(dd, r * r - top * top));
    const auto root = hn::Sqrt(hn::Max(under, hn::Zero(dd)));
    const auto begin = hn::Min(hn::Max(hn::Sub(half, root), hn::Zero(dd)), range);
    const auto end = hn::Min(hn::Max(hn::Add(half, root), hn::Zero(dd)), range);
    hn::Store(hn::DemoteTo(dh, hn::Sub(end, begin)), dh, rays.a + i);
    hn::Store(hn::DemoteTo(dh, begin), dh, rays.b + i);
    hn::Store(hn::DemoteTo(dh, hn::Mul(hn::Set(dd, 2.0), hn::Sub(begin, half))), dh, rays.c + i);
    const auto x = hn::Load(dd, block.place[0] + i);
    const auto y = hn::Load(dd, block.place[1] + i);
    const auto z = hn::Load(dd, block.place[2] + i);
    const auto out2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const auto to_sun = hn::Add(hn::Add(hn::Mul(x, hn::Set(dd, sun.x)), hn::Mul(y, hn::Set(dd, sun.y))),
                                hn::Mul(z, hn::Set(dd, sun.z)));
    hn::Store(hn::DemoteTo(dh, hn::Mul(to_sun, inverse_root(dd, out2))), dh, rays.d + i);
  }
  const Floats d;
  const auto square = hn::Set(d, static_cast<float>(job.radius_m * job.radius_m));
  const auto radius = hn::Set(d, static_cast<float>(job.radius_m));
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto length = hn::Load(d, rays.a + i);
    const auto enters = hn::Gt(hn::Load(d, rays.b + i), hn::Zero(d));
    const auto first = hn::IfThenElse(enters, hn::Set(d, static_cast<float>(rise_at(core::kAirTop_m))),
                                      hn::Set(d, static_cast<float>(rise_at(camera_height))));
    const auto twice = hn::Load(d, rays.c + i);
    auto sum = hn::Zero(d);
    for (std::size_t k = 0; k < core::kAirPoints.size(); ++k) {
      const auto weight = hn::Set(d, static_cast<float>(core::kAirWeights[k]));
      for (const double share : {core::kAirPoints[k], 1 - core::kAirPoints[k]}) {
        const auto t = hn::Mul(length, hn::Set(d, static_cast<float>(share)));
        const auto rise = hn::Add(first, hn::Mul(t, hn::Add(twice, t)));
        const auto height =
            hn::Div(rise, hn::Add(hn::Sqrt(hn::Max(hn::Add(square, rise), hn::Zero(d))), radius));
        const auto exponent = hn::Mul(height, hn::Set(d, static_cast<float>(-1 / core::kAirScale_m)));
        sum = hn::Add(sum, hn::Mul(weight, exponential(d, hn::Min(exponent, hn::Set(d, 80.0F)))));
      }
    }
    const auto air = hn::Mul(length, sum);
    const auto left =
        exponential(d, hn::Mul(air, hn::Set(d, static_cast<float>(-core::kKoschmieder / visibility_m))));
    const auto day = line(d, smooth_step(d, hn::Load(d, rays.d + i), core::kDawnSine, core::kDaySine),
                          core::kNight, 1 - core::kNight);
    float* const out[3] = {block.red + i, block.green + i, block.blue + i};
    for (int c = 0; c < 3; ++c) {
      const auto dust = hn::Mul(day, hn::Set(d, static_cast<float>(haze[c])));
      const auto ground = clamp(d, hn::Load(d, out[c]), 0, 255);
      hn::Store(hn::Add(dust, hn::Mul(left, hn::Sub(ground, dust))), d, out[c]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#endif
