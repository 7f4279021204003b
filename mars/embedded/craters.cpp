#include "mars/embedded/craters.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

constexpr double kCellsPerDiameter = 2.5;

// Production function of Ivanov (2001) for Mars and 1 Ga: craters of 2^(3 + k) metres and more for each square metre.
constexpr double kProduction[] = {0.00395,   0.0005209, 5.776e-05, 6.44e-06,  6.668e-07, 5.666e-08,
                                  4.262e-09, 3.83e-10,  5.766e-11, 1.656e-11, 7.343e-12, 3.159e-12};
// Share of ground that is never exceeded: 4 % of geometric saturation.
constexpr double kEquilibrium = 0.04 * 1.54;

// Returns the factor of the production function of 1 Ga that ground of a density has.
constexpr double age_factor(double cratered) { return 0.15 + 10.0 * cratered * cratered; }

// Returns the number of craters of a level for each square metre.
constexpr double level_density(int level, double cratered) {
  const double smallest_m = static_cast<double>(1 << level);
  const double age = age_factor(cratered);
  const auto k = static_cast<std::size_t>(level - 3);
  const double here = std::min(age * kProduction[k], kEquilibrium / (smallest_m * smallest_m));
  const double next = std::min(age * kProduction[k + 1], kEquilibrium / (4.0 * smallest_m * smallest_m));
  return here - next;
}

// Radii of a crater that must be free of posts.
constexpr double kFreeOfPosts = 1.25;

// Returns by how much craters must be more frequent elsewhere to make up for those that posts forbid.
double posts_make_up(double radius_m, double column_m) {
  const double reach = kFreeOfPosts * radius_m;
  const double forbidden = column_m > 2.0 * reach ? kPi * reach * reach / (column_m * kMeasuredPost_m)
                                                  : 2.0 * reach / kMeasuredPost_m;
  return 1.0 / (1.0 - std::min(0.88, forbidden));
}

// Returns the largest share of a level's cells that may hold a crater anywhere.
double most_cells(int level) {
  const double cell = crater_cell_m(level);
  return std::min(1.0, level_density(level, 1.3) * cell * cell * 8.5);
}

Crater shape(const glm::dvec3& centre, double diameter_m, int level, std::uint64_t bits) {
  Crater c;
  c.centre = centre;
  c.radius_m = 0.5 * diameter_m;
  c.level = level;
  const auto d = static_cast<float>(diameter_m);
  const auto age = static_cast<float>(fraction16(bits, 0));
  const auto other = static_cast<float>(fraction16(bits, 16));
  c.sharp = diameter_m < 500.0 ? 0.15F + 0.85F * age * age : 0.10F + 0.90F * age * age * age;
  c.depth_m = 0.15F * d * (0.22F + 0.78F * c.sharp);
  c.floor = 0.10F * (1.0F - c.sharp) + 0.05F * other;
  if (diameter_m > 2500.0 && c.sharp > 0.55F) c.lobe_m = 0.004F * d * other;
  return c;
}

// Returns the part of the crisp profile of fresh craters; the rest is a smooth hollow.
float crisp_share(const Crater& c) { return c.sharp * c.sharp; }

// Returns the height of the crest of the rim that makes the crater's volume zero. The factors are integrals of the profiles
// of add_body() over the squared radius, without noise.
float rim_of(const Crater& c) {
  const float worn_depth = 0.748F, worn_rim = 1.707F;
  const float crisp_depth = 0.5F + 0.5F * c.floor, crisp_rim = 0.5F - 0.5F * c.floor + 0.907F;
  const float sheet = c.lobe_m * 1.3F;
  const float share = crisp_share(c);
  const float hollow = c.depth_m * mix(worn_depth, crisp_depth, share) - sheet;
  return std::max(0.0F, hollow / mix(worn_rim, crisp_rim, share));
}

