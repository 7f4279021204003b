#include "mars/embedded/colour.h"

#include <algorithm>

#include "mars/embedded/albedo_table.h"
#include "mars/embedded/block.h"
#include "mars/embedded/bumps.h"
#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

namespace {

struct Colour {
  float r, g, b;
};
constexpr Colour kBright{206, 152, 108};
constexpr Colour kMean{164, 111, 77};
constexpr Colour kDark{80, 63, 55};
constexpr Colour kRock{112, 80, 63};
constexpr Colour kLayers{196, 152, 118};
constexpr Colour kSand{104, 80, 66};
constexpr Colour kStone{106, 84, 73};
constexpr Colour kBlack{62, 53, 50};
constexpr Colour kIce{238, 236, 236};
constexpr Colour kDirtyIce{192, 146, 118};

[[gnu::always_inline]] inline Colour mix_colour(const Colour& a, const Colour& b, float t) {
  return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

// Sets out[i] to the brightness of the ground, about -1.2..1.2, before the effect of its height.
//
// A field of 8000 bumps (bumps.h) is fitted to the brightness of the Viking colour mosaic averaged over about
// 250 km:
// -1 is the dark sand of Syrtis Major, 0 the mean, 1 the dust of Tharsis; the residual is 0.22. The fronts
// between bright and dark, and the streaks along them, are synthetic: sharp lines where the distorted field
// crosses a threshold.
void albedo(const Block& block, const Octaves& octaves, Lane<float>& out) {
  constexpr double kReach = 0.083;  // chord on the unit sphere: 280 km
  static const Bumps<std::int8_t> bumps{bump_centres(static_cast<int>(kAlbedoTable.size())), kAlbedoTable,
                                        kReach, kAlbedoStep};
  Lane<double> broad;
  sum_bumps(block, bumps, broad);

  // The winds of the tropics blow roughly along the parallels, so streaks are stretched in that direction.
  Points blown;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      blown.x[i] = block.x[i] * kRadius_m;
      blown.y[i] = block.y[i] * kRadius_m;
      blown.z[i] = (3.6 * block.z[i] + 0.9 * block.x[i] * block.y[i]) * kRadius_m +
                   60e3 * static_cast<double>(octaves.n[18][i]);
    }
  });
  Lane<float> streaks, wisps;
  noise(blown, block.padded, block.simd, 260e3, 0x701, streaks);
  noise(blown, block.padded, block.simd, 47e3, 0x712, wisps);

  Lane<float> frayed{};
  float share = 0.055F;
  for (int k = 13; k >= std::max(6, octaves.first); --k) {
    const Lane<float>& n = octaves.n[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < block.padded; ++i) frayed[i] += share * n[i];
    share *= 0.68F;
  }
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const auto b = static_cast<float>(broad[i]);
      const float ragged = 0.10F * octaves.n[18][i] + 0.09F * octaves.n[17][i] + 0.08F * octaves.n[16][i] +
                           0.08F * octaves.n[15][i] + 0.06F * octaves.n[14][i] + frayed[i];
      const float t = b + ragged + 0.15F * streaks[i] + 0.10F * wisps[i];
      // The fronts between sand and thin dust are sharp, those between thin and thick dust softer.
      const float front = 0.75F * ramp(-0.34F, -0.08F, t) + 0.65F * ramp(0.10F, 0.62F, t) +
                          0.60F * ramp(-0.88F, -0.60F, t) - 1.1F;
      out[i] = 0.50F * b + 0.58F * front + 0.035F * streaks[i] + 0.05F * wisps[i] + 0.12F * ragged;
    }
  });
}

std::uint8_t byte(float x) { return static_cast<std::uint8_t>(std::max(0.0F, std::min(255.0F, x)) + 0.5F); }

