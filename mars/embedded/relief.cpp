#include "mars/embedded/relief.h"

#include <algorithm>

#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

constexpr int kLongestRelief = 13;  // longer octaves are in the data
constexpr int kShortestSpur = 7;    // spurs and gullies have wavelengths down to 128 m
constexpr int kLongestFloor = 10;   // below 1 km no ground is smoother than kFloor
constexpr float kPerOctave =
    0.53F;                         // heights fall by 2^-0.92 an octave (Hurst exponent of CTX and MOLA at Gale)
constexpr float kFloor = 0.0011F;  // standard deviation of an octave over its wavelength

// Returns the group of an octave.
constexpr std::size_t group_of(int octave) {
  if (octave >= 12) return 0;
  if (octave >= 10) return 1;
  if (octave >= 8) return 2;
  return octave >= 5 ? 3 : 4;
}

// Returns the standard deviation of an octave over that of the octave about 8 km, a little more than its part, since being
// zero at posts takes some of it.
constexpr float share_of(int octave) {
  float share = octave == kLongestRelief ? 1.5F : 1.15F;
  for (int k = 13; k > octave; --k) share *= kPerOctave;
  return share;
}

// Returns how much rougher than its surroundings the ground is.
[[gnu::always_inline]] inline float patch_at(const Octaves& octaves, std::size_t i) {
  const float p = 0.95F + 0.25F * octaves.n[15][i] + (octaves.first <= 12 ? 0.18F * octaves.n[12][i] : 0.0F);
  return std::max(0.35F, std::min(1.6F, p));
}

// Sets `out` to noise that is drawn out along the fall line, standard deviation about 1.
void drawn_noise(const Block& block, const Ground& ground, int octave, Lane<float>& out) {
  constexpr double kSteps[] = {-1.05, -0.35, 0.35, 1.05};  // wavelengths
  const double wavelength_m = static_cast<double>(1 << octave);
  std::fill_n(out.begin(), block.padded, 0.0F);
  for (const double step : kSteps) {
    Points at;
    Lane<float> n;
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        at.x[i] = block.x[i] * kRadius_m + step * wavelength_m * ground.fall_x[i];
        at.y[i] = block.y[i] * kRadius_m + step * wavelength_m * ground.fall_y[i];
        at.z[i] = block.z[i] * kRadius_m + step * wavelength_m * ground.fall_z[i];
      }
    });
    noise(at, block.padded, block.simd, wavelength_m, 0x2a00U + static_cast<std::uint32_t>(octave) * 0x1dU, n);
    for (std::size_t i = 0; i < block.padded; ++i) out[i] += 0.56F * n[i];
  }
}

// Adds hills and hollows, and on walls spurs that branch into gullies.
void add_hills(const Block& block, const Ground& ground, const Octaves& octaves, const Lane<float>& patch,
               const Lane<float>& covered, Relief& out) {
  Lane<float> crest;
  crest.fill(0.5F);
  for (int k = kLongestRelief; k >= octaves.first; --k) {
    const Lane<float>& n = octaves.n[static_cast<std::size_t>(k)];
    Lane<float>& sum = out.group[group_of(k)];
    const float share = share_of(k);
    const float floor = k <= kLongestFloor ? kFloor * static_cast<float>(1 << k) : 0.0F;
    const bool spurs = ground.has_walls && k >= kShortestSpur;
    Lane<float> drawn;
    if (spurs) drawn_noise(block, ground, k, drawn);
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const float a = std::max(share * ground.roughness_m[i], floor) * patch[i] *
                        (k >= 10 ? 1.0F : 1.0F - 0.6F * covered[i]);
        float shape = 0.85F * n[i] + 0.5F * (0.75F - magnitude(n[i]));
        if (spurs) {
          // Spurs branch: each size is strongest on the crests of the next larger one.
          const float up = 0.75F - magnitude(drawn[i]);
          const float spur = (k % 3 == 0 ? -1.0F : 1.0F) * (k >= 11 ? 0.75F : 1.0F) * up * (0.45F + crest[i]);
          crest[i] = std::max(0.0F, std::min(1.0F, 0.5F + up));
          shape = mix(shape, spur, ground.wall[i]);
        }
        sum[i] += a * shape;
        out.grain[i] = out.grain[i] * 0.82F + 0.55F * n[i];
      }
    });
  }
}