[[gnu::always_inline]] inline void add_body(const Block& block, const Crater& c, const float* __restrict ragged,
                                            const double* __restrict post_m, std::int32_t* __restrict relief,
                                            float* __restrict hollow, float* __restrict fresh) {
  const double scale = kRadius_m / c.radius_m;
  constexpr auto kReach2 = static_cast<float>(kEjectaReach * kEjectaReach);
  constexpr float kWindow = 1.0F / (kReach2 - 1.0F);
  const float inner = 1.0F / (1.0F - c.floor);
  const float wobble = 0.05F + 0.04F * (1.0F - c.sharp);
  const float total = c.depth_m + c.rim_m;
  const float share = crisp_share(c);
  const auto per_radius = static_cast<float>(1.0 / c.radius_m);
  for (std::size_t i = 0; i < block.padded; ++i) {
    const double dx = (block.x[i] - c.centre.x) * scale;
    const double dy = (block.y[i] - c.centre.y) * scale;
    const double dz = (block.z[i] - c.centre.z) * scale;
    const auto round = static_cast<float>(dx * dx + dy * dy + dz * dz);
    // Noise distorts the squared radius, but must not add anything beyond the extent of the ejecta.
    const float n = std::max(-2.5F, std::min(2.5F, ragged[i]));
    const float q = round * (1.0F + wobble * n);
    const float window = std::max(0.0F, 1.0F - (std::max(1.0F, q) - 1.0F) * kWindow);
    const float apart = std::max(0.0F, std::min(1.0F, static_cast<float>(post_m[i]) * per_radius * 4.0F));
    const float cut = std::max(0.0F, std::min(1.0F, (kReach2 - round) * 2.0F)) * apart;

    // Fresh craters have a flat floor and a wall that steepens to a sharp crest.
    const float w = std::max(0.0F, std::min(1.0F, (q - c.floor) * inner));
    const float inside = -c.depth_m + total * w;
    const float safe = std::max(1.0F, q);
    const float outside = c.rim_m / safe * window * window * (1.0F + 0.45F * n * std::min(1.0F, safe - 1.0F));
    const float crisp = q < 1.0F ? inside : outside;

    // Worn craters are a smooth hollow with a broad swell around it.
    const float s = std::max(0.0F, 1.0F - q * (1.0F / 1.5F));
    const float lip = std::max(0.0F, 1.0F - (q - 2.2F) * (q - 2.2F) * 0.25F);
    const float worn =
        -c.depth_m * std::min(0.62F, s * s * (3.0F - 2.0F * s)) * 1.25F + c.rim_m * 0.8F * lip * lip;

    // A sheet of fluidised ejecta with a raised margin.
    const float l = (3.2F + 0.8F * n - q);
    const float sheet =
        std::max(0.0F, std::min(1.0F, l * 1.6F)) * std::max(0.0F, std::min(1.0F, (q - 0.95F) * 4.0F));
    const float rampart = std::max(0.0F, 1.0F - (l - 0.7F) * (l - 0.7F) * 3.0F);
    const float lobes = c.lobe_m * sheet * (0.6F + 0.8F * rampart);

    const float h = (mix(worn, crisp, share) + lobes) * cut;
    relief[i] += static_cast<std::int32_t>(h * kCraterUnits);
    const float cover = std::max(0.0F, std::min(1.0F, (1.25F - q) * 3.0F));
    hollow[i] = std::max(hollow[i], cover * (0.35F + 0.3F * c.sharp));
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

double crater_density(double diameter_m, double cratered) {
  int level = kSmallestCraterLevel;
  while (level < kLargestCraterLevel && static_cast<double>(2 << level) <= diameter_m) ++level;
  const auto k = static_cast<std::size_t>(level - 3);
  const double low_m = static_cast<double>(1 << level);
  const double slope = std::log2(kProduction[k + 1] / kProduction[k]);
  const double produced = age_factor(cratered) * kProduction[k] * std::pow(diameter_m / low_m, slope);
  return std::min(produced, kEquilibrium / (diameter_m * diameter_m));
}

double crater_cell_m(int level) { return kCellsPerDiameter * static_cast<double>(1 << level); }

void find_candidates(const glm::dvec3& centre, double reach, int level, std::vector<Candidate>& out) {
  const double smallest_m = static_cast<double>(1 << level);
  const double cell = crater_cell_m(level);
  const double most = most_cells(level);
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
        if (rr < inner || rr >= outer || keep >= most) continue;
        const double r = std::sqrt(rr);
        const glm::dvec3 unit{x / r, y / r, z / r};
        const std::uint64_t more = mix_bits(bits + 0x632be59bd9b4e019ULL);
        // N(>D) ~ D^-2 between the level's ends.
        const double diameter_m = smallest_m / std::sqrt(1.0 - 0.75 * fraction16(more, 32));
        const double limit = reach + diameter_m * 0.5 * kEjectaReach / kRadius_m;
        if (chord2(unit, centre) > limit * limit) continue;
        Crater crater = shape(unit, diameter_m, level, more);
        crater.rim_m = rim_of(crater);
        out.push_back({crater, static_cast<float>(keep)});
      }
    }
  }
}

void keep_craters(std::span<const Candidate> candidates, const MeasuredMars& mars, Simd simd,
                  std::vector<Crater>& out) {
  static thread_local Ground ground;
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
    lay_ground(block, mars, ground);
    for (std::size_t i = 0; i < block.count; ++i) {
      const Candidate& c = candidates[first + i];
      if (ground.post_m[i] < kFreeOfPosts * c.crater.radius_m) continue;
      const double cell = crater_cell_m(c.crater.level);
      const auto lasting =
          static_cast<double>(1.0F - 0.9F * ground.wall[i]) * static_cast<double>(1.0F - 0.97F * ground.ice[i]);
      const double share = level_density(c.crater.level, static_cast<double>(ground.cratered[i])) * cell *
                           cell * posts_make_up(c.crater.radius_m, ground.column_m[i]) * lasting;
      if (static_cast<double>(c.keep) < share) out.push_back(c.crater);
    }
  }
}

void CraterSum::clear() {
  relief.fill(0);
  hollow.fill(0.0F);
  fresh.fill(0.0F);
}

void add_crater(const Block& block, const Crater& crater, const Lane<float>& ragged, const Lane<double>& post_m,
                CraterSum& sum) {
  // Smaller craters smooth nothing.
  Lane<float> ignored{};
  Lane<float>& hollow = crater.level < kHollowCraterLevel ? ignored : sum.hollow;
  with_simd(block.simd, [&] {
    add_body(block, crater, ragged.data(), post_m.data(), sum.relief.data(), hollow.data(), sum.fresh.data());
  });
}

}  // namespace mars::embedded
