#include "mars/embedded/landforms.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/bumps.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/relief_table.h"

namespace mars::embedded {

namespace {

// Sets out[i] to the broad height of Mars in metres: dichotomy, Tharsis, Hellas and everything longer than
// about 600 km. The rounded coefficients of 2000 bumps (bumps.h) were fitted to the MOLA topography (Smith et
// al. 2001) without troughs and shields; the root-mean-square difference of the fit is 365 m.
void broad_relief(const Block& block, Lane<double>& out) {
  constexpr double kReach = 0.165;  // chord on the unit sphere: 560 km
  static const Bumps<std::int16_t> bumps{bump_centres(static_cast<int>(kReliefTable.size())), kReliefTable,
                                         kReach, kReliefStep_m};
  sum_bumps(block, bumps, out);
}

enum class Kind : std::uint8_t { kLava, kRidgedPlain, kHummocks, kMassifs };

// Describes a disc of one kind of ground with a ragged edge; massifs stand in the ring inner_km..radius_km.
struct Province {
  Kind kind;
  glm::dvec3 centre;
  double radius_km;
  double inner_km;
};

constexpr Province kProvinces[] = {
    {Kind::kLava, place(247.0, 3.0), 1500, 0},          // Tharsis Montes
    {Kind::kLava, place(224.0, 20.0), 1150, 0},         // Olympus and its aureole
    {Kind::kLava, place(250.0, 38.0), 1000, 0},         // Alba
    {Kind::kLava, place(262.0, -12.0), 750, 0},         // Syria
    {Kind::kLava, place(147.5, 25.0), 850, 0},          // Elysium Mons
    {Kind::kLava, place(162.0, 5.0), 850, 0},           // Cerberus plains
    {Kind::kRidgedPlain, place(272.0, -25.0), 620, 0},  // Solis
    {Kind::kRidgedPlain, place(287.0, -20.0), 520, 0},  // Sinai, Thaumasia
    {Kind::kRidgedPlain, place(293.0, 11.0), 780, 0},   // Lunae
    {Kind::kRidgedPlain, place(283.0, 1.0), 420, 0},    // between Tharsis and Echus
    {Kind::kLava, place(273.0, 22.0), 820, 0},          // west of Kasei
    {Kind::kLava, place(278.0, -8.0), 330, 0},          // about Ius and Tithonium
    {Kind::kRidgedPlain, place(297.0, -9.5), 520, 0},   // Ophir Planum
    {Kind::kRidgedPlain, place(67.1, 9.2), 620, 0},     // Syrtis Major
    {Kind::kRidgedPlain, place(110.0, -21.0), 560, 0},  // Hesperia
    {Kind::kRidgedPlain, place(67.0, -60.0), 480, 0},   // Malea
    {Kind::kHummocks, place(70.0, -41.0), 520, 0},      // Alpheus Colles
    {Kind::kHummocks, place(200.0, -3.0), 480, 0},      // Medusae Fossae, yardangs
    {Kind::kMassifs, place(316.7, -49.8), 850, 400},    // Charitum and Nereidum around Argyre
    {Kind::kMassifs, place(70.5, -42.4), 1600, 950},    // Hellas rim
    {Kind::kMassifs, place(88.4, 13.0), 950, 600},      // Libya Montes around Isidis
    {Kind::kMassifs, place(275.0, -38.0), 900, 500},    // Thaumasia highlands
};

// Describes a broad swell or hollow along a line, too narrow for broad_relief().
struct Swell {
  glm::dvec3 a, b;
  double half_km, height_m;
};
constexpr Swell kSwells[] = {
    {place(55.5, -37.0), place(56.5, -46.0), 210, -550},   // Hellas: the deep trough along its western wall
    {place(57.0, -35.5), place(66.0, -32.5), 190, -700},   // and round to the north-west
    {place(56.5, -46.0), place(64.0, -52.0), 190, -300},   // and to the south-west
    {place(66.5, -40.0), place(74.0, -39.0), 260, 120},    // Alpheus Colles
    {place(238.6, -10.0), place(233.5, -16.0), 190, 900},  // aprons of lava from the rifts of Arsia,
    {place(241.4, -6.0), place(244.5, -2.5), 150, 700},
    {place(245.8, 0.0), place(244.6, -2.0), 130, 400},  // Pavonis,
    {place(248.6, 3.4), place(252.0, 6.6), 150, 700},
    {place(254.4, 10.0), place(252.2, 7.6), 140, 600},  // and Ascraeus
    {place(257.6, 14.0), place(262.0, 18.5), 170, 800},
    {place(254.0, 44.5), place(258.5, 45.5), 260, -700},   // north-eastern flank of Alba
    {place(285.0, -31.0), place(270.0, -37.0), 160, 500},  // the rise of southern Thaumasia
};

// Applies a province to the ground. d_km is the distorted distance from its centre.
void cover_with(const Block& block, const Province& p, const Lane<double>& d_km, const Lane<float>& cover,
                Terrain& t) {
  const auto lay = [&](float volcanic, float cratered, float rough) {
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const bool on = cover[i] > 0.0F;
        t.volcanic[i] = on ? std::max(t.volcanic[i], volcanic * cover[i]) : t.volcanic[i];
        t.cratered[i] = on ? std::min(t.cratered[i], mix(1.0F, cratered, cover[i])) : t.cratered[i];
        t.rugged[i] = on ? std::min(t.rugged[i], mix(1.3F, 0.22F, cover[i])) : t.rugged[i];
        t.rough[i] = on ? std::min(t.rough[i], mix(1.0F, rough, cover[i])) : t.rough[i];
      }
    });
  };
  switch (p.kind) {
    case Kind::kLava: return lay(1.0F, 0.03F, 0.5F);
    case Kind::kRidgedPlain: return lay(0.6F, 0.16F, 0.4F);
    case Kind::kHummocks:
      for (std::size_t i = 0; i < block.padded; ++i) {
        t.rugged[i] = std::max(t.rugged[i], 0.75F * cover[i]);
        t.rough[i] = std::max(t.rough[i], 1.1F * cover[i]);
      }
      return;
    case Kind::kMassifs:
      for (std::size_t i = 0; i < block.padded; ++i) {
        if (cover[i] <= 0.0F) continue;
        const auto ring = cover[i] * static_cast<float>(ramp(p.inner_km * 0.85, p.inner_km * 1.2, d_km[i]));
        t.rugged[i] = std::max(t.rugged[i], mix(t.rugged[i], 2.6F, ring));
        t.rough[i] = std::max(t.rough[i], 1.5F * ring);
      }
  }
}

}  // namespace

