#include "mars/embedded/craters.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

constexpr double kCellsPerDiameter = 2.5;

// Holds the share of the highlands that craters of one level cover, and the part of it that the youngest ground
// has.
struct Share {
  double covered;
  double young;
};
constexpr Share share_of(int level) {
  // From 2 km up these follow the cumulative numbers of Noachian highlands; below, erosion and saturation leave
  // less.
  if (level >= 17) return {0.045, 0.0};  // above 131 km most are named
  if (level >= 15) return {0.100, 0.0};  // 33 km
  if (level >= 14) return {0.065, 0.0};
  if (level >= 13) return {0.042, 0.0};
  if (level >= 11) return {0.036, 0.01};  // 2 km
  if (level >= 9) return {0.042, 0.05};
  if (level >= 6) return {0.050, 0.16};
  if (level >= 3) return {0.030, 0.35};
  return {0.010, 0.30};  // 2 to 8 m: the atmosphere stops most impactors of that size
}

// The mean of D^2 over a level is 1.848 times the smallest D^2. With cells of c diameters, a candidate lies in
// the surface layer with a probability that makes one per area of c^2.
constexpr double kept_per_candidate(int level) {
  return share_of(level).covered * kCellsPerDiameter * kCellsPerDiameter / (0.7853981633974483 * 1.848);
}

struct Named {
  glm::dvec3 centre;
  double diameter_km, depth_m, rim_m, floor, peak_m, ring, sharp;
};
constexpr Named kNamed[] = {
    {place(137.81, -5.37), 154, 3900, 500, 0.50, 0, 0, 0.75},      // Gale
    {place(77.58, 18.38), 47, 380, 260, 0.60, 0, 0, 0.6},          // Jezero
    {place(175.50, -14.50), 158, 1500, 250, 0.72, 0, 0, 0.5},      // Gusev
    {place(55.58, -13.88), 467, 2400, 500, 0.55, 700, 0.26, 0.7},  // Huygens
    {place(16.77, -2.71), 459, 1500, 350, 0.70, 0, 0, 0.6},        // Schiaparelli
    {place(32.11, 23.35), 408, 1500, 350, 0.70, 0, 0, 0.55},       // Cassini
    {place(60.83, 21.38), 394, 1100, 250, 0.72, 0, 0, 0.5},        // Antoniadi
    {place(35.92, 13.28), 344, 1300, 300, 0.70, 0, 0, 0.5},        // Tikhonravov
    {place(343.93, -2.07), 310, 500, 120, 0.75, 0, 0, 0.3},        // Margaritifer basin
    {place(230.00, -14.50), 130, 900, 200, 0.65, 0, 0, 0.5},
    {place(218.52, -29.57), 297, 1500, 350, 0.68, 0, 0, 0.55},       // Koval'sky
    {place(129.89, -14.48), 297, 1900, 400, 0.65, 500, 0.22, 0.65},  // Herschel
    {place(190.73, -48.80), 302, 1900, 400, 0.66, 400, 0.2, 0.6},    // Copernicus
    {place(201.92, -40.44), 301, 2100, 450, 0.62, 600, 0.22, 0.65},  // Newton
    {place(55.99, -1.90), 292, 1700, 350, 0.66, 0, 0, 0.55},         // Schroeter
    {place(171.13, -13.30), 293, 1400, 300, 0.70, 0, 0, 0.5},        // de Vaucouleurs
    {place(19.29, -16.77), 245, 1500, 300, 0.68, 0, 0, 0.5},         // Flaugergues
    {place(29.30, 50.47), 236, 3000, 550, 0.55, 700, 0.20, 0.95},    // Lyot
    {place(101.90, -57.86), 223, 1600, 300, 0.62, 400, 0.2, 0.6},    // Secchi
    {place(329.03, -50.63), 230, 2300, 450, 0.58, 500, 0.2, 0.75},   // Galle
    {place(19.11, -46.19), 207, 2300, 400, 0.58, 400, 0.15, 0.7},    // Kaiser
    {place(278.55, -51.96), 203, 2200, 450, 0.60, 600, 0.22, 0.85},  // Lowell
    {place(140.98, -46.72), 228, 2000, 400, 0.62, 300, 0.15, 0.6},   // Kepler
    {place(164.58, 72.77), 81, 2000, 500, 0.55, 0, 0, 0.95},         // Korolev
    {place(350.70, 65.04), 131, 1700, 300, 0.55, 300, 0, 0.85},      // Lomonosov
    {place(213.40, 54.46), 118, 2000, 350, 0.50, 500, 0, 0.9},       // Milankovic
    {place(325.98, -26.04), 153, 2000, 350, 0.62, 0, 0, 0.6},        // Holden
    {place(340.50, -24.00), 139, 1500, 250, 0.66, 0, 0, 0.5},
    {place(305.20, -49.20), 138, 2300, 400, 0.55, 600, 0, 0.8},  // Hale-like, north of Argyre
    {place(323.64, -35.70), 137, 2400, 420, 0.52, 800, 0, 0.9},  // Hale
    {place(344.70, 7.90), 100, 1400, 250, 0.55, 300, 0, 0.7},
    {place(9.00, 25.50), 150, 1300, 250, 0.66, 0, 0, 0.5},
    {place(353.10, 21.90), 110, 1200, 250, 0.6, 200, 0, 0.6},  // Becquerel region
    {place(114.59, -36.12), 96, 1600, 250, 0.55, 300, 0, 0.7},
    {place(182.90, -14.90), 61, 1500, 250, 0.4, 250, 0, 0.85},
};

