// Landforms that the floods of the outflow channels left: grooves, braids, islands, and chaos at the heads.
#include <algorithm>
#include <array>

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/troughs.h"

namespace mars::embedded {

namespace {

// Describes one region of broken ground.
struct ChaosRegion {
  PlaceFrame frame;
  double radius_km;
};

struct BrokenBlock {
  double gap;     // 0 on the line between two blocks, increasing inwards, in lattice steps
  double height;  // 0..1 of this block
};

// Jittered square lattice of blocks. Points lie in the middle 0.6 of their cells, so that the two nearest are
// among the nine around a place. The nine are cached, because neighbouring posts need the same.
class BlockLattice {
 public:
  explicit BlockLattice(std::uint64_t salt) : salt_(salt) {}

  BrokenBlock at(double u, double v) {
    about(floor_int(u), floor_int(v));
    double nearest = 1e9, second = 1e9;
    std::size_t own = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      const double x = points_[k].u - u, y = points_[k].v - v;
      const double d = x * x + y * y;
      second = std::min(second, std::max(nearest, d));
      own = d < nearest ? k : own;
      nearest = std::min(nearest, d);
    }
    return {std::sqrt(second) - std::sqrt(nearest), points_[own].height};
  }

 private:
  struct Point {
    double u, v, height;
  };

  void about(std::int64_t i0, std::int64_t j0) {
    if (i0 == i_ && j0 == j_) return;
    i_ = i0;
    j_ = j0;
    for (std::int64_t k = 0; k < 9; ++k) {
      const std::int64_t i = i0 - 1 + k % 3, j = j0 - 1 + k / 3;
      const std::uint64_t bits = mix_bits(static_cast<std::uint64_t>(i + 4096) * 0x9e3779b97f4a7c15ULL +
                                          static_cast<std::uint64_t>(j + 4096) * 0xc2b2ae3d27d4eb4fULL + salt_);
      points_[static_cast<std::size_t>(k)] = {static_cast<double>(i) + 0.2 + 0.6 * fraction16(bits, 0),
                                              static_cast<double>(j) + 0.2 + 0.6 * fraction16(bits, 16),
                                              fraction16(bits, 32)};
    }
  }

  std::uint64_t salt_;
  std::int64_t i_ = 1 << 20, j_ = 0;
  std::array<Point, 9> points_;
};

}  // namespace

void scour(const Block& block, double spacing_m, const Inside& in, const Lane<float>& inside,
           const Lane<double>& broken, Lane<double>& kept, Lane<double>& texture) {
  // The noise is stretched along the flow.
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
  static constexpr std::array<ChaosRegion, 8> kPatches{
      {{place_frame(317.5, -10.5), 560},  // Capri, Eos, Aurorae
       {place_frame(325.0, 0.6), 230},    // Hydraotes
       {place_frame(332.6, 3.4), 150},    // Hydaspis
       {place_frame(332.5, -4.2), 220},   // Aureum
       {place_frame(338.5, -9.0), 200},   // Margaritifer
       {place_frame(342.2, -1.8), 210},   // Iani
       {place_frame(338.9, 2.65), 150},   // Aram
       {place_frame(299.0, 2.6), 120}}};  // Juventae
  std::uint64_t salt = 0;
  for (const ChaosRegion& p : kPatches) {
    ++salt;
    const double reach = km_chord(p.radius_km);
    if (!block.near(p.frame.up, reach)) continue;
    BlockLattice mesas(salt), knobs(salt);
    for (std::size_t i = 0; i < block.padded; ++i) {
      if (on.inside[i] <= 0.0F) continue;
      const double x = block.x[i] - p.frame.up.x, y = block.y[i] - p.frame.up.y, z = block.z[i] - p.frame.up.z;
      const double chaos =
          static_cast<double>(on.inside[i]) * ramp(reach * reach, 0.3 * reach * reach, x * x + y * y + z * z);
      if (chaos <= 0.0) continue;
      const double e = (x * p.frame.east.x + y * p.frame.east.y) * (kRadius_m / 1000.0);
      const double n = (x * p.frame.north.x + y * p.frame.north.y + z * p.frame.north.z) * (kRadius_m / 1000.0);
      // Mesas are about ten kilometres wide and knobs three to four; some blocks are eroded completely.
      const double distortion_km =
          1.3 * static_cast<double>(on.coves[i]) + 0.5 * static_cast<double>(on.nicks[i]);
      const BrokenBlock mesa = mesas.at((e + distortion_km) * (1.0 / 11.0), (n - distortion_km) * (1.0 / 9.5));
      const BrokenBlock knob =
          knobs.at((0.8 * e + 0.6 * n + distortion_km) * (1.0 / 4.1), (0.8 * n - 0.6 * e) * (1.0 / 4.1));
      const double tall =
          ramp(0.16, 0.36, mesa.gap) *
          std::min(0.85, std::max(0.0, mesa.height - 0.25 + 0.2 * static_cast<double>(on.km16[i])));
      const double low = ramp(0.20, 0.48, knob.gap) * std::max(0.0, knob.height - 0.3);
      broken[i] = std::max(broken[i], chaos);
      texture[i] += chaos * std::max(1250.0 * tall, 520.0 * low);
    }
  }
}

}  // namespace mars::embedded
