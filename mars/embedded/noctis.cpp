// Noctis Labyrinthus: a maze of grabens along the edges of crust blocks, wider and deeper eastwards, where it
// opens into Ius and Tithonium.
#include <algorithm>
#include <array>

#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/spurs.h"

namespace mars::embedded {

namespace {

constexpr double kBlock_km = 52.0;   // mean size of the blocks between the grabens
constexpr double kWidest_km = 22.0;  // from the middle of a graben to its rim, fringe included
constexpr double kReach_km = 640.0;
constexpr double kCoarsest_m = 6000.0;  // largest spacing that resolves the grabens
constexpr PlaceFrame kFrame = place_frame(259.5, -7.5);

// Describes broken ground: a capsule in kilometres east and north of kFrame.
struct Zone {
  double e0, n0, e1, n1, half_km;
};
constexpr Zone kZones[] = {{-470, 150, -120, 70, 110}, {-120, 60, 320, 40, 205}, {320, 40, 560, 80, 90},
                           {60, -40, 290, -330, 105},  {-60, 150, -20, 330, 75}, {180, 120, 210, 270, 70}};

struct Seed {
  double e, n;
  std::uint64_t bits;
};

Seed seed_at(std::int64_t i, std::int64_t j) {
  const std::uint64_t bits = mix_bits(static_cast<std::uint64_t>(i + 4096) * 0x9e3779b97f4a7c15ULL +
                                      static_cast<std::uint64_t>(j + 4096) * 0xc2b2ae3d27d4eb4fULL + 0x9ULL);
  return {(static_cast<double>(i) + fraction16(bits, 0)) * kBlock_km,
          (static_cast<double>(j) + fraction16(bits, 16)) * kBlock_km * 0.8, bits};
}

// Returns 0 outside the zones and 1 well inside.
double broken(double e, double n, double distortion_km) {
  double inside = -1e9;
  for (const Zone& z : kZones) {
    const double de = z.e1 - z.e0, dn = z.n1 - z.n0;
    const double t = clamp01(((e - z.e0) * de + (n - z.n0) * dn) / (de * de + dn * dn));
    const double x = e - z.e0 - t * de, y = n - z.n0 - t * dn;
    inside = std::max(inside, z.half_km - std::sqrt(x * x + y * y));
  }
  return clamp01((inside + distortion_km + 30.0) * (1.0 / 95.0));
}

// Caches the blocks around one cell of their lattice, because neighbouring posts need the same.
struct Blocks {
  std::int64_t i = 1 << 20, j = 0;
  std::array<Seed, 25> seeds;