// Returns the frost cover, 0..1: ragged at the edges of the caps, with patches in the lee of obstacles.
float frost(const OutlineNoise& w, const Surface& s, std::size_t i, const glm::dvec3& here) {
  const float ragged = 1.7F * w.km250[i] + 0.8F * w.km100[i] + 0.7F * w.km40[i] + 0.6F * w.km16[i];
  double out = ramp(0.9850, 0.9875, here.z + 0.0011 * static_cast<double>(ragged));
  // Dunes bound the northern ice on the far side: Olympia Undae.
  out *= 1.0 - ramp(0.05, 0.10, -here.x) * ramp(0.9935, 0.9905, here.z + 0.0006 * static_cast<double>(ragged));
  if (here.z < 0.0) {
    static constexpr glm::dvec3 kMiddle = place(318.0, -87.2);
    const double off = std::sqrt(chord2(here, kMiddle)) + 0.007 * static_cast<double>(ragged);
    out = ramp(0.062, 0.053, off);
  }
  const float bare = here.z > 0.0 ? 1.05F * s.ground.wall[i] : 0.7F * s.ground.wall[i];
  return static_cast<float>(out) * clamp01(1.05F - bare);
}

}  // namespace

void colour(const Block& block, const Surface& s, vpe::base::Rgb* out) {
  const OutlineNoise w(s.octaves);
  Lane<float> bright;
  albedo(block, s.octaves, bright);
  for (std::size_t i = 0; i < block.padded; ++i) {
    const Terrain& g = s.ground;
    float a = bright[i];
    // Craters in dark regions have sand on their floors; fresh walls lose their dust.
    const float hollow = std::max(s.craters.buried[i], s.craters.filled[i]);
    a -= 0.30F * hollow * clamp01(0.7F - 0.8F * a) * clamp01(0.5F + 0.6F * w.km40[i]);
    a -= 0.22F * s.craters.fresh[i] * clamp01(0.8F + a);
    const float soft = 1.15F * a / (1.0F + 0.25F * (a < 0.0F ? -a : a));
    Colour c = soft > 0.0F ? mix_colour(kMean, kBright, std::min(1.0F, soft))
                           : mix_colour(kMean, kDark, std::min(1.0F, -soft));
    // Dust stays on gentle ground; rock shows on walls.
    c = mix_colour(c, kRock, 0.62F * g.wall[i] * clamp01(1.0F + 0.3F * s.grain[i]));
    // Sand gathers on canyon floors, so they are darker than the plains above.
    c = mix_colour(c, kDark,
                   0.58F * g.trough[i] * clamp01(1.15F - a) *
                       ramp(-2.2F, 1.4F, 0.8F * w.km40[i] + 0.5F * w.km16[i] + 0.3F * w.km100[i]));
    c = mix_colour(c, kLayers, 0.65F * g.mound[i]);
    c = mix_colour(c, kSand, s.sand[i] * (0.75F - 0.35F * s.crest[i]));
    if (s.rock[i] > 0.0F) {
      const Colour stone = mix_colour(kStone, s.rock_tone[i] > 0.0F ? kLayers : kBlack,
                                      0.7F * std::min(1.0F, magnitude(s.rock_tone[i])));
      c = mix_colour(c, stone, 0.88F * s.rock[i]);
    }
    const float hue = 0.03F * w.km250[i];
    const float shade = 1.0F + 0.035F * std::max(-4.0F, std::min(4.0F, s.grain[i]));
    c = {c.r * shade * (1.0F - 0.4F * hue), c.g * shade, c.b * shade * (1.0F + hue)};
    if (g.ice[i] > 0.0F || block.z[i] > 0.98) {
      // Dust covers the layered ground; only its middle is white all year. Its edge is made ragged, because the
      // outline of the cap itself is too smooth.
      const float ragged = 0.30F * w.km100[i] + 0.30F * w.km40[i] + 0.22F * w.km16[i];
      c = mix_colour(c, kDirtyIce, 0.55F * clamp01(1.5F * g.ice[i] - 0.6F + ragged) * clamp01(4.0F * g.ice[i]));
      c = mix_colour(c, kIce, 0.93F * (1.0F - s.sand[i]) * frost(w, s, i, block.at(i)));
    }
    out[i] = {byte(c.r), byte(c.g), byte(c.b)};
  }
}

}  // namespace mars::embedded
