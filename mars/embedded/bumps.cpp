#include "mars/embedded/bumps.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

void add_bump(const Block& block, const glm::dvec3& c, double reach, double height, Lane<double>& out) {
  // 1 - chord^2 / reach^2, with chord^2 = 2 - 2 cosine.
  const double slope = 2.0 / (reach * reach);
  const double cx = c.x * slope, cy = c.y * slope, cz = c.z * slope;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double t = block.x[i] * cx + block.y[i] * cy + block.z[i] * cz + (1.0 - slope);
      const double positive = t > 0.0 ? t : 0.0;
      out[i] += positive * positive * positive * height;
    }
  });
}

template <typename Coefficient>
void sum(const Block& block, const Bumps<Coefficient>& bumps, Lane<double>& out) {
  for (std::size_t i = 0; i < block.padded; ++i) out[i] = 0.0;
  const auto& centres = bumps.centres;
  const auto before = [](const glm::dvec3& c, double z) { return c.z > z; };
  const double margin = block.reach + bumps.reach;
  const auto first = std::lower_bound(centres.begin(), centres.end(), block.centre.z + margin, before);
  const auto last = std::lower_bound(first, centres.end(), block.centre.z - margin, before);
  for (auto k = static_cast<std::size_t>(first - centres.begin()),
            end = static_cast<std::size_t>(last - centres.begin());
       k < end; ++k) {
    if (block.near(centres[k], bumps.reach))
      add_bump(block, centres[k], bumps.reach, bumps.step * bumps.coefficients[k], out);
  }
}

}  // namespace

glm::dvec3 bump_centre(int k, int count) {
  constexpr double kGolden = 0.61803398874989484820;
  const double z = 1.0 - (2.0 * k + 1.0) / count;
  const double circles = k * kGolden;
  const SinCos lon = exact_sin_cos_deg((circles - floor_int(circles)) * 360.0);
  const double r = std::sqrt(1.0 - z * z);
  return {r * lon.cos, r * lon.sin, z};
}

std::vector<glm::dvec3> bump_centres(int count) {
  std::vector<glm::dvec3> centres(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) centres[static_cast<std::size_t>(k)] = bump_centre(k, count);
  return centres;
}

void sum_bumps(const Block& block, const Bumps<std::int16_t>& bumps, Lane<double>& out) {
  sum(block, bumps, out);
}
void sum_bumps(const Block& block, const Bumps<std::int8_t>& bumps, Lane<double>& out) {
  sum(block, bumps, out);
}

}  // namespace mars::embedded
