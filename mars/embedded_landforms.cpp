#include "mars/embedded_landforms.h"

#include <algorithm>
#include <optional>

#include "mars/embedded_math.h"
#include "mars/embedded_noise.h"
#include "mars/embedded_relief.h"
#include "mars/embedded_spurs.h"

namespace mars::embedded {

namespace {

enum class Kind : std::uint8_t { kLava, kRidgedPlain, kMassifs };

// A disc of one kind of ground with a ragged edge; massifs stand in the ring inner_km..radius_km.
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
    {Kind::kRidgedPlain, place(294.0, 8.0), 720, 0},    // Lunae
    {Kind::kRidgedPlain, place(300.0, -10.0), 420, 0},  // Ophir Planum
    {Kind::kRidgedPlain, place(67.1, 9.2), 620, 0},     // Syrtis Major
    {Kind::kRidgedPlain, place(110.0, -21.0), 560, 0},  // Hesperia
    {Kind::kRidgedPlain, place(67.0, -60.0), 480, 0},   // Malea
    {Kind::kMassifs, place(316.7, -49.8), 850, 400},    // Charitum and Nereidum around Argyre
    {Kind::kMassifs, place(70.5, -42.4), 1600, 950},    // Hellas rim
    {Kind::kMassifs, place(88.4, 13.0), 950, 600},      // Libya Montes around Isidis
    {Kind::kMassifs, place(275.0, -38.0), 900, 500},    // Thaumasia highlands
};

// Shields whose edge is narrower than this end in a cliff.
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
  double edge_km;       // width over which the flank gives way to the plain; small = a scarp
  double convexity;     // 0 cone .. 1 dome
  Caldera calderas[6];  // radius 0 = none
};

