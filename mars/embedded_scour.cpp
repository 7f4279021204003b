// What the floods of the outflow channels left: grooves, braids, islands, and chaos at the heads.
#include <algorithm>
#include <array>

#include "mars/embedded_math.h"
#include "mars/embedded_noise.h"
#include "mars/embedded_simd.h"
#include "mars/embedded_troughs.h"

namespace mars::embedded {

void scour(const Block& block, double spacing_m, const Inside& in, const Lane<float>& inside,
           const Lane<double>& broken, Lane<double>& kept, Lane<double>& texture) {
  // Fine across the flow, drawn out along it.
  Points drawn;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double x = block.x[i] * kRadius_m, y = block.y[i] * kRadius_m, z = block.z[i] * kRadius_m;
      drawn.x[i] = in.across_m[i];
      drawn.y[i] = 0.17 * (x + 0.4 * z);
      drawn.z[i] = 0.17 * (y - 0.3 * x + 0.9 * z);
    }
  });
  Lane<float> islands, braids, grooves{}, fine{};
  noise(drawn, block.padded, block.simd, 34e3, 0x3f1, islands);
  noise(drawn, block.padded, block.simd, 15e3, 0x3f2, braids);
  if (spacing_m <= 2048.0) noise(drawn, block.padded, block.simd, 4.6e3, 0x3f3, grooves);
  if (spacing_m <= 512.0) noise(drawn, block.padded, block.simd, 1.5e3, 0x3f4, fine);
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const auto n = static_cast<double>(islands[i]);
      const auto b = static_cast<double>(braids[i]);
      const double wide = ramp(14e3, 40e3, in.to_axis_m[i] + std::max(0.0, in.depth_m[i]));
      const double floor = static_cast<double>(inside[i]) * (1.0 - broken[i]);
      kept[i] = 0.72 * floor * wide * ramp(0.75, 1.0, n + 0.25 * b);
      const double thread = std::max(0.0, 1.0 - (b < 0.0 ? -b : b) * 4.0);
      texture[i] += floor * (70.0 * static_cast<double>(grooves[i]) + 26.0 * static_cast<double>(fine[i]) -
                             230.0 * wide * thread * (2.0 - thread) * (1.0 - kept[i]));
    }
  });
}

void lay_chaos(const Block& block, const Chaos& on, Lane<double>& broken, Lane<double>& texture) {
  struct Patch {
    glm::dvec3 middle;
    double radius_km;
  };
  static constexpr std::array<Patch, 8> kPatches{{{place(317.5, -10.5), 560},  // Capri, Eos, Aurorae
                                                  {place(325.0, 0.6), 230},    // Hydraotes
                                                  {place(332.6, 3.4), 150},    // Hydaspis
                                                  {place(332.5, -4.2), 220},   // Aureum
                                                  {place(338.5, -9.0), 200},   // Margaritifer
                                                  {place(342.2, -1.8), 210},   // Iani
                                                  {place(338.9, 2.65), 150},   // Aram
                                                  {place(299.0, 2.6), 120}}};  // Juventae
  for (const Patch& p : kPatches) {
    const double reach = km_chord(p.radius_km);
    if (!block.near(p.middle, reach)) continue;
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const double x = block.x[i] - p.middle.x, y = block.y[i] - p.middle.y, z = block.z[i] - p.middle.z;
        const double chaos =
            static_cast<double>(on.inside[i]) * ramp(reach * reach, 0.3 * reach * reach, x * x + y * y + z * z);
        // Mesas between crossing gaps, the larger ones whole, the smaller ones worn to knobs.
        const float gap = std::min(magnitude(on.coves[i]) * 1.3F, magnitude(on.km16[i]));
        const float small = magnitude(on.nicks[i]);
        const double mesa = ramp(0.18, 0.42, static_cast<double>(gap) + 0.10 * static_cast<double>(small)) *
                            ramp(0.04, 0.30, static_cast<double>(small));
        broken[i] = std::max(broken[i], chaos);
        texture[i] += mesa * chaos * std::max(180.0, 620.0 + 420.0 * static_cast<double>(on.coves[i]));
      }
    });
  }
}

}  // namespace mars::embedded
