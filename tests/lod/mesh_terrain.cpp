#include "tests/lod/mesh_terrain.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "vpe/report/value_noise.h"

namespace lod_test {

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
    height +=
        std::pow(wave / longest_m_, hurst_) * vpe::report::value_noise(direction * (kRadius / wave), seed++);
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
