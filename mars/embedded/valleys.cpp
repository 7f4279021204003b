// Named small valleys, and the deltas that two of them built in Jezero.
#include <algorithm>
#include <iterator>

#include "mars/embedded/block.h"
#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

namespace {

struct Valley {
  glm::dvec3 a, b;
  double half_a_km, half_b_km, depth_a_m, depth_b_m;
};
constexpr Valley kValleys[] = {
    // Neretva Vallis into Jezero, Sava Vallis north of it, Pliva Vallis out of it
    {place(76.35, 18.78), place(76.80, 18.66), 0.5, 0.7, 60, 120},
    {place(76.80, 18.66), place(77.10, 18.60), 0.7, 0.9, 120, 260},
    {place(77.10, 18.60), place(77.27, 18.57), 0.9, 0.9, 330, 330},
    {place(77.27, 18.57), place(77.40, 18.52), 0.8, 0.3, 120, 20},
    {place(77.05, 19.15), place(77.38, 18.82), 0.4, 0.6, 60, 220},
    {place(77.95, 18.42), place(78.15, 18.50), 0.9, 0.9, 300, 280},
    {place(78.15, 18.50), place(78.75, 18.42), 0.8, 0.6, 200, 80},
    // Nirgal Vallis
    {place(314.4, -27.1), place(316.6, -27.9), 1.2, 2.0, 150, 350},
    {place(316.6, -27.9), place(319.4, -28.6), 2.0, 2.6, 350, 550},
    {place(319.4, -28.6), place(322.5, -29.4), 2.6, 3.2, 550, 800},
    // Nanedi Valles
    {place(310.6, 0.4), place(311.4, 3.6), 1.2, 2.0, 200, 420},
    {place(311.4, 3.6), place(312.2, 7.6), 2.0, 2.4, 420, 500},
    // Farah Vallis into Gale
    {place(136.95, -6.75), place(137.10, -6.20), 0.8, 1.3, 120, 330},
};

struct SedimentFan {
  PlaceFrame apex;
  SinCos towards;  // azimuth of its middle
  double radius_km, height_m;
};
constexpr SedimentFan kFans[] = {{place_frame(77.29, 18.565), exact_sin_cos_deg(122.0), 9.5, 105.0},
                                 {place_frame(77.42, 18.79), exact_sin_cos_deg(160.0), 5.0, 60.0}};

// Holds the noises that the pieces near a block share, computed at first use.
struct Sway {
  bool made = false;
  Lane<float> sway, fray;
  void make(const Block& block) {
    if (!made) noise(block, 5.5e3, 0x771, sway);
    if (!made) noise(block, 1.9e3, 0x782, fray);
    made = true;
  }
};

void carve(const Block& block, const Valley& v, Sway& s, Terrain& t) {
  const double length2 = chord2(v.a, v.b);
  const double widest = km_chord(std::max(v.half_a_km, v.half_b_km) + 1.5);
  if (!block.near((v.a + v.b) * 0.5, widest + 0.5 * std::sqrt(length2))) return;
  s.make(block);
  const auto &sway = s.sway, &fray = s.fray;
  const glm::dvec3 ab = v.b - v.a;
  const glm::dvec3 normal{v.a.y * v.b.z - v.a.z * v.b.y, v.a.z * v.b.x - v.a.x * v.b.z,
                          v.a.x * v.b.y - v.a.y * v.b.x};
  const glm::dvec3 side = normal * (1.0 / std::sqrt(chord2(normal, {0, 0, 0})));
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      // Shifting the place across the line makes meanders.
      const double shift = km_chord(0.32 * std::max(-2.5, std::min(2.5, static_cast<double>(sway[i]))) +
                                    0.12 * std::max(-2.5, std::min(2.5, static_cast<double>(fray[i]))));
      const double x = block.x[i] + shift * side.x - v.a.x;
      const double y = block.y[i] + shift * side.y - v.a.y;
      const double z = block.z[i] + shift * side.z - v.a.z;
      const double along = clamp01((x * ab.x + y * ab.y + z * ab.z) / length2);
      const double dx = x - along * ab.x, dy = y - along * ab.y, dz = z - along * ab.z;
      const double half = km_chord(mix(v.half_a_km, v.half_b_km, along));
      const double u = std::max(0.0, 1.0 - (dx * dx + dy * dy + dz * dz) / (half * half));
      const double down = std::min(1.0, 1.6 * u);
      t.height_m[i] -= mix(v.depth_a_m, v.depth_b_m, along) * down;
      // Terrain::wall is not set here: it would remove the large crater that the valley enters.
      t.cratered[i] *= 1.0F - 0.8F * static_cast<float>(down);
    }
  });
}

void build_fan(const Block& block, const SedimentFan& f, Terrain& t) {
  const double reach = km_chord(f.radius_km * 1.5);
  if (!block.near(f.apex.up, reach)) return;
  Lane<float> lobes, ridges;
  noise(block, 3.1e3, 0x793, lobes);
  noise(block, 0.7e3, 0x7a4, ridges);
  for (std::size_t i = 0; i < block.padded; ++i) {
    const glm::dvec3 v = block.at(i) - f.apex.up;
    const double e = (v.x * f.apex.east.x + v.y * f.apex.east.y) * (kRadius_m / 1000.0);
    const double n =
        (v.x * f.apex.north.x + v.y * f.apex.north.y + v.z * f.apex.north.z) * (kRadius_m / 1000.0);
    const double ahead = e * f.towards.sin + n * f.towards.cos;
    const double aside = e * f.towards.cos - n * f.towards.sin;
    const double r = std::sqrt(e * e + n * n);
    if (r > 1.45 * f.radius_km) continue;
    const double front = f.radius_km * (0.85 + 0.09 * held(static_cast<double>(lobes[i]), 2.5)) +
                         0.25 * held(static_cast<double>(ridges[i]), 2.5);
    const double open = ramp(0.30, 0.62, (ahead + 0.6) / (r + 0.3));
    // The delta is nearly flat on top, with a scarp at the front.
    const double body = ramp(0.0, 0.55, front - r) * open;
    if (body <= 0.0) continue;
    const double fallen = 1.0 - 0.45 * r / f.radius_km;
    const double trail = 5.0 * static_cast<double>(ridges[i]) + 0.4 * std::abs(aside);
    t.height_m[i] += body * (f.height_m * fallen + trail);
    t.mound[i] = std::max(t.mound[i], static_cast<float>(0.55 * body));
    t.cratered[i] *= 1.0F - 0.7F * static_cast<float>(body);
  }
}

}  // namespace

void carve_valleys(const Block& block, double spacing_m, Terrain& t) {
  if (spacing_m > 1024.0) return;
  Sway sway;
  for (const Valley& v : kValleys) carve(block, v, sway, t);
  for (const SedimentFan& f : kFans) build_fan(block, f, t);
}

}  // namespace mars::embedded