float root(double x) { return static_cast<float>(std::sqrt(x)); }

Crater shape(const glm::dvec3& centre, double diameter_m, int level, std::uint64_t bits) {
  Crater c;
  c.centre = centre;
  c.radius_m = 0.5 * diameter_m;
  c.level = level;
  const auto d = static_cast<float>(diameter_m);
  const auto age = static_cast<float>(fraction16(bits, 0));
  const auto other = static_cast<float>(fraction16(bits, 16));
  if (diameter_m < 7000.0) {
    c.sharp = diameter_m < 500.0 ? 0.15F + 0.85F * age * age : 0.10F + 0.90F * age * age * age;
    c.depth_m = 0.19F * d * (0.22F + 0.78F * c.sharp);
    c.rim_m = 0.036F * d * c.sharp;
    c.floor = 0.10F * (1.0F - c.sharp) + 0.05F * other;
    if (diameter_m > 2500.0 && c.sharp > 0.55F) c.lobe_m = 0.008F * d * other;
  } else {
    // The depth is about 0.36 D^0.49 km (Garvin et al. 2003), approximated by a square root.
    const float fresh_m = 340.0F * root(diameter_m * 1e-3);
    c.sharp = 0.12F + 0.88F * age * age;
    c.depth_m = fresh_m * (0.20F + 0.62F * c.sharp) * (0.85F + 0.3F * other);
    c.rim_m = 0.20F * fresh_m * (0.1F + 0.9F * c.sharp);
    const float size = std::min(1.0F, d / 60e3F);
    c.floor = 0.18F + 0.30F * size + 0.16F * (1.0F - c.sharp);
    if (c.sharp > 0.4F && other > 0.3F && diameter_m > 12e3) c.peak_m = 0.28F * c.depth_m * other;
    if (diameter_m > 110e3 && c.peak_m > 0.0F) c.ring = 0.18F;
    if (diameter_m < 60e3 && c.sharp > 0.5F) c.lobe_m = 0.005F * d * (0.4F + other);
  }
  return c;
}

// Returns a triangle wave of period 1 between -0.5 and 0.5, for x >= -8.
[[gnu::always_inline]] inline float triangle(float x) {
  const float f = x - static_cast<float>(static_cast<std::int32_t>(x + 8.0F) - 8);
  const float up = f < 0.5F ? f : 1.0F - f;
  return 2.0F * up - 0.5F;
}

