// Seeded ground for the mesh tests and benchmarks: fractal noise and craters as a function of direction, so
// that posts shared by tiles and faces have equal bits.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "lod/tree/posts.h"

namespace lod_test {

inline constexpr double kRadius = 3396190.0;

class Terrain {
 public:
  // Noise from `longest_m` down to 2 m, amplitude proportional to wavelength^hurst; craters in a cap about
  // `about`.
  Terrain(std::uint64_t seed, double height_error_m, double longest_m, double hurst = 0.9);
  void add_craters(const glm::dvec3& about, double cap_angle, int count, double smallest_m, double largest_m);

  // Detail finer than 2 spacings is left out.
  double height_m(const glm::dvec3& direction, double spacing_m) const;
  lod::Posts posts(const lod::TileKey& key, int intervals) const;

 private:
  struct Crater {
    glm::dvec3 centre;
    double radius_m;
  };
  std::uint64_t seed_;
  double height_error_m_, longest_m_, hurst_;
  std::vector<Crater> craters_;
};

// Returns posts whose heights are a function of (i, j).
template <class Height>
lod::Posts make_posts(const lod::TileKey& key, int intervals, Height&& height) {
  lod::Posts posts{key, intervals, {}};
  for (int j = 0; j <= intervals; ++j) {
    for (int i = 0; i <= intervals; ++i) posts.height_m.push_back(height(i, j));
  }
  return posts;
}

}  // namespace lod_test
