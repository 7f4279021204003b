#include "mars/embedded/detail.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

// Describes a set of ridges. Their lines of equal phase run across the wind and are distorted by three octaves
// of the common noise, so that they fork, sway and end. They vanish towards the two places where that direction
// is vertical, in western Acidalia and in Promethei Terra.
struct Ridges {
  double wavelength_m;
  float height_m;
  float lee;  // share of a wavelength under the lee slope; half = symmetric
  double coarsest_m;
  int octave[3];       // that distort the lines
  float amplitude[3];  // of the distortion, in waves
  int patch;           // octave that makes them vanish in places
};
constexpr Ridges kRidges[] = {
    {640.0, 26.0F, 0.14F, 128.0, {12, 11, 10}, {0.5F, 0.28F, 0.12F}, 11},
    {41.0, 1.9F, 0.42F, 8.0, {9, 7, 6}, {0.8F, 0.40F, 0.16F}, 8},
    {9.5, 0.45F, 0.36F, 2.0, {7, 5, 4}, {0.7F, 0.34F, 0.15F}, 6},
    {2.3, 0.19F, 0.30F, 0.5, {5, 3, 2}, {0.6F, 0.30F, 0.13F}, 4},
    {0.37, 0.017F, 0.35F, 0.0625, {3, 2, 1}, {0.5F, 0.25F, 0.12F}, 1},
};

// Mean of a ridge's profile, so that sand raises no ground.
constexpr float kMeanRidge = 0.45F / 2.0F + 0.55F / 3.0F;

}  // namespace

bool lay_sand(const Block& block, double detail_m, const Octaves& octaves, const Ground& ground,
              const CraterSum& craters, Sand& out) {
  if (detail_m > kCoarsestSand_m) {
    out.cover.fill(0.0F);
    return false;
  }
  const auto& n = octaves.n;
  std::int32_t any = 0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const float where = 0.8F * n[13][i] + 0.5F * n[11][i] - 0.25F;
      const float open = std::max({ground.trough[i], 0.7F * craters.hollow[i], 0.9F * ground.dark[i]});
      // The erg around the northern ice.
      const auto z = static_cast<float>(block.z[i]);
      const float erg =
          std::max(0.0F, std::min(1.0F, (0.0117F - magnitude(z - 0.9838F)) * 200.0F)) * (1.0F - ground.ice[i]);
      out.cover[i] = std::max(std::max(0.0F, std::min(1.0F, where * 2.0F)) * open,
                              erg * std::max(0.0F, std::min(1.0F, where + 0.9F))) *
                     (1.0F - ground.wall[i]);
      any |= static_cast<std::int32_t>(out.cover[i] > 0.0F);
    }
  });
  if (any == 0) return false;
  for (auto& group : out.height_m) group.fill(0.0F);
  out.crest.fill(0.0F);
  for (std::size_t k = 0; k < std::size(kRidges); ++k) {
    const Ridges& r = kRidges[k];
    if (detail_m > r.coarsest_m) break;
    Lane<float>& height_m = out.height_m[std::min<std::size_t>(k, Sand::kGroups - 1)];
    const auto& b0 = n[static_cast<std::size_t>(r.octave[0])];
    const auto& b1 = n[static_cast<std::size_t>(r.octave[1])];
    const auto& b2 = n[static_cast<std::size_t>(r.octave[2])];
    const auto& patch = n[static_cast<std::size_t>(r.patch)];
    const double inverse = 1.0 / r.wavelength_m;
    const float rise = 1.0F / (1.0F - r.lee);
    const float fall = 1.0F / r.lee;
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        // The wind direction varies over tens of kilometres.
        const double across = (0.30 * block.x[i] - 0.52 * block.y[i] + 0.80 * block.z[i]) * kRadius_m +
                              4500.0 * static_cast<double>(n[15][i]);
        const double phase =
            across * inverse +
            static_cast<double>(r.amplitude[0] * b0[i] + r.amplitude[1] * b1[i] + r.amplitude[2] * b2[i]);
        const auto f = static_cast<float>(phase - floor_int(phase));
        const float up = std::min(f * rise, (1.0F - f) * fall);
        const float ridge = up * (0.45F + 0.55F * up);
        const float there = out.cover[i] * std::max(0.0F, std::min(1.0F, 0.75F + 0.55F * patch[i]));
        height_m[i] += r.height_m * there * (ridge - kMeanRidge);
        out.crest[i] = mix(out.crest[i] * 0.6F, ridge, there);
      }
    });
  }
  return true;
}

}  // namespace mars::embedded