[[gnu::always_inline]] inline void add_body(const Block& block, const Crater& c, const float* __restrict ragged,
                                            std::int32_t* __restrict relief, float* __restrict buried,
                                            float* __restrict fresh) {
  const double scale = kRadius_m / c.radius_m;
  constexpr auto kReach2 = static_cast<float>(kEjectaReach * kEjectaReach);
  constexpr float kWindow = 1.0F / (kReach2 - 1.0F);
  const float inner = 1.0F / (1.0F - c.floor);
  const float peak_share = c.ring > 0.0F ? 0.0F : c.peak_m;
  const float ring_share = c.ring > 0.0F ? c.peak_m : 0.0F;
  const float ring_inverse = c.ring > 0.0F ? 1.0F / (0.45F * c.ring) : 1.0F;
  const float wobble = 0.06F + 0.05F * (1.0F - c.sharp);
  const float total = c.depth_m + c.rim_m;
  const bool complex = c.radius_m > 3500.0;
  const float terraced = c.radius_m > 8e3 ? 0.22F : 0.0F;
  const float curved = complex ? 0.5F : 0.0F;
  for (std::size_t i = 0; i < block.padded; ++i) {
    const double dx = (block.x[i] - c.centre.x) * scale;
    const double dy = (block.y[i] - c.centre.y) * scale;
    const double dz = (block.z[i] - c.centre.z) * scale;
    const auto round = static_cast<float>(dx * dx + dy * dy + dz * dz);
    // Noise distorts the squared radius, but must not add anything beyond the extent of the ejecta.
    const float n = std::max(-2.5F, std::min(2.5F, ragged[i]));
    const float q = round * (1.0F + wobble * n);
    const float window = std::max(0.0F, 1.0F - (std::max(1.0F, q) - 1.0F) * kWindow);
    const float cut = std::max(0.0F, std::min(1.0F, (kReach2 - round) * 2.0F));

    // Fresh craters have a flat floor and a wall that steepens to a sharp crest.
    const float w = std::max(0.0F, std::min(1.0F, (q - c.floor) * inner));
    // Slumped blocks make terraces in the walls of the larger ones.
    const float step = w * 3.0F + 0.25F * n;
    const float wall = w * (1.0F - curved + curved * w) + terraced * w * (1.0F - w) * triangle(step);
    const float inside = -c.depth_m + total * wall;
    const float safe = std::max(1.0F, q);
    const float fall = 1.0F / (safe * safe);
    const float outside = c.rim_m * fall * window * window * (1.0F + 0.45F * n * std::min(1.0F, safe - 1.0F));
    const float crisp = q < 1.0F ? inside : outside;

    // Worn craters are a smooth hollow with a broad swell around it.
    const float s = std::max(0.0F, 1.0F - q * (1.0F / 1.5F));
    const float lip = std::max(0.0F, 1.0F - (q - 1.3F) * (q - 1.3F));
    const float worn = -c.depth_m * std::min(0.62F, s * s * (3.0F - 2.0F * s)) * 1.25F + c.rim_m * 0.8F * lip;

    const float p = std::max(0.0F, 1.0F - q * 11.0F);
    const float o = std::max(0.0F, 1.0F - (q - c.ring) * (q - c.ring) * ring_inverse * ring_inverse);
    const float middle = (peak_share * p * (2.0F - p) + ring_share * o * o) * (1.0F + 0.35F * n);

    // A sheet of fluidised ejecta with a raised margin.
    const float l = (3.2F + 0.8F * n - q);
    const float sheet =
        std::max(0.0F, std::min(1.0F, l * 1.6F)) * std::max(0.0F, std::min(1.0F, (q - 0.95F) * 4.0F));
    const float rampart = std::max(0.0F, 1.0F - (l - 0.7F) * (l - 0.7F) * 3.0F);
    const float lobes = c.lobe_m * sheet * (0.6F + 0.8F * rampart);

    const float h = (mix(worn, crisp, c.sharp) + middle * c.sharp + lobes) * cut;
    relief[i] += static_cast<std::int32_t>(h * kCraterUnits);
    const float cover = std::max(0.0F, std::min(1.0F, (1.25F - q) * 3.0F));
    buried[i] = std::max(buried[i], cover * (0.35F + 0.3F * c.sharp));
    const float steep = w * cut * std::max(0.0F, std::min(1.0F, (1.6F - q) * 1.6F));
    fresh[i] = std::max(fresh[i], steep * c.sharp * c.sharp);
  }
}

}  // namespace

int smallest_crater_level(double spacing_m) {
  int level = kSmallestCraterLevel;
  while (level <= kLargestCraterLevel && static_cast<double>(1 << level) < 4.0 * spacing_m) ++level;
  return level;
}

double crater_cell_m(int level) { return kCellsPerDiameter * static_cast<double>(1 << level); }

