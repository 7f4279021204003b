// Shield volcanoes.
#include <algorithm>
#include <array>

#include "mars/embedded/block.h"
#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/spurs.h"

namespace mars::embedded {

namespace {

// Width of the edge below which a shield ends in a cliff.
constexpr double kScarp_km = 25.0;
constexpr double kFrayed = 0.15;

struct Caldera {
  double east_km, north_km, radius_km, floor_m;
};

struct Shield {
  double lon_deg, lat_deg, radius_km;
  double summit_m;      // rim of the caldera
  double foot_m;        // where the flank ends
  double summit_km;     // radius of the flat top
  double edge_km;       // width of the transition from flank to plain; small = a scarp
  double convexity;     // 0 cone .. 1 dome
  Caldera calderas[6];  // radius 0 = none
};

constexpr Shield kShields[] = {
    // The nested caldera of Olympus: main pit and five collapses, 80 x 60 km.
    {226.20,
     18.65,
     297,
     21230,
     4400,
     46,
     21,
     0.28,
     {{10, -14, 27, 18900},
      {-14, -10, 16, 18300},
      {24, 6, 13, 18600},
      {-4, 9, 12, 18100},
      {30, -16, 9, 18250},
      {4, -34, 11, 18750}}},
    {255.92,
     11.92,
     236,
     18200,
     3300,
     30,
     70,
     0.25,
     {{0, 0, 13, 14900}, {-14, 5, 11, 16600}, {5, -14, 10, 16900}, {12, 9, 9, 16500}, {-6, -10, 8, 16800}, {}}},
    {247.04, 1.48, 188, 14100, 4300, 45, 70, 0.30, {{4, -4, 21, 9600}, {-10, 14, 40, 13300}, {}, {}, {}, {}}},
    {239.91, -8.26, 228, 17760, 6300, 62, 130, 0.35, {{0, 0, 55, 16500}, {}, {}, {}, {}, {}}},
    {147.21, 25.02, 215, 14100, 300, 9, 190, -0.85, {{0, 0, 6, 13500}, {}, {}, {}, {}, {}}},
    {250.40, 40.47, 225, 6800, 3000, 60, 170, 0.40, {{0, 0, 32, 5900}, {14, -18, 22, 5700}, {}, {}, {}, {}}},
    {150.24, 32.12, 88, 4800, -1800, 7, 30, 0.3, {{0, 0, 5, 4300}, {}, {}, {}, {}, {}}},     // Hecates Tholus
    {150.46, 18.87, 78, 4100, -300, 14, 25, 0.4, {{0, 0, 15, 1500}, {}, {}, {}, {}, {}}},    // Albor Tholus
    {262.75, 24.00, 62, 8500, 3200, 11, 26, 0.5, {{0, 0, 12, 6600}, {}, {}, {}, {}, {}}},    // Ceraunius Tholus
    {262.07, 26.10, 34, 5600, 2900, 11, 26, 0.4, {{0, 0, 11, 3300}, {}, {}, {}, {}, {}}},    // Uranius Tholus
    {267.30, 26.90, 130, 4800, 2500, 24, 60, 0.6, {{0, 0, 19, 2700}, {}, {}, {}, {}, {}}},   // Uranius Mons
    {269.30, 13.40, 68, 8600, 2000, 22, 26, 0.6, {{0, 0, 22, 5600}, {}, {}, {}, {}, {}}},    // Tharsis Tholus
    {236.00, 2.45, 70, 7200, 3900, 24, 26, 0.5, {{0, 0, 24, 4700}, {}, {}, {}, {}, {}}},     // Biblis Tholus
    {238.60, 2.90, 46, 5600, 4000, 25, 26, 0.5, {{0, 0, 25, 3100}, {}, {}, {}, {}, {}}},     // Ulysses Tholus
    {174.40, -9.30, 105, 2900, -1200, 40, 30, 0.4, {{0, 0, 38, 1900}, {}, {}, {}, {}, {}}},  // Apollinaris Mons
};

constexpr std::size_t kShieldCount = sizeof(kShields) / sizeof(kShields[0]);

void raise(const Block& block, const OutlineNoise& w, double spacing_m, const Shield& s,
           const PlaceFrame& frame, Terrain& t) {
  const bool scarp = s.edge_km < kScarp_km;
  // The shield covers nothing beyond: noise changes the radius by kFrayed at most, and the edge has its largest
  // width.
  const double outer = km_chord((s.radius_km + (scarp ? 3.0 : 0.9) * s.edge_km + 6.0) / (1.0 - kFrayed));
  if (!block.near(frame.up, outer)) return;

  Lane<double> east_km, north_km, radius_km, wobble, distorted_km, edge_km;
  std::int32_t any = 0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double x = block.x[i] - frame.up.x, y = block.y[i] - frame.up.y, z = block.z[i] - frame.up.z;
      const double e = (x * frame.east.x + y * frame.east.y) * (kRadius_m / 1000.0);
      const double n = (x * frame.north.x + y * frame.north.y + z * frame.north.z) * (kRadius_m / 1000.0);
      east_km[i] = e;
      north_km[i] = n;
      radius_km[i] = std::sqrt(e * e + n * n);
      wobble[i] = held(0.035 * static_cast<double>(w.km250[i]) + 0.03 * static_cast<double>(w.km100[i]) +
                           0.016 * static_cast<double>(w.km40[i]) + 0.006 * static_cast<double>(w.km16[i]),
                       kFrayed);
      // The summit keeps its published place and height, because the distortion grows outwards.
      const double out = clamp01(radius_km[i] / s.radius_km);
      distorted_km[i] = radius_km[i] * (1.0 + wobble[i] * out * out);
      edge_km[i] = s.edge_km * (1.2 + held(0.12 * static_cast<double>(w.km250[i]), 0.5));
      any |= static_cast<std::int32_t>(x * x + y * y + z * z <= outer * outer);
    }
  });
  if (any == 0) return;

  if (scarp) spread_aprons(block, spacing_m, {frame, s.radius_km}, distorted_km, t);
  // A cliff becomes talus at its foot; in places lava has flowed over it and made a ramp.
  Lane<double> draped{}, down{};
  bool on_cliff = false;
  if (scarp) {
    Lane<float> nicks{};
    if (spacing_m <= 2048.0) noise(block, 8e3, 0x241, nicks);
    for (std::size_t i = 0; i < block.padded; ++i) {
      draped[i] = ramp(0.7, 1.5, static_cast<double>(w.km250[i]));
      const double width = edge_km[i] * (0.75 + 2.5 * draped[i]);
      down[i] = clamp01(
          (distorted_km[i] - s.radius_km - held(1.1 * static_cast<double>(nicks[i]), 4.0)) / width + 0.5);
      on_cliff = on_cliff || (down[i] > 0.0 && down[i] < 1.0);
    }
  }
  Lane<double> rills{};
  if (on_cliff) {
    Points drawn;
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double back = kRadius_m * (1.0 + 0.75 * (s.radius_km / (radius_km[i] + 1.0) - 1.0));
      drawn.x[i] = (block.x[i] - frame.up.x) * back;
      drawn.y[i] = (block.y[i] - frame.up.y) * back;
      drawn.z[i] = (block.z[i] - frame.up.z) * back;
    }
    const Spurs spurs(drawn, block.padded, block.simd, spacing_m, 0x233U);
    for (std::size_t i = 0; i < block.padded; ++i) {
      down[i] = clamp01(down[i] - spurs.shift(i, down[i]) * (1.0 - draped[i]));
      rills[i] = spurs.rills_m(i, down[i]) * (1.0 - draped[i]);
    }
  }

  // Lava flows run down the flank: noise on a cylinder around the axis is stretched along the radius.
  Lane<float> flows{};
  Lane<float> fine{};
  Lane<float> finest{};
  Points drawn;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double stretch = 60.0 / (radius_km[i] + 12.0);
      drawn.x[i] = east_km[i] * stretch;
      drawn.y[i] = north_km[i] * stretch;
      drawn.z[i] = radius_km[i] * 0.03;
    }
  });
  if (spacing_m <= 2048.0) noise(drawn, block.padded, block.simd, 5.0, 0x200, flows);
  if (spacing_m <= 512.0) noise(drawn, block.padded, block.simd, 1.2, 0x211, fine);
  if (spacing_m <= 128.0) noise(drawn, block.padded, block.simd, 0.33, 0x222, finest);

  for (std::size_t i = 0; i < block.padded; ++i) {
    if (chord2(block.at(i), frame.up) > outer * outer) continue;
    const double r = distorted_km[i];
    const double cover = scarp ? (1.0 - down[i]) * (1.0 - down[i])
                               : ramp(s.radius_km + 0.5 * edge_km[i], s.radius_km - 0.5 * edge_km[i], r);
    if (cover <= 0.0) continue;
    const double u = clamp01((r - s.summit_km) / (s.radius_km - s.summit_km));
    const double fall = 1.0 - u - s.convexity * u * (u - 1.0);
    const double bench = u * (1.0 - u) * 4.0;
    double h = s.foot_m + (s.summit_m - s.foot_m) * fall;
    h += bench * (60.0 * static_cast<double>(flows[i]) + 34.0 * static_cast<double>(fine[i]) +
                  14.0 * static_cast<double>(finest[i]) + 90.0 * static_cast<double>(w.km40[i]) +
                  40.0 * static_cast<double>(w.km16[i]));
    // Slumping formed terraces on the upper flanks of the large shields.
    if (s.radius_km > 150.0 && s.convexity > 0.0) {
      const double step =
          r * (1.0 / 31.0) + 0.35 * static_cast<double>(w.km100[i]) + 0.5 * static_cast<double>(w.km250[i]);
      const double phase = step - floor_int(step);
      h += 0.008 * (s.summit_m - s.foot_m) * clamp01(0.6 + 0.6 * static_cast<double>(w.km100[i])) *
           (phase < 0.7 ? phase / 0.7 : (1.0 - phase) / 0.3) * bench * ramp(1.0, 0.5, u);
    }
    if (scarp) {
      const double steep = clamp01(1.5 - 1.5 * cover) * clamp01(cover * 8.0) * (1.0 - draped[i]);
      t.wall[i] = std::max(t.wall[i], static_cast<float>(steep));
      t.height_m[i] += rills[i];
    }
    // A scarp ends at its own height; gentler flanks are added to the plain and fade out.
    const double above = std::max(0.0, h - t.height_m[i]);
    t.height_m[i] =
        scarp ? mix(t.height_m[i], h, cover) : t.height_m[i] + cover * above * above / (above + 120.0);
    const auto keep = static_cast<float>(1.0 - cover);
    t.cratered[i] = t.cratered[i] * keep;
    t.rugged[i] = t.rugged[i] * keep;
    t.rough[i] = mix(0.5F, t.rough[i], keep);
    t.lowland[i] = t.lowland[i] * keep;
    t.volcanic[i] = std::max(t.volcanic[i], static_cast<float>(cover));
  }

  for (const Caldera& c : s.calderas) {
    if (c.radius_km <= 0.0) continue;
    const glm::dvec3 middle{
        frame.up.x + km_chord(c.east_km) * frame.east.x + km_chord(c.north_km) * frame.north.x,
        frame.up.y + km_chord(c.east_km) * frame.east.y + km_chord(c.north_km) * frame.north.y,
        frame.up.z + km_chord(c.north_km) * frame.north.z};
    if (!block.near(middle, km_chord(c.radius_km * 1.3 + 12.0))) continue;
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double d = std::sqrt(chord2(block.at(i), middle)) * (kRadius_m / 1000.0);
      const double rim =
          c.radius_km * (1.0 + held(0.05 * static_cast<double>(w.km16[i]) + 0.6 * wobble[i], 0.2));
      const double out = std::max(0.0, d - rim);
      // Walls have about 30 degrees with a gentler foot.
      const double wall =
          c.floor_m + 560.0 * out * out / (out + 0.6) + 6.0 * static_cast<double>(flows[i]) * clamp01(out);
      if (wall < t.height_m[i]) {
        const auto inside = static_cast<float>(clamp01((t.height_m[i] - wall) * 0.005));
        t.height_m[i] = wall;
        t.wall[i] = std::max(t.wall[i], inside * static_cast<float>(clamp01(out)));
        t.rough[i] = mix(t.rough[i], 0.25F, inside);
      }
    }
  }
}

}  // namespace

void raise_shields(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t) {
  lay_aureole(block, w, spacing_m, t);
  static const auto frames = [] {
    std::array<PlaceFrame, kShieldCount> all;
    for (std::size_t k = 0; k < kShieldCount; ++k)
      all[k] = place_frame(kShields[k].lon_deg, kShields[k].lat_deg);
    return all;
  }();
  for (std::size_t k = 0; k < kShieldCount; ++k) raise(block, w, spacing_m, kShields[k], frames[k], t);
}

}  // namespace mars::embedded
