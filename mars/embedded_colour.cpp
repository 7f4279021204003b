#include "mars/embedded_colour.h"

#include <algorithm>
#include <array>

#include "mars/embedded_landforms.h"
#include "mars/embedded_math.h"
#include "mars/embedded_noise.h"
#include "mars/embedded_simd.h"

namespace mars::embedded {

namespace {

// A soft patch brighter or darker than the mean, elongated east-west.
struct Patch {
  double lon_deg, lat_deg, reach_km, stretch;
  float albedo;
};
constexpr Patch kPatches[] = {
    {68.0, 9.0, 850, 0.75, -1.0F},      // Syrtis Major
    {332.0, 47.0, 1500, 1.3, -1.0F},    // Mare Acidalium
    {322.0, -24.0, 1500, 1.4, -0.75F},  // Mare Erythraeum
    {357.0, -6.0, 700, 1.5, -0.9F},     // Sinus Meridiani
    {22.0, -9.0, 950, 2.0, -0.8F},      // Sinus Sabaeus
    {95.0, -18.0, 1300, 1.4, -0.8F},    // Mare Tyrrhenum
    {140.0, -25.0, 1600, 1.7, -0.85F},  // Mare Cimmerium
    {205.0, -34.0, 1500, 1.8, -0.75F},  // Mare Sirenum
    {272.0, -26.0, 650, 1.2, -0.6F},    // Solis Lacus
    {258.0, -50.0, 1500, 1.9, -0.65F},  // Aonius Sinus
    {100.0, 50.0, 1400, 1.8, -0.65F},   // Utopia
    {40.0, -48.0, 900, 0.9, -0.6F},     // Hellespontus
    {310.0, -9.0, 700, 1.7, -0.5F},     // Aurorae Sinus
    {20.0, -62.0, 1500, 2.0, -0.4F},   {190.0, 68.0, 1500, 2.2, -0.45F}, {60.0, 70.0, 1300, 2.0, -0.45F},
    {300.0, 72.0, 1300, 2.0, -0.45F},  {240.0, 8.0, 2500, 1.0, 0.75F},  // Tharsis
    {23.0, 22.0, 1800, 1.2, 0.80F},                                     // Arabia
    {70.5, -42.5, 1250, 1.2, 0.85F},                                    // Hellas
    {148.0, 24.0, 1300, 1.1, 0.60F},                                    // Elysium
    {197.0, 24.0, 1800, 1.1, 0.65F},                                    // Amazonis
    {316.7, -49.8, 600, 1.0, 0.55F},                                    // Argyre
    {88.4, 13.0, 650, 1.0, 0.50F},                                      // Isidis
    {290.0, 12.0, 900, 0.9, 0.35F},                                     // Xanthe, Lunae
    {165.0, 5.0, 900, 1.6, 0.40F},
};

struct Colour {
  float r, g, b;
};
constexpr Colour kBright{209, 152, 104};
constexpr Colour kMean{166, 109, 73};
constexpr Colour kDark{84, 63, 53};
constexpr Colour kRock{112, 78, 60};
constexpr Colour kLayers{190, 142, 106};
constexpr Colour kIce{238, 236, 236};
constexpr Colour kDirtyIce{196, 150, 122};

Colour mix_colour(const Colour& a, const Colour& b, float t) {
  return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

std::uint8_t byte(float x) { return static_cast<std::uint8_t>(std::max(0.0F, std::min(255.0F, x)) + 0.5F); }

}  // namespace

void colour(const Block& block, const Surface& s, Rgb* out) {
  const Wander w(s.octaves);
  Lane<float> albedo{};
  static const auto frames = [] {
    std::array<PlaceFrame, std::size(kPatches)> all;
    std::transform(std::begin(kPatches), std::end(kPatches), all.begin(),
                   [](const Patch& p) { return place_frame(p.lon_deg, p.lat_deg); });
    return all;
  }();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Patch& p = kPatches[k];
    const PlaceFrame& f = frames[k];
    const double reach = km_chord(p.reach_km);
    if (!block.near(f.up, reach * std::max(1.0, p.stretch))) continue;
    const double squeeze = 1.0 - 1.0 / (p.stretch * p.stretch);
    const double inverse = 1.0 / (reach * reach);
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const double x = block.x[i] - f.up.x, y = block.y[i] - f.up.y, z = block.z[i] - f.up.z;
        const double e = x * f.east.x + y * f.east.y;
        const double q = (x * x + y * y + z * z - squeeze * e * e) * inverse;
        const auto t = static_cast<float>(std::max(0.0, 1.0 - q));
        albedo[i] += p.albedo * t * t * (3.0F - 2.0F * t);
      }
    });
  }
  for (std::size_t i = 0; i < block.padded; ++i) {
    const Terrain& g = s.ground;
    // Wind spreads the patches into ragged streaks.
    const float mottle =
        0.13F * w.km600[i] + 0.12F * w.km250[i] + 0.11F * w.km100[i] + 0.07F * w.km40[i] + 0.06F * w.km16[i];
    float a = albedo[i] + mottle;
    // Craters keep dark sand on their floors and dust outside.
    a -= 0.28F * std::max(s.craters.buried[i], s.craters.filled[i]) * std::max(0.0F, 0.5F + 0.5F * w.km40[i]);
    a += 0.12F * s.craters.fresh[i];
    a += 0.10F * static_cast<float>(ramp(6000.0, 16000.0, s.height_m[i]));
    const float soft = 1.25F * a / (1.0F + 0.45F * (a < 0.0F ? -a : a));
    Colour c = soft > 0.0F ? mix_colour(kMean, kBright, std::min(1.0F, soft))
                           : mix_colour(kMean, kDark, std::min(1.0F, -soft));
    c = mix_colour(c, kRock, 0.55F * g.wall[i]);
    c = mix_colour(
        c, kDark,
        0.35F * g.trough[i] * ramp(-1.6F, 2.0F, 0.8F * w.km40[i] + 0.5F * w.km16[i] + 0.3F * w.km100[i]));
    c = mix_colour(c, kLayers, 0.45F * s.ground.mound[i]);
    const float hue = 0.03F * w.km250[i];
    const float shade = 1.0F + 0.035F * std::max(-3.0F, std::min(3.0F, s.grain[i]));
    c = {c.r * shade * (1.0F - 0.4F * hue), c.g * shade, c.b * shade * (1.0F + hue)};
    if (g.ice[i] > 0.0F) {
      const Colour frost = mix_colour(kIce, kDirtyIce, clamp01(1.5F * g.wall[i] + 0.10F * w.km40[i] + 0.05F));
      // Only the inner part of the southern layered ground is bright.
      const auto bright =
          static_cast<float>(ramp(-0.990, -0.996, block.z[i] + 0.0008 * static_cast<double>(w.km250[i])));
      const Colour cover = block.z[i] > 0.0 ? frost : mix_colour(kLayers, frost, 0.25F + 0.75F * bright);
      c = mix_colour(c, cover, clamp01(g.ice[i] * 1.3F - 0.1F));
    }
    out[i] = {byte(c.r), byte(c.g), byte(c.b)};
  }
}

}  // namespace mars::embedded