// Adds wrinkle ridges on plains, along zero lines of a longer octave.
void add_ridges(const Block& block, const Ground& ground, const Octaves& octaves, Relief& out) {
  if (octaves.first > 10) return;
  const auto& n = octaves.n;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const float line = n[14][i] + 0.20F * n[12][i] + 0.08F * n[11][i] + 0.35F;
      const float ridge = std::max(0.0F, 1.0F - magnitude(line) * (1.0F / 0.22F));
      const float plain = std::max(ground.lowland[i], ground.volcanic[i]) * (1.0F - ground.ice[i]) *
                          (1.0F - ground.wall[i]) * (1.0F - ground.trough[i]);
      const float high_m = std::min(45.0F, 2.5F * ground.roughness_m[i]);
      out.group[1][i] += plain * high_m * (ridge * ridge * (3.0F - 2.0F * ridge) - 0.075F);
    }
  });
}

// Cuts walls and the ice's scarps into beds: benches with steep fronts.
void add_beds(const Block& block, const Ground& ground, const Octaves& octaves, double detail_m, Relief& out) {
  if (detail_m > 32.0 || !ground.has_walls) return;
  const auto& n = octaves.n;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      constexpr float kBed_m = 58.0F;
      const float shown =
          ground.wall[i] * ramp(-0.4F, 0.8F, n[12][i] + 0.5F * n[10][i] + 0.4F * ground.trough[i]);
      const float height = static_cast<float>(ground.height_m[i]) + out.group[0][i] + out.group[1][i];
      const float bed = (height + 26.0F * n[10][i] + 9.0F * n[8][i]) * (1.0F / kBed_m) + 512.0F;
      const float f = bed - static_cast<float>(static_cast<std::int32_t>(bed));
      const float front = std::min(1.0F, f * 2.8F);
      out.group[2][i] += 0.55F * kBed_m * shown * (front * front * (3.0F - 2.0F * front) - f - 0.3215F);
    }
  });
}

}  // namespace

void lay_relief(const Block& block, double detail_m, const Ground& ground, const Octaves& octaves,
                const CraterSum& craters, Relief& out) {
  for (auto& group : out.group) std::fill_n(group.begin(), block.padded, 0.0F);
  std::fill_n(out.grain.begin(), block.padded, 0.0F);
  std::fill_n(out.rock.begin(), block.padded, 0.0F);
  std::fill_n(out.rock_tone.begin(), block.padded, 0.0F);
  const bool sandy = lay_sand(block, detail_m, octaves, ground, craters, out.sand);
  if (!sandy) out.sand.crest.fill(0.0F);
  if (detail_m >= kCoarsestRelief_m) return;

  Lane<float> patch, covered;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      patch[i] = patch_at(octaves, i);
      covered[i] = std::max(craters.hollow[i], 0.8F * out.sand.cover[i]);
    }
  });
  add_hills(block, ground, octaves, patch, covered, out);
  add_ridges(block, ground, octaves, out);
  add_beds(block, ground, octaves, detail_m, out);
  if (sandy) {
    for (std::size_t k = 0; k < Sand::kGroups; ++k) {
      for (std::size_t i = 0; i < block.padded; ++i) out.group[k + 2][i] += out.sand.height_m[k][i];
    }
  }
}

void lay_near_relief(const Block& block, double detail_m, const Ground& ground, const Octaves& octaves,
                     const CraterSum& craters, Relief& out) {
  if (detail_m > kCoarsestDetail_m) return;
  Lane<float> rough, smooth;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      rough[i] = std::max(0.15F, std::min(1.6F, ground.roughness_m[i] * (1.0F / 55.0F))) * patch_at(octaves, i);
      smooth[i] = static_cast<float>(ground.height_m[i]) + out.group[0][i] + out.group[1][i] + out.group[2][i] +
                  out.group[3][i];
    }
  });
  add_detail(block, detail_m, ground, octaves, craters, rough, smooth, out);
}

}  // namespace mars::embedded
