// Seeded random numbers and made-up maps for tests of relief.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <random>
#include <vector>

#include "relief/field/height_map.h"

namespace relief::samples {

// Draws numbers: the same ones in every run.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double in(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967295.0);
  }
  int in(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
  }
  glm::dvec3 in_box(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v = in_box(1);
      if (glm::dot(v, v) > 0.01 && glm::dot(v, v) < 1) return glm::normalize(v);
    }
  }

 private:
  std::mt19937 engine_;
};

// Returns a map of rough ground: independent heights of +-rise_m over long waves.
inline std::shared_ptr<const HeightMap> rough_map(int columns, int rows, double rise_m,
                                                  Interpolation interpolation, unsigned seed, double dx_m = 1,
                                                  double dy_m = 1) {
  Random random(seed);
  std::vector<float> posts;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      posts.push_back(
          static_cast<float>(random.in(-rise_m, rise_m) + 2 * std::sin(0.3 * i) * std::cos(0.2 * j)));
  const MapLayout layout{columns, rows, -0.5 * dx_m * (columns - 1), -0.5 * dy_m * (rows - 1), dx_m, dy_m};
  return std::make_shared<HeightMap>(layout, std::move(posts), interpolation);
}

}  // namespace relief::samples