void add_octave(const Block& block, int k, Octaves& out) {
  noise(block, static_cast<double>(1 << k), 0x500U + static_cast<std::uint32_t>(k) * 0x1dU,
        out.n[static_cast<std::size_t>(k)]);
}

void lay_provinces(const Block& block, const OutlineNoise& w, Terrain& t) {
  Lane<double>& h = t.height_m;
  broad_relief(block, h);
  for (const Swell& s : kSwells) {
    const double half = km_chord(s.half_km);
    const double length2 = chord2(s.a, s.b);
    if (!block.near((s.a + s.b) * 0.5, half + 0.5 * std::sqrt(length2))) continue;
    const glm::dvec3 ab = s.b - s.a;
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const double x = block.x[i] - s.a.x, y = block.y[i] - s.a.y, z = block.z[i] - s.a.z;
        const double along = clamp01((x * ab.x + y * ab.y + z * ab.z) / length2);
        const double dx = x - along * ab.x, dy = y - along * ab.y, dz = z - along * ab.z;
        const double u = std::max(0.0, 1.0 - (dx * dx + dy * dy + dz * dz) / (half * half));
        h[i] += s.height_m * u * u;
      }
    });
  }
  // Basins have slopes between plains and highlands that do not belong to the dichotomy.
  struct Basin {
    glm::dvec3 centre;
    double radius_km;
  };
  static constexpr Basin kOthers[] = {{place(316.7, -49.8), 900}, {place(148.0, 24.0), 1000}};
  Lane<double> boundary;
  boundary.fill(1.0);
  for (const Basin& b : kOthers) {
    const double reach = km_chord(b.radius_km);
    if (!block.near(b.centre, reach)) continue;
    for (std::size_t i = 0; i < block.padded; ++i) {
      boundary[i] = std::min(boundary[i], ramp(0.5, 1.0, chord2(block.at(i), b.centre) / (reach * reach)));
    }
  }
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      // At the dichotomy the broad slope between plains and highlands becomes steeper and irregular.
      constexpr double kMiddle_m = -2000.0;
      constexpr double kHalf_m = 1900.0;
      const double x0 = (h[i] - kMiddle_m) * (1.0 / kHalf_m);
      const double close = std::max(0.0, 1.0 - x0 * x0) * boundary[i];
      const double frayed =
          h[i] + close * (420.0 * static_cast<double>(w.km100[i]) + 300.0 * static_cast<double>(w.km250[i]) +
                          130.0 * static_cast<double>(w.km40[i]) + 40.0 * static_cast<double>(w.km16[i]));
      const double x = (frayed - kMiddle_m) * (1.0 / kHalf_m);
      const double near = std::max(0.0, 1.0 - x * x);
      h[i] = frayed + 0.95 * boundary[i] * kHalf_m * x * near * near;

      const auto highland =
          static_cast<float>(ramp(-2700.0, -1200.0, h[i] + 250.0 * static_cast<double>(w.km250[i])));
      t.lowland[i] = 1.0F - highland;
      // The broad relief is a mean that includes craters, which are subtracted later.
      h[i] += 210.0 * static_cast<double>(highland);
      t.cratered[i] = 0.04F + 0.96F * highland;
      t.rugged[i] = 0.10F + 0.90F * highland * (1.0F + 0.25F * std::max(-1.5F, std::min(1.5F, w.km600[i])));
      t.rough[i] = 0.30F + 0.70F * highland;
      t.volcanic[i] = 0.0F;
      t.wall[i] = 0.0F;
      t.trough[i] = 0.0F;
      t.mound[i] = 0.0F;
      t.ice[i] = 0.0F;
    }
  });
  for (const Province& p : kProvinces) {
    if (!block.near(p.centre, km_chord(p.radius_km * 1.16))) continue;
    Lane<double> d;
    Lane<float> cover;
    std::int32_t any = 0;
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const double ragged = 1.0 + 0.09 * clamp01(static_cast<double>(w.km600[i]) * 0.5 + 0.5) +
                              0.10 * clamp01(static_cast<double>(w.km250[i]) * 0.5 + 0.5) +
                              0.06 * clamp01(static_cast<double>(w.km100[i]) * 0.5 + 0.5);
        const double x = block.x[i] - p.centre.x, y = block.y[i] - p.centre.y, z = block.z[i] - p.centre.z;
        d[i] = std::sqrt(x * x + y * y + z * z) * (kRadius_m / 1000.0) * ragged;
        cover[i] = static_cast<float>(ramp(p.radius_km * 1.15, p.radius_km * 0.9, d[i]));
        any |= static_cast<std::int32_t>(cover[i] > 0.0F);
      }
    });
    if (any != 0) cover_with(block, p, d, cover, t);
  }
}

void terrain(const Block& block, const Octaves& octaves, double spacing_m, Terrain& out) {
  const OutlineNoise w(octaves);
  lay_provinces(block, w, out);
  raise_shields(block, w, spacing_m, out);
  crack_noctis(block, w, spacing_m, out);
  cut_troughs(block, w, spacing_m, out);
  carve_valleys(block, spacing_m, out);
  pile_mounds(block, w, spacing_m, out);
  lay_caps(block, w, spacing_m, out);
}

}  // namespace mars::embedded
