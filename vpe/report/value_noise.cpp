#include "vpe/report/value_noise.h"

#include <cmath>
#include <initializer_list>

namespace vpe::report {

namespace {

// Returns the random value of a lattice point, -1 to 1.
double lattice_value(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  std::uint64_t h = seed;
  for (const std::int64_t c : {x, y, z}) {
    h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 29;
  }
  return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
}

}  // namespace

double value_noise(const glm::dvec3& p, std::uint64_t seed) {
  const glm::dvec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  const glm::dvec3 f = p - cell;
  const glm::dvec3 s = f * f * (3.0 - 2.0 * f);
  const auto x = static_cast<std::int64_t>(cell.x);
  const auto y = static_cast<std::int64_t>(cell.y);
  const auto z = static_cast<std::int64_t>(cell.z);
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1;
    const int dy = k >> 1 & 1;
    const int dz = k >> 2;
    const double weight = (dx ? s.x : 1.0 - s.x) * (dy ? s.y : 1.0 - s.y) * (dz ? s.z : 1.0 - s.z);
    sum += weight * lattice_value(x + dx, y + dy, z + dz, seed);
  }
  return sum;
}

}  // namespace vpe::report