constexpr Shield kShields[] = {
    // The nested caldera of Olympus: main pit and five collapses, 80 x 60 km.
    {226.20,
     18.65,
     297,
     21230,
     5600,
     46,
     21,
     0.35,
     {{10, -14, 27, 18900},
      {-14, -10, 16, 18300},
      {24, 6, 13, 18600},
      {-4, 9, 12, 18100},
      {30, -16, 9, 18250},
      {4, -34, 11, 18750}}},
    {255.92,
     11.92,
     222,
     18200,
     5600,
     30,
     70,
     0.25,
     {{0, 0, 13, 14900}, {-14, 5, 11, 16600}, {5, -14, 10, 16900}, {12, 9, 9, 16500}, {-6, -10, 8, 16800}, {}}},
    {247.04, 1.48, 188, 14100, 5200, 45, 70, 0.30, {{4, -4, 21, 9600}, {-10, 14, 40, 13300}, {}, {}, {}, {}}},
    {239.91, -8.26, 228, 17760, 8300, 62, 130, 0.35, {{0, 0, 55, 16500}, {}, {}, {}, {}, {}}},
    {147.21, 25.02, 205, 14100, -900, 9, 190, -0.9, {{0, 0, 6, 13500}, {}, {}, {}, {}, {}}},
    {250.40, 40.47, 290, 6800, 4200, 70, 240, 0.7, {{0, 0, 32, 5900}, {14, -18, 22, 5700}, {}, {}, {}, {}}},
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

void raise(const Block& block, const Wander& w, double spacing_m, const Shield& s, Terrain& t) {
  const PlaceFrame frame = place_frame(s.lon_deg, s.lat_deg);
  const bool scarp = s.edge_km < kScarp_km;
  // Beyond it nothing is covered: the radius is frayed by kFrayed at most, and the edge has its largest width.
  const double outer = km_chord((s.radius_km + (scarp ? 2.9 : 0.9) * s.edge_km + 6.0) / (1.0 - kFrayed));
  if (!block.near(frame.up, outer)) return;

  // Flows run down the flank: noise on a cylinder about the axis, stretched along the radius.
  Lane<float> flows{};
  Lane<float> fine{};
  Lane<float> finest{};
  Points drawn, wall_drawn;
  Lane<double> radius_km, wobble;
  for (std::size_t i = 0; i < block.padded; ++i) {
    const glm::dvec3 v{block.x[i] - frame.up.x, block.y[i] - frame.up.y, block.z[i] - frame.up.z};
    const double e = (v.x * frame.east.x + v.y * frame.east.y) * (kRadius_m / 1000.0);
    const double n = (v.x * frame.north.x + v.y * frame.north.y + v.z * frame.north.z) * (kRadius_m / 1000.0);
    const double r = std::sqrt(e * e + n * n);
    radius_km[i] = r;
    const double stretch = 60.0 / (r + 12.0);
    drawn.x[i] = e * stretch;
    drawn.y[i] = n * stretch;
    drawn.z[i] = r * 0.03;
    const double back = kRadius_m * (1.0 + 0.75 * (s.radius_km / (r + 1.0) - 1.0));
    wall_drawn.x[i] = v.x * back;
    wall_drawn.y[i] = v.y * back;
    wall_drawn.z[i] = v.z * back;
  }
  if (spacing_m <= 2048.0) noise(drawn, block.padded, block.simd, 5.0, 0x200, flows);
  if (spacing_m <= 512.0) noise(drawn, block.padded, block.simd, 1.2, 0x211, fine);
  if (spacing_m <= 128.0) noise(drawn, block.padded, block.simd, 0.33, 0x222, finest);
  std::optional<Spurs> spurs;
  Lane<float> nicks{};
  if (scarp) {
    spurs.emplace(wall_drawn, block.padded, block.simd, spacing_m, 0x233U);
    if (spacing_m <= 2048.0) noise(block, 8e3, 0x241, nicks);
  }

  for (std::size_t i = 0; i < block.padded; ++i) {
    const double ragged =
        held(0.035 * static_cast<double>(w.km250[i]) + 0.03 * static_cast<double>(w.km100[i]) +
                 0.016 * static_cast<double>(w.km40[i]) + 0.006 * static_cast<double>(w.km16[i]),
             kFrayed);
    wobble[i] = ragged;
    // The summit keeps its published place and height: the outline frays only further out.
    if (chord2(block.at(i), frame.up) > outer * outer) continue;
    const double out = clamp01(radius_km[i] / s.radius_km);
    const double r = radius_km[i] * (1.0 + ragged * out * out);
    const double edge = s.edge_km * (1.2 + held(0.12 * static_cast<double>(w.km250[i]), 0.5));
    double cover = ramp(s.radius_km + 0.5 * edge, s.radius_km - 0.5 * edge, r);
    double rills = 0.0;
    double draped = 0.0;
    if (scarp) {
      // A cliff that eases off into talus; in places lava has poured over it and made a ramp.
      draped = ramp(0.7, 1.5, static_cast<double>(w.km250[i]));
      const double width = edge * (0.75 + 2.5 * draped);
      const double t0 =
          clamp01((r - s.radius_km - held(1.1 * static_cast<double>(nicks[i]), 4.0)) / width + 0.5);
      const double down = clamp01(t0 - spurs->shift(i, t0) * (1.0 - draped));
      cover = (1.0 - down) * (1.0 - down);
      rills = spurs->rills_m(i, down) * (1.0 - draped);
    }
    if (cover <= 0.0) continue;
    const double u = clamp01((r - s.summit_km) / (s.radius_km - s.summit_km));
    const double fall = 1.0 - u - s.convexity * u * (u - 1.0);
    const double bench = u * (1.0 - u) * 4.0;
    double h = s.foot_m + (s.summit_m - s.foot_m) * fall;
    h += bench * (60.0 * static_cast<double>(flows[i]) + 34.0 * static_cast<double>(fine[i]) +
                  14.0 * static_cast<double>(finest[i]) + 90.0 * static_cast<double>(w.km40[i]) +
                  40.0 * static_cast<double>(w.km16[i]));
    if (scarp) {
      const double steep = clamp01(1.5 - 1.5 * cover) * clamp01(cover * 8.0) * (1.0 - draped);
      t.wall[i] = std::max(t.wall[i], static_cast<float>(steep));
      t.height_m[i] += rills;
    }
    t.height_m[i] = mix(t.height_m[i], h, cover);
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
      // Walls at about 30 degrees with a gentler foot.
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

// Lobes of ridged ground that slid off Olympus, farthest to the north-west.
void lay_aureole(const Block& block, const Wander& w, double spacing_m, Terrain& t) {
  struct Lobe {
    glm::dvec3 centre;
    double radius_km, height_m;
  };
  static constexpr Lobe kLobes[] = {{place(218.0, 24.5), 430, 1100},
                                    {place(223.0, 29.0), 380, 800},
                                    {place(216.0, 17.0), 330, 800},
                                    {place(229.0, 11.0), 300, 600},
                                    {place(233.5, 23.5), 260, 500}};
  for (const Lobe& lobe : kLobes) {
    if (!block.near(lobe.centre, km_chord(lobe.radius_km * 1.4))) continue;
    Lane<float> ridges{};
    Lane<float> blocks{};
    noise(block, 27000.0, 0x213, ridges);
    if (spacing_m <= 4096.0) noise(block, 10500.0, 0x226, blocks);
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double d = std::sqrt(chord2(block.at(i), lobe.centre)) * (kRadius_m / 1000.0);
      const double r =
          d *
          (1.0 + held(0.06 * static_cast<double>(w.km100[i]) + 0.05 * static_cast<double>(w.km250[i]), 0.25));
      const double cover = ramp(lobe.radius_km, lobe.radius_km - 25.0, r);
      if (cover <= 0.0) continue;
      // Rounded blocks between sharp creases.
      const double n = static_cast<double>(ridges[i]);
      const double m = static_cast<double>(blocks[i]);
      const double crest = 0.6 * std::min(1.6, n < 0.0 ? -n : n) + 0.3 * std::min(1.6, m < 0.0 ? -m : m);
      const double swell = 0.45 + 0.55 * ramp(0.3, 1.0, r / lobe.radius_km);
      t.height_m[i] += cover * lobe.height_m * (swell * 0.7 + 0.45 * crest);
      t.rough[i] = std::max(t.rough[i], static_cast<float>(cover));
      t.rugged[i] = std::max(t.rugged[i], static_cast<float>(0.45 * cover));
    }
  }
}

}  // namespace

void add_octave(const Block& block, int k, Octaves& out) {
  noise(block, static_cast<double>(1 << k), 0x500U + static_cast<std::uint32_t>(k) * 0x1dU,
        out.n[static_cast<std::size_t>(k)]);
}

void lay_provinces(const Block& block, const Wander& w, Terrain& t) {
  Lane<double>& h = t.height_m;
  relief(block, h);
  // Slopes between plains and highlands that are not the dichotomy's.
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
  for (std::size_t i = 0; i < block.padded; ++i) {
    // The dichotomy: steepen the broad slope between plains and highlands, and fray it where it is steep.
    constexpr double kMiddle_m = -2000.0;
    constexpr double kHalf_m = 1900.0;
    const double x0 = (h[i] - kMiddle_m) * (1.0 / kHalf_m);
    const double close = std::max(0.0, 1.0 - x0 * x0) * boundary[i];
    const double frayed =
        h[i] + close * (420.0 * static_cast<double>(w.km100[i]) + 300.0 * static_cast<double>(w.km250[i]) +
                        170.0 * static_cast<double>(w.km40[i]) + 60.0 * static_cast<double>(w.km16[i]));
    const double x = (frayed - kMiddle_m) * (1.0 / kHalf_m);
    const double near = std::max(0.0, 1.0 - x * x);
    h[i] = frayed + 0.95 * boundary[i] * kHalf_m * x * near * near;

    const auto highland =
        static_cast<float>(ramp(-2700.0, -1200.0, h[i] + 250.0 * static_cast<double>(w.km250[i])));
    t.lowland[i] = 1.0F - highland;
    // The broad relief is a mean with craters; ours are still to be dug.
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
  for (const Province& p : kProvinces) {
    if (!block.near(p.centre, km_chord(p.radius_km * 1.6))) continue;
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double ragged = 1.0 + 0.09 * clamp01(static_cast<double>(w.km600[i]) * 0.5 + 0.5) +
                            0.10 * clamp01(static_cast<double>(w.km250[i]) * 0.5 + 0.5) +
                            0.06 * clamp01(static_cast<double>(w.km100[i]) * 0.5 + 0.5);
      const double d = std::sqrt(chord2(block.at(i), p.centre)) * (kRadius_m / 1000.0) * ragged;
      const auto cover = static_cast<float>(ramp(p.radius_km * 1.15, p.radius_km * 0.9, d));
      if (cover <= 0.0F) continue;
      switch (p.kind) {
        case Kind::kLava:
          t.volcanic[i] = std::max(t.volcanic[i], cover);
          t.cratered[i] = std::min(t.cratered[i], mix(1.0F, 0.03F, cover));
          t.rugged[i] = std::min(t.rugged[i], mix(1.3F, 0.22F, cover));
          t.rough[i] = std::min(t.rough[i], mix(1.0F, 0.5F, cover));
          break;
        case Kind::kRidgedPlain:
          t.volcanic[i] = std::max(t.volcanic[i], 0.6F * cover);
          t.cratered[i] = std::min(t.cratered[i], mix(1.0F, 0.16F, cover));
          t.rugged[i] = std::min(t.rugged[i], mix(1.3F, 0.22F, cover));
          t.rough[i] = std::min(t.rough[i], mix(1.0F, 0.4F, cover));
          break;
        case Kind::kMassifs: {
          const auto ring = cover * static_cast<float>(ramp(p.inner_km * 0.85, p.inner_km * 1.2, d));
          t.rugged[i] = std::max(t.rugged[i], mix(t.rugged[i], 2.6F, ring));
          t.rough[i] = std::max(t.rough[i], 1.5F * ring);
          break;
        }
      }
    }
  }
}

void raise_shields(const Block& block, const Wander& w, double spacing_m, Terrain& t) {
  lay_aureole(block, w, spacing_m, t);
  for (std::size_t k = 0; k < kShieldCount; ++k) raise(block, w, spacing_m, kShields[k], t);
}

void terrain(const Block& block, const Octaves& octaves, double spacing_m, Terrain& out) {
  const Wander w(octaves);
  lay_provinces(block, w, out);
  raise_shields(block, w, spacing_m, out);
  crack_noctis(block, w, spacing_m, out);
  cut_troughs(block, w, spacing_m, out);
  pile_mounds(block, w, spacing_m, out);
  lay_caps(block, w, out);
}

}  // namespace mars::embedded
