#include "tests/lod/mesh_terrain.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace lod_test {

namespace {

double lattice(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  std::uint64_t h = seed;
  for (const std::int64_t c : {x, y, z}) {
    h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 29;
  }
  return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
}

double noise(const glm::dvec3& p, std::uint64_t seed) {
  const glm::dvec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  const glm::dvec3 f = p - cell;
  const glm::dvec3 s = f * f * (3.0 - 2.0 * f);
  double sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1;
    const int dy = k >> 1 & 1;
    const int dz = k >> 2;
    const double weight = (dx ? s.x : 1.0 - s.x) * (dy ? s.y : 1.0 - s.y) * (dz ? s.z : 1.0 - s.z);
    sum += weight * lattice(static_cast<std::int64_t>(cell.x) + dx, static_cast<std::int64_t>(cell.y) + dy,
                            static_cast<std::int64_t>(cell.z) + dz, seed);
  }
  return sum;
}

}  // namespace

Terrain::Terrain(std::uint64_t seed, double height_error_m, double longest_m, double hurst)
    : seed_(seed), height_error_m_(height_error_m), longest_m_(longest_m), hurst_(hurst) {}

void Terrain::add_craters(const glm::dvec3& about, double cap_angle, int count, double smallest_m,
                          double largest_m) {
  std::mt19937_64 engine(seed_ + 1);
  const auto unit = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  for (int k = 0; k < count; ++k) {
    const glm::dvec3 off(unit() * 2.0 - 1.0, unit() * 2.0 - 1.0, unit() * 2.0 - 1.0);
    const double u = unit();
    // Cumulative number proportional to radius^-2.
    const double radius =
        std::min(largest_m, smallest_m / std::sqrt(1.0 - u * (1.0 - std::pow(smallest_m / largest_m, 2))));
    craters_.push_back({glm::normalize(about + off * cap_angle), radius});
  }
}

double Terrain::height_m(const glm::dvec3& direction, double spacing_m) const {
  double height = 0.0;
  std::uint64_t seed = seed_;
  for (double wave = longest_m_; wave >= 2.0 * spacing_m; wave *= 0.5) {
    height += std::pow(wave / longest_m_, hurst_) * noise(direction * (kRadius / wave), seed++);
  }
  height *= height_error_m_;
  for (const Crater& crater : craters_) {
    const glm::dvec3 d = direction - crater.centre;
    const double x = std::sqrt(glm::dot(d, d)) * kRadius / crater.radius_m;
    if (x > 3.0) continue;
    const double depth = 0.2 * crater.radius_m;
    height += x < 1.0 ? depth * (1.2 * x * x - 1.0) : depth * 0.2 / (x * x * x) * (3.0 - x) * 0.5;
  }
  return height;
}

lod::Posts Terrain::posts(const lod::TileKey& key, int intervals) const {
  const lod::GridLines lines = lod::grid_lines(key, intervals);
  const double spacing = lod::post_spacing_m(key.level, intervals, kRadius);
  return make_posts(key, intervals, [&](int i, int j) {
    return height_m(mars::chart_direction(key.face, lines.u[static_cast<std::size_t>(i)],
                                          lines.v[static_cast<std::size_t>(j)]),
                    spacing);
  });
}

}  // namespace lod_test
