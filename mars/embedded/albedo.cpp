#include "mars/embedded/albedo.h"

#include <algorithm>

#include "mars/embedded/albedo_table.h"
#include "mars/embedded/bumps.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/simd.h"

namespace mars::embedded {

void albedo(const Block& block, const Octaves& octaves, Lane<float>& out) {
  static const Bumps<std::int8_t> bumps{bump_centres(static_cast<int>(kAlbedoTable.size())), kAlbedoTable,
                                        kAlbedoReach, kAlbedoStep};
  Lane<double> broad;
  sum_bumps(block, bumps, broad);

  // The winds of the tropics blow along the parallels, aslant and swaying; what they draw is long that way.
  Points blown;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      blown.x[i] = block.x[i] * kRadius_m;
      blown.y[i] = block.y[i] * kRadius_m;
      blown.z[i] = (3.6 * block.z[i] + 0.9 * block.x[i] * block.y[i]) * kRadius_m +
                   60e3 * static_cast<double>(octaves.n[18][i]);
    }
  });
  Lane<float> streaks, wisps;
  noise(blown, block.padded, block.simd, 260e3, 0x701, streaks);
  noise(blown, block.padded, block.simd, 47e3, 0x712, wisps);

  Lane<float> frayed{};
  float share = 0.055F;
  for (int k = 13; k >= std::max(6, octaves.first); --k) {
    const Lane<float>& n = octaves.n[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < block.padded; ++i) frayed[i] += share * n[i];
    share *= 0.68F;
  }
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const auto b = static_cast<float>(broad[i]);
      const float ragged = 0.10F * octaves.n[18][i] + 0.09F * octaves.n[17][i] + 0.08F * octaves.n[16][i] +
                           0.08F * octaves.n[15][i] + 0.06F * octaves.n[14][i] + frayed[i];
      const float t = b + ragged + 0.15F * streaks[i] + 0.10F * wisps[i];
      // Sand gives way to thin dust along sharp fronts, thin dust to thick along softer ones.
      const float front = 0.75F * ramp(-0.34F, -0.08F, t) + 0.65F * ramp(0.10F, 0.62F, t) +
                          0.60F * ramp(-0.88F, -0.60F, t) - 1.1F;
      out[i] = 0.50F * b + 0.58F * front + 0.035F * streaks[i] + 0.05F * wisps[i] + 0.12F * ragged;
    }
  });
}

}  // namespace mars::embedded