void find_candidates(const glm::dvec3& centre, double reach, int level, std::vector<Candidate>& out) {
  const double smallest_m = static_cast<double>(1 << level);
  const double cell = crater_cell_m(level);
  const double chance = kept_per_candidate(level);
  // Largest reach is 2.5 radii of twice the smallest diameter = one cell; half a cell for the shell.
  const double touch = 2.0 * smallest_m * 0.5 * kEjectaReach;
  const double extent = reach * kRadius_m + std::sqrt(touch * touch + 0.25 * cell * cell) * 1.01;
  const double inner = (kRadius_m - 0.5 * cell) * (kRadius_m - 0.5 * cell);
  const double outer = (kRadius_m + 0.5 * cell) * (kRadius_m + 0.5 * cell);
  const double skip = cell * 1.4;  // half a diagonal and half a shell
  const double skip_inner = std::max(0.0, kRadius_m - skip) * std::max(0.0, kRadius_m - skip);
  const double skip_outer = (kRadius_m + skip) * (kRadius_m + skip);
  const glm::dvec3 c = centre * kRadius_m;
  const auto index = [cell](double x) { return static_cast<std::int64_t>(floor_int(x / cell)); };
  const std::int64_t i1 = index(c.x + extent), j1 = index(c.y + extent), k1 = index(c.z + extent);
  for (std::int64_t i = index(c.x - extent); i <= i1; ++i) {
    for (std::int64_t j = index(c.y - extent); j <= j1; ++j) {
      for (std::int64_t k = index(c.z - extent); k <= k1; ++k) {
        const double mx = (static_cast<double>(i) + 0.5) * cell;
        const double my = (static_cast<double>(j) + 0.5) * cell;
        const double mz = (static_cast<double>(k) + 0.5) * cell;
        const double mm = mx * mx + my * my + mz * mz;
        if (mm < skip_inner || mm > skip_outer) continue;
        const std::uint64_t key = (static_cast<std::uint64_t>(i) & 0x1fffff) |
                                  (static_cast<std::uint64_t>(j) & 0x1fffff) << 21 |
                                  (static_cast<std::uint64_t>(k) & 0x1fffff) << 42;
        const std::uint64_t bits =
            mix_bits(key + static_cast<std::uint64_t>(level + 1) * 0x9e3779b97f4a7c15ULL);
        const double x = mx + (fraction16(bits, 0) - 0.5) * cell;
        const double y = my + (fraction16(bits, 16) - 0.5) * cell;
        const double z = mz + (fraction16(bits, 32) - 0.5) * cell;
        const double rr = x * x + y * y + z * z;
        const double keep = fraction16(bits, 48);
        if (rr < inner || rr >= outer || keep >= chance) continue;
        const double r = std::sqrt(rr);
        const glm::dvec3 unit{x / r, y / r, z / r};
        const std::uint64_t more = mix_bits(bits + 0x632be59bd9b4e019ULL);
        // N(>D) ~ D^-2 between the level's ends.
        const double diameter_m = smallest_m / std::sqrt(1.0 - 0.75 * fraction16(more, 32));
        const double limit = reach + diameter_m * 0.5 * kEjectaReach / kRadius_m;
        if (chord2(unit, centre) > limit * limit) continue;
        out.push_back({shape(unit, diameter_m, level, more), static_cast<float>(keep)});
      }
    }
  }
}

void keep_craters(std::span<const Candidate> candidates, Simd simd, std::vector<Crater>& out) {
  // What terrain() says of the ground is the same at every spacing; a wide one is the cheapest.
  constexpr double kAnySpacing_m = 65536.0;
  for (std::size_t first = 0; first < candidates.size(); first += kBlock) {
    Block block;
    block.simd = simd;
    block.count = std::min(kBlock, candidates.size() - first);
    for (std::size_t i = 0; i < block.count; ++i) {
      const glm::dvec3& c = candidates[first + i].crater.centre;
      block.x[i] = c.x;
      block.y[i] = c.y;
      block.z[i] = c.z;
    }
    block.finish();
    Octaves octaves;
    for (int k = kOutlineOctave; k <= kLastOctave; ++k) add_octave(block, k, octaves);
    Terrain ground;
    terrain(block, octaves, kAnySpacing_m, ground);
    for (std::size_t i = 0; i < block.count; ++i) {
      const Candidate& c = candidates[first + i];
      const Share share = share_of(c.crater.level);
      const auto density =
          std::max(ground.cratered[i], static_cast<float>(share.young) * (1.0F - ground.ice[i]));
      if (c.keep < density * static_cast<float>(kept_per_candidate(c.crater.level))) out.push_back(c.crater);
    }
  }
}

void find_named_craters(const glm::dvec3& centre, double reach, double smallest_m, std::vector<Crater>& out) {
  for (const Named& n : kNamed) {
    const double diameter_m = n.diameter_km * 1000.0;
    if (diameter_m < smallest_m) continue;
    const double limit = reach + diameter_m * 0.5 * kEjectaReach / kRadius_m;
    if (chord2(n.centre, centre) > limit * limit) continue;
    Crater c;
    c.centre = n.centre;
    c.radius_m = 0.5 * diameter_m;
    c.depth_m = static_cast<float>(n.depth_m);
    c.rim_m = static_cast<float>(n.rim_m);
    c.floor = static_cast<float>(n.floor);
    c.peak_m = static_cast<float>(n.peak_m);
    c.ring = static_cast<float>(n.ring);
    c.sharp = static_cast<float>(n.sharp);
    for (c.level = kSmallestCraterLevel; static_cast<double>(2 << c.level) <= diameter_m;) ++c.level;
    out.push_back(c);
  }
}

void CraterSum::clear() {
  relief.fill(0);
  large.fill(0);
  buried.fill(0.0F);
  filled.fill(0.0F);
  ignored.fill(0.0F);
  fresh.fill(0.0F);
}

void add_crater(const Block& block, const Crater& crater, const Lane<float>& ragged, CraterSum& sum) {
  const bool large = crater.level >= kLargeCraterLevel;
  auto& smoothed = crater.level >= kBasinLevel ? sum.filled : (large ? sum.buried : sum.ignored);
  auto& relief = large ? sum.large : sum.relief;
  with_simd(block.simd,
            [&] { add_body(block, crater, ragged.data(), relief.data(), smoothed.data(), sum.fresh.data()); });
}

}  // namespace mars::embedded
