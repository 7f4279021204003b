#include <algorithm>
#include <array>
#include <iterator>

#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

namespace {

// Describes a dome of layered ice around a point near the pole, with troughs that spiral outwards.
struct Cap {
  glm::dvec3 middle;
  double radius_km;
  double thickness_m;
  double flatness;              // 1 parabolic dome; less = flatter with a steeper edge
  double sense;                 // of the spiral, +-1
  double between_km, groove_m;  // of its troughs
  double grooved;               // 0..1: share of the cap that has them
};
constexpr Cap kCaps[] = {{place(20.0, 87.8), 535, 3150, 0.45, 1.0, 47, 620, 0.9},
                         {place(160.0, -85.3), 680, 2900, 1.0, -1.0, 58, 420, 0.55}};

// Returns the angle of (x, y) in full circles, -0.5..0.5, within 2e-3. A polynomial, because libm differs in
// bits.
double angle_in_circles(double x, double y) {
  const double ax = x < 0.0 ? -x : x;
  const double ay = y < 0.0 ? -y : y;
  const double big = std::max(ax, ay) + 1e-300;
  const double q = std::min(ax, ay) / big;
  double a = q * (0.25 + 0.273 * (1.0 - q) / kPi) * 0.5;
  if (ay > ax) a = 0.25 - a;
  if (x < 0.0) a = 0.5 - a;
  return y < 0.0 ? -a : a;
}

// Canyons into the caps, from head to mouth: Chasma Boreale, Chasma Australe, Promethei Chasma.
struct Reach {
  glm::dvec3 a, b;
  double half_a_km, half_b_km;
};
constexpr Reach kChasmata[] = {
    {place(4.0, 85.35), place(348.0, 85.0), 10, 21},    {place(348.0, 85.0), place(331.0, 84.2), 21, 31},
    {place(331.0, 84.2), place(318.0, 82.9), 31, 46},   {place(318.0, 82.9), place(309.0, 81.2), 46, 66},
    {place(309.0, 81.2), place(303.5, 79.4), 66, 95},   {place(276.0, -87.2), place(271.0, -84.0), 7, 16},
    {place(271.0, -84.0), place(267.0, -80.2), 16, 34}, {place(150.0, -84.4), place(141.0, -82.3), 10, 20},
    {place(141.0, -82.3), place(134.0, -80.3), 20, 36},
};

// Holds the canyons near a block.
struct Near {
  std::array<const Reach*, std::size(kChasmata)> reaches;
  std::size_t count = 0;

  explicit Near(const Block& block) {
    constexpr double kFringe_km = 40.0;
    for (const Reach& r : kChasmata) {
      const double wide = km_chord(std::max(r.half_a_km, r.half_b_km) + kFringe_km);
      if (block.near((r.a + r.b) * 0.5, wide + 0.5 * std::sqrt(chord2(r.a, r.b)))) reaches[count++] = &r;
    }
  }

  // Returns kilometres inside the nearest rim, negative outside, at least -30.
  double inside_km(const glm::dvec3& here) const {
    double inside = -30.0;
    for (std::size_t k = 0; k < count; ++k) {
      const Reach& r = *reaches[k];
      const glm::dvec3 ab = r.b - r.a;
      const glm::dvec3 v = here - r.a;
      const double t = clamp01((v.x * ab.x + v.y * ab.y + v.z * ab.z) / chord2(r.a, r.b));
      const double d = std::sqrt(chord2(v, ab * t)) * (kRadius_m / 1000.0);
      inside = std::max(inside, mix(r.half_a_km, r.half_b_km, t) - d);
    }
    return inside;
  }
};

}  // namespace

void lay_caps(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t) {
  for (const Cap& c : kCaps) {
    if (!block.near(c.middle, km_chord(c.radius_km * 1.3))) continue;
    Lane<float> distortion;
    noise(block, 150e3, 0x417, distortion);
    const Near canyons(block);
    for (std::size_t i = 0; i < block.padded; ++i) {
      const glm::dvec3 v = block.at(i) - c.middle;
      const double flat = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z) * (kRadius_m / 1000.0);
      const double r =
          flat / c.radius_km *
          (1.0 + held(0.06 * static_cast<double>(w.km250[i]) + 0.035 * static_cast<double>(w.km100[i]) +
                          0.012 * static_cast<double>(w.km40[i]),
                      0.2));
      if (r >= 1.0) continue;
      // The chart is centred at the pole itself, so that the troughs wind around it.
      const double e = block.x[i] * (kRadius_m / 1000.0);
      const double n = block.y[i] * (kRadius_m / 1000.0);
      const double polar_km = std::sqrt(e * e + n * n);
      const double dome = 1.0 - r * r;
      const double thick = c.thickness_m * dome / (c.flatness + (1.0 - c.flatness) * dome);
      const double wind = angle_in_circles(e, n) * 5.0 * c.sense + polar_km / c.between_km +
                          0.34 * static_cast<double>(distortion[i]) + 0.04 * static_cast<double>(w.km40[i]);
      const double phase = wind - floor_int(wind);
      // Steep towards the equator, gentle towards the pole.
      const double groove = ramp(0.0, 0.34, phase) * ramp(0.56, 0.42, phase);
      const double where = ramp(40.0, 130.0, polar_km) * ramp(1.0, 0.86, r) *
                           clamp01(c.grooved + 0.7 * static_cast<double>(w.km250[i]));
      double h = thick - c.groove_m * groove * where;
      const double canyon =
          canyons.inside_km(block.at(i)) +
          held(5.0 * static_cast<double>(w.km40[i]) + 2.2 * static_cast<double>(w.km16[i]), 25.0);
      const double cut = ramp(0.0, 9.0, canyon);
      h = mix(h, std::min(h, 160.0 + 0.12 * h), cut);
      const double steep = std::max(groove * (1.0 - groove) * 4.0 * where, 4.0 * cut * (1.0 - cut));
      if (spacing_m <= 256.0) {
        // Layers show as ledges where they are cut.
        const double bed = h * (1.0 / 85.0);
        const double layer = bed - floor_int(bed);
        h += 85.0 * 0.5 * (layer * layer * (3.0 - 2.0 * layer) - layer) * std::min(1.0, steep * 1.5);
      }
      h = std::max(0.0, h);
      const auto cover = static_cast<float>(ramp(1.0, 0.94, r));
      t.height_m[i] += h;
      t.ice[i] = cover * static_cast<float>((1.0 - 0.35 * groove * where) * (1.0 - 0.85 * cut));
      t.cratered[i] = t.cratered[i] * (1.0F - cover);
      t.rugged[i] = mix(t.rugged[i], 0.10F, cover);
      t.rough[i] = mix(t.rough[i], 0.18F, cover);
      t.wall[i] = std::max(t.wall[i], static_cast<float>(std::max(0.9 * groove * where, cut)));
    }
  }
}

}  // namespace mars::embedded
