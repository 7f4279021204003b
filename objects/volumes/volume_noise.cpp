#include "objects/volumes/volume_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace objects {

namespace {

std::uint64_t lattice_hash(std::uint64_t seed, std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = seed * 0x9E3779B97F4A7C15ULL + 0x632BE59BD9B4E019ULL;
  for (const std::int64_t part : {x, y, z}) {
    h ^= static_cast<std::uint64_t>(part);
    h *= 0xBF58476D1CE4E5B9ULL;
    h ^= h >> 29U;
    h *= 0x94D049BB133111EBULL;
    h ^= h >> 32U;
  }
  return h;
}

// The product of an offset with one of twelve directions, to the middles of a cube's edges.
double slope_of(std::uint64_t hash, double x, double y, double z) {
  const auto h = static_cast<unsigned>((hash >> 40U) % 12);
  const double a = h < 8 ? x : y;
  const double b = h < 4 ? y : z;
  return ((h & 1U) != 0 ? -a : a) + ((h & 2U) != 0 ? -b : b);
}

double faded(double x) { return x * x * x * (x * (x * 6 - 15) + 10); }

}  // namespace

double volume_noise(std::uint64_t seed, const glm::dvec3& at) {
  std::array<std::int64_t, 3> cell{};
  glm::dvec3 in{};
  for (int k = 0; k < 3; ++k) {
    const double low = std::floor(at[k]);
    cell[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(low);
    in[k] = at[k] - low;
  }
  const glm::dvec3 share(faded(in.x), faded(in.y), faded(in.z));
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1;
    const int y = (corner >> 1) & 1;
    const int z = corner >> 2;
    const double weight =
        (x == 1 ? share.x : 1 - share.x) * (y == 1 ? share.y : 1 - share.y) * (z == 1 ? share.z : 1 - share.z);
    sum += weight *
           slope_of(lattice_hash(seed, cell[0] + x, cell[1] + y, cell[2] + z), in.x - x, in.y - y, in.z - z);
  }
  return std::clamp(sum, -1.0, 1.0);
}

double fractal_noise(std::uint64_t seed, const glm::dvec3& at, int octaves) {
  // Each octave is turned, so that no axis shows.
  static const glm::dmat3 kTurn(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
  double sum = 0;
  double size = 1;
  double all = 0;
  glm::dvec3 p = at;
  for (int n = 0; n < octaves; ++n) {
    sum += size * volume_noise(seed + static_cast<std::uint64_t>(n), p);
    all += size;
    size *= 0.5;
    p = 2.0 * (kTurn * p);
  }
  return all > 0 ? sum / all : 0;
}

}  // namespace objects
