#include "mars/embedded/detail.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

constexpr double kCellsPerDiameter = 2.5;
constexpr double kLongest = 1.5;  // radii from the middle that a rock of mean length reaches
constexpr double kSpread = 1.25;  // compensates for the part of the outline that the faces cut away

// Describes a size class: diameters from smallest_m to twice that.
struct Class {
  double smallest_m;
  double chance;  // probability that a cell of the lattice (edge kCellsPerDiameter * smallest_m) has one
};
// The covered areas are F(D) - F(2 D); the rock of a cell covers 0.23 of it on average. The formula gives no
// rocks beyond 2 m; those here fell from walls or were ejected from craters.
constexpr Class kClasses[] = {{4.0, 0.010}, {2.0, 0.030},  {1.0, 0.147},  {0.5, 0.336},
                              {0.25, 0.37}, {0.125, 0.28}, {0.0625, 0.17}};

struct Rock {
  glm::dvec3 centre, e1, e2;  // e1, e2: along the ground, 1 / m (of the rock's half-width)
  float height_m, keep, tone;
  float offset[5], steep[5];
};

constexpr float kCos[5] = {1.0F, 0.309F, -0.809F, -0.809F, 0.309F};
constexpr float kSin[5] = {0.0F, 0.951F, 0.588F, -0.588F, -0.951F};

Rock shape(const glm::dvec3& centre, double diameter_m, std::uint64_t bits, float keep) {
  Rock r;
  r.centre = centre;
  r.keep = keep;
  const std::uint64_t more = mix_bits(bits + 0x632be59bd9b4e019ULL);
  const std::uint64_t most = mix_bits(more + 0x9e3779b97f4a7c15ULL);
  // The axes along the ground have a random azimuth.
  const glm::dvec3 q{fraction16(more, 0) - 0.5, fraction16(more, 16) - 0.5, fraction16(more, 32) - 0.5001};
  glm::dvec3 a{centre.y * q.z - centre.z * q.y, centre.z * q.x - centre.x * q.z,
               centre.x * q.y - centre.y * q.x};
  const double size = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z) + 1e-9;
  a = a / size;
  const glm::dvec3 b{centre.y * a.z - centre.z * a.y, centre.z * a.x - centre.x * a.z,
                     centre.x * a.y - centre.y * a.x};
  const double longer = 1.0 + 0.3 * fraction16(more, 48);
  r.e1 = a * (kRadius_m * 2.0 / (kSpread * diameter_m) / longer);
  r.e2 = b * (kRadius_m * 2.0 / (kSpread * diameter_m) * longer);
  r.height_m = static_cast<float>(diameter_m * (0.38 + 0.42 * fraction16(most, 0)));
  r.tone = static_cast<float>(2.0 * fraction16(most, 16) - 1.0);
  std::uint64_t facets = mix_bits(most + 1);
  for (int k = 0; k < 5; ++k) {
    r.offset[k] = 0.85F + 0.65F * static_cast<float>(facets & 0x3f) * (1.0F / 64.0F);
    r.steep[k] = 1.25F + 1.25F * static_cast<float>(facets >> 6 & 0x3f) * (1.0F / 64.0F);
    facets >>= 12;
  }
  return r;
}

[[gnu::always_inline]] inline void add_rock(const Block& block, const Rock& r, const float* __restrict bare,
                                            float* __restrict height_m, float* __restrict tone) {
  for (std::size_t i = 0; i < block.padded; ++i) {
    const double dx = block.x[i] - r.centre.x;
    const double dy = block.y[i] - r.centre.y;
    const double dz = block.z[i] - r.centre.z;
    const auto p = static_cast<float>(dx * r.e1.x + dy * r.e1.y + dz * r.e1.z);
    const auto q = static_cast<float>(dx * r.e2.x + dy * r.e2.y + dz * r.e2.z);
    // The height is the minimum of five sloping faces, a slanting top and a paraboloid that bounds the rock.
    float h = std::min(0.62F + 0.26F * p - 0.12F * q, 1.9F * (1.0F - 0.75F * (p * p + q * q)));
    for (int k = 0; k < 5; ++k) h = std::min(h, r.offset[k] - r.steep[k] * (kCos[k] * p + kSin[k] * q));
    const float out = std::min(1.0F, (bare[i] - r.keep) * 5.0F);
    const float up = r.height_m * (h - 0.12F - (1.0F - out));
    tone[i] = up > height_m[i] ? r.tone : tone[i];
    height_m[i] = up > height_m[i] ? up : height_m[i];
  }
}

}  // namespace