  void about(std::int64_t i0, std::int64_t j0) {
    if (i0 == i && j0 == j) return;
    i = i0;
    j = j0;
    for (std::int64_t k = 0; k < 25; ++k)
      seeds[static_cast<std::size_t>(k)] = seed_at(i - 2 + k % 5, j - 2 + k / 5);
  }
};

// Returns kilometres inside the nearest graben's rim, negative outside. `share` scales the widths.
double inside_km(double e, double n, double share, Blocks& blocks) {
  blocks.about(floor_int(e / kBlock_km), floor_int(n / (kBlock_km * 0.8)));
  std::array<Seed, 25> seeds;
  std::array<double, 25> d, square;
  double nearest2 = 1e18;
  for (std::size_t k = 0; k < 25; ++k) {
    const double x = blocks.seeds[k].e - e, y = blocks.seeds[k].n - n;
    square[k] = x * x + y * y;
    nearest2 = std::min(nearest2, square[k]);
  }
  const double nearest = std::sqrt(nearest2);
  const double farthest2 = (nearest + 2.0 * kWidest_km) * (nearest + 2.0 * kWidest_km);
  std::size_t close = 0;
  for (std::size_t k = 0; k < 25; ++k) {
    if (square[k] > farthest2) continue;
    seeds[close] = blocks.seeds[k];
    d[close++] = std::sqrt(square[k]);
  }
  // Every pair of blocks has a graben between them, along their bisector, where no third block is nearer.
  double best = -kWidest_km;
  for (std::size_t a = 0; a < close; ++a) {
    for (std::size_t b = a + 1; b < close; ++b) {
      const double x = seeds[a].e - seeds[b].e, y = seeds[a].n - seeds[b].n;
      const double apart = std::sqrt(x * x + y * y) + 1e-6;
      const double off = std::abs(d[a] * d[a] - d[b] * d[b]) / (2.0 * apart);
      const double beyond = std::max(d[a], d[b]) - nearest - off;
      if (off + std::max(0.0, beyond) * 1.2 > kWidest_km) continue;
      const std::uint64_t pair = mix_bits(seeds[a].bits + seeds[b].bits);
      const double open = fraction16(pair, 0);
      // Grabens along the parallels are wider, because the crust was extended northwards.
      const double lie = 0.75 + 0.5 * y * y / (apart * apart);
      const double half = share * lie * (open < 0.2 ? 1.2 : 3.0 + 8.3 * open * open) - (open < 0.2 ? 2.0 : 0.0);
      best = std::max(best, half - off - std::max(0.0, beyond) * 1.2);
    }
  }
  return best;
}

}  // namespace

void crack_noctis(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t) {
  if (!block.near(kFrame.up, km_chord(kReach_km))) return;
  Lane<float> ragged, nicks;
  ragged.fill(kMeanNoise);
  nicks.fill(kMeanNoise);
  bool drawn = false;
  Blocks blocks;
  for (std::size_t i = 0; i < block.padded; ++i) {
    const double x = block.x[i] - kFrame.up.x, y = block.y[i] - kFrame.up.y, z = block.z[i] - kFrame.up.z;
    if (x * x + y * y + z * z > km_chord(kReach_km) * km_chord(kReach_km)) continue;
    const double e = (x * kFrame.east.x + y * kFrame.east.y) * (kRadius_m / 1000.0);
    const double n = (x * kFrame.north.x + y * kFrame.north.y + z * kFrame.north.z) * (kRadius_m / 1000.0);
    const double region = broken(e, n, 14.0 * held(static_cast<double>(w.km100[i]), 2.0));
    if (region <= 0.0) continue;
    if (spacing_m > kCoarsest_m) {
      t.height_m[i] -= 800.0 * region;
      continue;
    }
    if (!drawn) {
      if (spacing_m <= 2048.0) noise(block, 6.1e3, 0x3d3, ragged);
      if (spacing_m <= 512.0) noise(block, 1.7e3, 0x3d4, nicks);
      drawn = true;
    }
    const double distorted_e = e + 20.0 * static_cast<double>(w.km250[i]) +
                               4.0 * static_cast<double>(w.km40[i]) + 1.7 * static_cast<double>(w.km16[i]);
    const double distorted_n = n + 9.0 * static_cast<double>(w.km100[i]) -
                               1.9 * static_cast<double>(w.km16[i]) + 2.0 * static_cast<double>(w.km40[i]);
    const double fringe = 1.1 * (crest(ragged[i]) - 0.4) + 0.35 * (crest(nicks[i]) - 0.4);
    const double share = (0.42 + 1.08 * ramp(-300.0, 150.0, e)) * region;
    const double in_km = inside_km(distorted_e, distorted_n, share, blocks) - fringe;
    if (in_km <= -0.5) continue;
    // Walls have about 30 degrees, with talus at the foot and a flat floor.
    const double deep_m = (1300.0 + 2900.0 * ramp(-250.0, 350.0, e)) * (0.35 + 0.65 * region);
    const double wall_km = deep_m * (1.0 / 520.0);
    const double s = clamp01(in_km / wall_km);
    const double down = s * (2.0 - s);
    const auto walled = static_cast<float>(ramp(-0.5, 0.4, in_km) * (1.0 - ramp(0.75, 1.05, s)));
    const auto floor = static_cast<float>(ramp(0.8, 1.1, in_km / wall_km));
    t.height_m[i] -= deep_m * down + 60.0 * s * (1.0 - s) * (static_cast<double>(ragged[i]) - 0.75);
    t.wall[i] = std::max(t.wall[i], walled);
    t.trough[i] = std::max(t.trough[i], floor);
    t.cratered[i] *= 1.0F - 0.8F * std::max(walled, floor);
    t.volcanic[i] *= 1.0F - std::max(walled, floor);
    t.rough[i] = std::max(t.rough[i], 0.9F * std::max(walled, floor));
  }
}

}  // namespace mars::embedded
