#include "mars/embedded/detail.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/relief.h"

namespace mars::embedded {

namespace {

// Cuts smooth ground into steps where beds of rock crop out.
void cut_ledges(const Block& block, const Ground& ground, const Octaves& octaves, const Sand& sand,
                const Lane<float>& smooth, Lane<float>& sum, Lane<float>& ledge) {
  const auto& n = octaves.n;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const float outcrop = 0.75F * n[12][i] + 0.55F * n[9][i] + 0.35F * n[7][i] + 0.5F * ground.wall[i] -
                            0.5F * ground.lowland[i] - 0.75F;
      ledge[i] =
          std::max(0.0F, std::min(1.0F, outcrop * 2.2F)) * (1.0F - sand.cover[i]) * (1.0F - ground.ice[i]);
      constexpr float kBed_m = 0.75F;
      const float bed = (smooth[i] + sum[i] + 0.10F * n[3][i]) * (1.0F / kBed_m) + 32768.0F;
      const float f = bed - static_cast<float>(static_cast<std::int32_t>(bed));
      const float step = std::min(1.0F, f * 4.0F);
      sum[i] += ledge[i] * kBed_m * (step * step * (3.0F - 2.0F * step) - f - 0.375F) * 0.55F;
    }
  });
}

}  // namespace

void add_detail(const Block& block, double detail_m, const Ground& ground, const Octaves& octaves,
                const CraterSum& craters, const Lane<float>& rough, const Lane<float>& smooth, Relief& out) {
  const auto& n = octaves.n;
  const Ground& g = ground;
  const Sand& sand = out.sand;
  Lane<float>& sum = out.group[kPinnedGroups];
  Lane<float>& grain = out.grain;
  Lane<float> ledge;
  cut_ledges(block, ground, octaves, sand, smooth, sum, ledge);

  // Frost cracks form polygons in the ground ice of high latitudes.
  bool frozen = false;
  for (std::size_t i = 0; i < block.padded; ++i)
    frozen = frozen || magnitude(static_cast<float>(block.z[i])) > 0.76F;
  if (frozen && detail_m <= 2.0) {
    Lane<float> cells, twist;
    noise(block, 13.0, 0x731, cells);
    noise(block, 8.0, 0x742, twist);
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const float z = magnitude(static_cast<float>(block.z[i]));
        const float there = std::max(0.0F, std::min(1.0F, (z - 0.76F) * 12.0F)) *
                            std::max(0.0F, std::min(1.0F, 0.8F + 0.7F * n[10][i])) * (1.0F - sand.cover[i]);
        const float crack = std::max(0.0F, 1.0F - std::min(magnitude(cells[i]), magnitude(twist[i])) * 4.5F);
        sum[i] -= there * 0.32F * crack * crack;
        grain[i] -= there * 1.2F * crack;
      }
    });
  }

  // Gravel and grit.
  Lane<float> gravel{}, speckle{};
  constexpr double kGrit_m[] = {1.05, 0.53, 0.26, 0.13};
  for (std::uint32_t k = 0; k < 4 && 2.0 * detail_m <= kGrit_m[k]; ++k) {
    Lane<float> fine;
    noise(block, kGrit_m[k], 0x753U + 0x11U * k, fine);
    const float height_m = 0.022F * static_cast<float>(kGrit_m[k]);
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        gravel[i] += height_m * (fine[i] + 0.7F * (0.75F - magnitude(fine[i])));
        speckle[i] = 0.8F * speckle[i] + fine[i];
      }
    });
  }
  Lane<float> bare, gravelly;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const float open = 1.0F - 0.85F * sand.cover[i];
      const float amplitude = (0.25F + 0.75F * rough[i]) * open * (1.0F - 0.6F * g.ice[i]);
      sum[i] += amplitude * gravel[i];
      grain[i] = 0.7F * grain[i] + 2.4F * open * speckle[i];
      // Rocks are frequent on rough ground, around fresh craters and below walls, in clusters.
      const float many = 0.10F + 0.14F * rough[i] + 0.35F * g.wall[i] + 0.5F * craters.fresh[i] +
                         0.25F * g.lowland[i] + 0.16F * g.trough[i] - 0.25F * g.volcanic[i] - 0.9F * g.ice[i] +
                         0.20F * n[11][i] + 0.18F * n[8][i] + 0.14F * n[6][i] + 0.12F * n[4][i] +
                         0.08F * n[3][i];
      const float hollow = 1.0F - sand.crest[i];
      bare[i] = std::max(0.0F, std::min(1.0F, mix(many, 0.04F, sand.cover[i])));
      gravelly[i] = std::max(0.0F, std::min(1.0F, mix(many, 0.55F * hollow * hollow - 0.08F, sand.cover[i])));
    }
  });
  Rocks rocks;
  strew_rocks(block, detail_m, bare, gravelly, rocks);
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      sum[i] += rocks.height_m[i];
      out.rock[i] = std::max(std::min(1.0F, rocks.height_m[i] * 25.0F), 0.55F * ledge[i]);
      out.rock_tone[i] = rocks.height_m[i] > 0.0F ? rocks.tone[i] - 0.55F : 0.6F;
    }
  });
}

}  // namespace mars::embedded
