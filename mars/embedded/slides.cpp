// Ground that slid off Olympus Mons: landslides and the aureole.
#include <algorithm>

#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

void spread_aprons(const Block& block, double spacing_m, const Foot& s, const Lane<double>& distorted_km,
                   Terrain& t) {
  constexpr double kLongest_km = 62.0;
  bool any = false;
  for (std::size_t i = 0; i < block.padded; ++i) {
    any = any || (distorted_km[i] > s.radius_km - 12.0 && distorted_km[i] < s.radius_km + kLongest_km);
  }
  if (!any) return;
  Points round;  // on a circle, so that features extend radially
  for (std::size_t i = 0; i < block.padded; ++i) {
    const double x = block.x[i] - s.frame.up.x, y = block.y[i] - s.frame.up.y, z = block.z[i] - s.frame.up.z;
    const double r = std::sqrt(x * x + y * y + z * z) + 1e-9;
    round.x[i] = x / r * s.radius_km;
    round.y[i] = y / r * s.radius_km;
    round.z[i] = z / r * s.radius_km + 0.06 * distorted_km[i];
  }
  Lane<float> lobes, grooves{};
  noise(round, block.padded, block.simd, 70.0, 0x251, lobes);
  if (spacing_m <= 2048.0) noise(round, block.padded, block.simd, 4.2, 0x262, grooves);
  for (std::size_t i = 0; i < block.padded; ++i) {
    const double lobe = ramp(-0.1, 0.5, static_cast<double>(lobes[i]));
    const double length_km = 18.0 + (kLongest_km - 18.0) * ramp(-0.2, 1.6, static_cast<double>(lobes[i]));
    const double run = (distorted_km[i] - s.radius_km + 6.0) / length_km;
    if (lobe <= 0.0 || run <= 0.0 || run >= 1.0) continue;
    const double there = lobe * ramp(0.0, 0.15, run) * ramp(1.0, 0.94, run);
    t.height_m[i] +=
        there * (560.0 - 430.0 * run + 150.0 * ramp(0.70, 0.92, run) + 60.0 * static_cast<double>(grooves[i]));
    t.rough[i] = std::max(t.rough[i], static_cast<float>(0.9 * there));
  }
}

void lay_aureole(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t) {
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
    Lane<double> distorted_km;
    bool any = false;
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double d = std::sqrt(chord2(block.at(i), lobe.centre)) * (kRadius_m / 1000.0);
      distorted_km[i] =
          d *
          (1.0 + held(0.06 * static_cast<double>(w.km100[i]) + 0.05 * static_cast<double>(w.km250[i]), 0.25));
      any = any || distorted_km[i] < lobe.radius_km;
    }
    if (!any) continue;
    Lane<float> ridges{};
    Lane<float> blocks{};
    noise(block, 27000.0, 0x213, ridges);
    if (spacing_m <= 4096.0) noise(block, 10500.0, 0x226, blocks);
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double r = distorted_km[i];
      const double cover = ramp(lobe.radius_km, lobe.radius_km - 25.0, r);
      if (cover <= 0.0) continue;
      // Rounded blocks are separated by sharp creases.
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

}  // namespace mars::embedded
