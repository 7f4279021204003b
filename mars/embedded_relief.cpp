#include "mars/embedded_relief.h"

#include <algorithm>

#include "mars/embedded_math.h"
#include "mars/embedded_relief_table.h"
#include "mars/embedded_simd.h"

namespace mars::embedded {

namespace {

std::array<glm::dvec3, kReliefKernels> make_centres() {
  std::array<glm::dvec3, kReliefKernels> centres;
  for (int k = 0; k < kReliefKernels; ++k) centres[static_cast<std::size_t>(k)] = relief_centre(k);
  return centres;
}

void add_bump(const Block& block, const glm::dvec3& c, double height, Lane<double>& out) {
  // 1 - chord^2 / reach^2, with chord^2 = 2 - 2 cosine.
  constexpr double kSlope = 2.0 / (kReliefReach * kReliefReach);
  const double cx = c.x * kSlope, cy = c.y * kSlope, cz = c.z * kSlope;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double t = block.x[i] * cx + block.y[i] * cy + block.z[i] * cz + (1.0 - kSlope);
      const double positive = t > 0.0 ? t : 0.0;
      out[i] += positive * positive * positive * height;
    }
  });
}

}  // namespace

glm::dvec3 relief_centre(int k) {
  constexpr double kGolden = 0.61803398874989484820;
  const double z = 1.0 - (2.0 * k + 1.0) / kReliefKernels;
  const double turns = k * kGolden;
  const SinCos lon = exact_sin_cos_deg((turns - floor_int(turns)) * 360.0);
  const double r = std::sqrt(1.0 - z * z);
  return {r * lon.cos, r * lon.sin, z};
}

void relief(const Block& block, Lane<double>& out) {
  static const auto centres = make_centres();
  for (std::size_t i = 0; i < block.padded; ++i) out[i] = 0.0;
  // The centres come in order of falling z.
  const auto before = [](const glm::dvec3& c, double z) { return c.z > z; };
  const double margin = block.reach + kReliefReach;
  const auto first = std::lower_bound(centres.begin(), centres.end(), block.centre.z + margin, before);
  const auto last = std::lower_bound(first, centres.end(), block.centre.z - margin, before);
  for (auto k = static_cast<std::size_t>(first - centres.begin()),
            end = static_cast<std::size_t>(last - centres.begin());
       k < end; ++k) {
    if (block.near(centres[k], kReliefReach)) add_bump(block, centres[k], kReliefStep_m * kReliefTable[k], out);
  }
}

}  // namespace mars::embedded