void strew_rocks(const Block& block, double detail_m, const Lane<float>& bare, const Lane<float>& gravelly,
                 Rocks& out) {
  out.height_m.fill(0.0F);
  out.tone.fill(0.0F);
  // Cells are visited in columns along the axis nearest to the vertical.
  const glm::dvec3 size{std::abs(block.centre.x), std::abs(block.centre.y), std::abs(block.centre.z)};
  const int w = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  const double side = block.centre[w] < 0.0 ? -1.0 : 1.0;
  for (const Class& c : kClasses) {
    if (c.smallest_m < detail_m) continue;
    const Lane<float>& standing = c.smallest_m < kGravel_m ? gravelly : bare;
    const float barest =
        *std::max_element(standing.begin(), standing.begin() + static_cast<std::ptrdiff_t>(block.padded));
    if (barest <= 0.0F) continue;
    const double cell = kCellsPerDiameter * c.smallest_m;
    const double extent = block.reach * kRadius_m + kLongest * c.smallest_m + 1.5 * cell;
    const double inner = (kRadius_m - 0.5 * cell) * (kRadius_m - 0.5 * cell);
    const double outer = (kRadius_m + 0.5 * cell) * (kRadius_m + 0.5 * cell);
    const auto index = [cell](double x) { return static_cast<std::int64_t>(floor_int(x / cell)); };
    const double cu = block.centre[u] * kRadius_m, cv = block.centre[v] * kRadius_m;
    for (std::int64_t i = index(cu - extent), i1 = index(cu + extent); i <= i1; ++i) {
      for (std::int64_t j = index(cv - extent), j1 = index(cv + extent); j <= j1; ++j) {
        const double mu = (static_cast<double>(i) + 0.5) * cell;
        const double mv = (static_cast<double>(j) + 0.5) * cell;
        const double ww = kRadius_m * kRadius_m - mu * mu - mv * mv;
        if (ww <= 0.0) continue;
        const std::int64_t middle = index(side * std::sqrt(ww));
        for (std::int64_t k = middle - 2; k <= middle + 2; ++k) {
          std::int64_t at[3];
          at[u] = i;
          at[v] = j;
          at[w] = k;
          const std::uint64_t bits = mix_bits(static_cast<std::uint64_t>(at[0]) * 0x9e3779b97f4a7c15ULL ^
                                              static_cast<std::uint64_t>(at[1]) * 0xc2b2ae3d27d4eb4fULL ^
                                              static_cast<std::uint64_t>(at[2]) * 0x165667b19e3779f9ULL ^
                                              static_cast<std::uint64_t>(c.smallest_m * 64.0));
          const double lot = fraction16(bits, 48);
          if (lot >= c.chance) continue;
          const double x = (static_cast<double>(at[0]) + fraction16(bits, 0)) * cell;
          const double y = (static_cast<double>(at[1]) + fraction16(bits, 16)) * cell;
          const double z = (static_cast<double>(at[2]) + fraction16(bits, 32)) * cell;
          const double rr = x * x + y * y + z * z;
          if (rr < inner || rr >= outer) continue;
          const auto keep = static_cast<float>(lot / c.chance);
          if (keep >= barest) continue;
          const double r = std::sqrt(rr);
          const std::uint64_t own = mix_bits(bits + 0x51ed270b27d4eb4fULL);
          const double diameter_m = c.smallest_m / std::sqrt(1.0 - 0.75 * fraction16(own, 0));
          const glm::dvec3 centre{x / r, y / r, z / r};
          if (!block.near(centre, 0.5 * diameter_m * kLongest * 1.3 / kRadius_m)) continue;
          const Rock rock = shape(centre, diameter_m, own, keep);
          with_simd(block.simd,
                    [&] { add_rock(block, rock, standing.data(), out.height_m.data(), out.tone.data()); });
        }
      }
    }
  }
}

}  // namespace mars::embedded
