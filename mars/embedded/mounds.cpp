#include <algorithm>
#include <array>

#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/spurs.h"

namespace mars::embedded {

namespace {

// Describes a layered mound inside the chasmata, or the one in Gale.
struct Mound {
  double lon_deg, lat_deg, long_km, short_km, azimuth_deg, height_m;
  bool layered;  // else made of the rock of the walls
};
constexpr Mound kMounds[] = {
    {285.6, -6.4, 62, 30, 82, 4300, true},   // Ceti Mensa, western Candor
    {289.8, -6.9, 60, 26, 100, 3900, true},  // Candor Mensa and the east
    {292.4, -7.8, 42, 24, 110, 3000, true},   {287.6, -3.9, 44, 24, 78, 3200, true},   // Ophir
    {287.8, -12.1, 58, 26, 105, 2300, true},  {286.6, -9.7, 34, 20, 60, 1500, true},   // Melas
    {283.9, -1.05, 62, 20, 92, 4800, true},                                            // Hebes Mensa
    {311.2, -7.3, 54, 20, 96, 2900, true},                                             // Ganges Mensa
    {313.4, -12.9, 60, 40, 60, 2300, true},                                            // Capri Mensa
    {298.5, -4.3, 26, 17, 20, 1800, true},                                             // Juventae
    {301.2, -13.62, 125, 9, 97, 3000, false},                                          // the ridge in Coprates
    {296.0, -12.35, 60, 6, 101, 1500, false}, {288.6, -11.4, 40, 22, 120, 900, true},  // Melas, east
    {284.6, -5.2, 30, 14, 95, 1600, true},                                             // Candor, north-west
    {320.5, -12.6, 46, 24, 70, 1500, true},                                            // Eos
    {137.85, -5.08, 46, 25, 62, 7250, true},                                           // Aeolis Mons in Gale
};

}  // namespace

void pile_mounds(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t) {
  struct Placed {
    PlaceFrame frame;
    SinCos azimuth;
  };
  static const auto places = [] {
    std::array<Placed, std::size(kMounds)> all;
    std::transform(std::begin(kMounds), std::end(kMounds), all.begin(), [](const Mound& m) {
      return Placed{place_frame(m.lon_deg, m.lat_deg), exact_sin_cos_deg(m.azimuth_deg)};
    });
    return all;
  }();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Mound& m = kMounds[k];
    const auto& [f, azimuth] = places[k];
    constexpr double kFrayed = 0.3;
    const double outer = km_chord(m.long_km / (1.0 - kFrayed));
    if (!block.near(f.up, outer)) continue;
    Lane<double> round;
    bool any = false;
    for (std::size_t i = 0; i < block.padded; ++i) {
      const glm::dvec3 v = block.at(i) - f.up;
      const double e = (v.x * f.east.x + v.y * f.east.y) * (kRadius_m / 1000.0);
      const double n = (v.x * f.north.x + v.y * f.north.y + v.z * f.north.z) * (kRadius_m / 1000.0);
      const double a = (e * azimuth.sin + n * azimuth.cos) / m.long_km;
      const double b = (e * azimuth.cos - n * azimuth.sin) / m.short_km;
      round[i] = std::sqrt(a * a + b * b);
      any = any || round[i] * (0.999 - kFrayed) < 1.0;
    }
    if (!any) continue;
    Lane<float> flutes, fine;
    flutes.fill(kMeanNoise);
    fine.fill(kMeanNoise);
    if (spacing_m <= 2048.0) {
      // Flutes run downhill.
      Points drawn;
      for (std::size_t i = 0; i < block.padded; ++i) {
        const glm::dvec3 v = block.at(i) - f.up;
        const double e = (v.x * f.east.x + v.y * f.east.y) * (kRadius_m / 1000.0);
        const double n = (v.x * f.north.x + v.y * f.north.y + v.z * f.north.z) * (kRadius_m / 1000.0);
        const double back = 0.55 * m.long_km / (round[i] * m.short_km + 4.0);
        drawn.x[i] = e * back;
        drawn.y[i] = n * back;
        drawn.z[i] = 0.22 * round[i] * m.short_km;
      }
      noise(drawn, block.padded, block.simd, 4.6, 0x3b7, flutes);
    }
    if (spacing_m <= 512.0) noise(block, 1.3e3, 0x3c0, fine);
    for (std::size_t i = 0; i < block.padded; ++i) {
      if (chord2(block.at(i), f.up) > outer * outer) continue;
      const double r =
          round[i] * (1.0 + held(0.10 * static_cast<double>(w.km40[i]) + 0.06 * static_cast<double>(w.km16[i]) +
                                     0.020 * static_cast<double>(flutes[i]),
                                 kFrayed));
      if (r >= 1.0) continue;
      const double s = 1.0 - r;
      double h = 0.8 * m.height_m * s * (1.4 - 0.4 * s);
      h += 0.05 * m.height_m * (crest(flutes[i]) - 0.4) * 4.0 * s * r + 26.0 * (crest(fine[i]) - 0.4);
      if (spacing_m <= 512.0) {
        // Layers form terraces.
        const double bed = h * (1.0 / 190.0);
        const double phase = bed - floor_int(bed);
        h += 190.0 * 0.55 * (phase * phase * (3.0 - 2.0 * phase) - phase) * clamp01(s * 8.0);
      }
      t.height_m[i] += clamp01(s * 12.0) * std::max(0.0, h);
      auto& kind = m.layered ? t.mound[i] : t.wall[i];
      kind = std::max(kind, static_cast<float>(clamp01(s * 4.0)));
    }
  }
}

}  // namespace mars::embedded
