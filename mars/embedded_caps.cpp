#include <algorithm>

#include "mars/embedded_landforms.h"
#include "mars/embedded_math.h"
#include "mars/embedded_noise.h"

namespace mars::embedded {

namespace {

// A dome of layered ice about a point near the pole, with troughs that spiral outwards.
struct Cap {
  glm::dvec3 middle;
  double radius_km;
  double thickness_m;
  double flatness;  // 1 parabolic dome; less = flatter with a steeper edge
  double turn;      // sense of the spiral
};
constexpr Cap kCaps[] = {{place(20.0, 87.8), 560, 2800, 0.45, 1.0},
                         {place(160.0, -85.3), 680, 2900, 1.0, -1.0}};

// Angle of (x, y) in turns, -0.5..0.5, within 2e-3; own polynomial for equal bits.
double turns_of(double x, double y) {
  const double ax = x < 0.0 ? -x : x;
  const double ay = y < 0.0 ? -y : y;
  const double big = std::max(ax, ay) + 1e-300;
  const double q = std::min(ax, ay) / big;
  double a = q * (0.25 + 0.273 * (1.0 - q) / kPi) * 0.5;
  if (ay > ax) a = 0.25 - a;
  if (x < 0.0) a = 0.5 - a;
  return y < 0.0 ? -a : a;
}

// Cuts a wedge into the northern dome: Chasma Boreale.
double chasma(double e_km, double n_km, double bend) {
  const double along = clamp01((e_km * 0.79 - n_km * 0.61 + 40.0) / 520.0);
  const double side =
      (e_km * 0.61 + n_km * 0.79 - 60.0 + 140.0 * along * along) / (12.0 + 62.0 * along) + 0.22 * bend;
  return ramp(1.0, 0.55, side < 0.0 ? -side : side) * ramp(0.0, 0.18, along);
}

}  // namespace

void lay_caps(const Block& block, const Wander& w, Terrain& t) {
  for (const Cap& c : kCaps) {
    if (!block.near(c.middle, km_chord(c.radius_km * 1.3))) continue;
    Lane<float> bend;
    noise(block, 150e3, 0x417, bend);
    for (std::size_t i = 0; i < block.padded; ++i) {
      const glm::dvec3 v = block.at(i) - c.middle;
      const double flat = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z) * (kRadius_m / 1000.0);
      const double r =
          flat / c.radius_km *
          (1.0 + held(0.06 * static_cast<double>(w.km250[i]) + 0.035 * static_cast<double>(w.km100[i]) +
                          0.012 * static_cast<double>(w.km40[i]),
                      0.2));
      if (r >= 1.0) continue;
      // Chart about the pole itself, so that the troughs wind round it.
      const double e = block.x[i] * (kRadius_m / 1000.0);
      const double n = block.y[i] * (kRadius_m / 1000.0);
      const double polar_km = std::sqrt(e * e + n * n);
      const double dome = 1.0 - r * r;
      const double thick = c.thickness_m * dome / (c.flatness + (1.0 - c.flatness) * dome);
      const double wind = turns_of(e, n) * 6.0 * c.turn + polar_km / 62.0 + 0.30 * static_cast<double>(bend[i]);
      const double phase = wind - floor_int(wind);
      const double groove = ramp(0.0, 0.22, phase) * ramp(0.55, 0.28, phase);
      const double where = ramp(60.0, 170.0, polar_km) * ramp(1.0, 0.8, r) *
                           clamp01(0.65 + 0.7 * static_cast<double>(w.km250[i]));
      double h = thick - 420.0 * groove * where;
      if (block.z[i] > 0.0)
        h = mix(h, 250.0, chasma(e, n, static_cast<double>(w.km100[i]) + 0.5 * static_cast<double>(w.km40[i])));
      h = std::max(0.0, h);
      const auto cover = static_cast<float>(ramp(1.0, 0.94, r));
      t.height_m[i] += h;
      t.ice[i] = cover * static_cast<float>(1.0 - 0.55 * groove * where);
      t.cratered[i] = t.cratered[i] * (1.0F - cover);
      t.rugged[i] = mix(t.rugged[i], 0.10F, cover);
      t.rough[i] = mix(t.rough[i], 0.18F, cover);
      t.wall[i] = std::max(t.wall[i], static_cast<float>(0.5 * groove * where));
    }
  }
}

}  // namespace mars::embedded
