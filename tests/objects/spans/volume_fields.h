// Fields of extinction and rays through them, for tests of the stretches of rays in volumes.
#pragma once

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "objects/volumes/volume_march.h"
#include "tests/support/support.h"

namespace objects::volume_fields {

// Returns a level of posts 1 m apart, with post (0, 0, 0) at the origin. `value` takes numbers of posts and returns 0 to 255.
// If it returns 255 somewhere, a stored 1 is an extinction of 1.
template <class Value>
VolumeLevel level_of(const glm::ivec3& posts, const Value& value) {
  DenseVolume dense({{posts.x, posts.y, posts.z}, 1, {0, 0, 0}});
  for (int z = 0; z < posts.z; ++z)
    for (int y = 0; y < posts.y; ++y)
      for (int x = 0; x < posts.x; ++x) dense.at(x, y, z) = static_cast<float>(value(x, y, z));
  return build_level(dense);
}

// Returns a level of random posts; `kind` 0: any, 1: most are 0, 2: one of three values, 3: smooth. With `is_torn` bricks
// disagree about the posts that they share, as a file may have them.
inline VolumeLevel random_level(test_support::Random& random, int kind, bool is_torn) {
  VolumeLattice lattice;
  for (int& side : lattice.posts) side = random.integer(2, 20);
  lattice.spacing_m = kind % 2 == 0 ? 0.5F : 0.3F;
  lattice.corner_m = {-3, 2, 7.3F};
  DenseVolume dense(lattice);
  const glm::dvec3 wave = 0.4 * random.direction();
  std::size_t n = 0;
  for (float& v : dense.values()) {
    const int any = random.integer(0, 255);
    const int x = static_cast<int>(n) % lattice.posts[0];
    const int y = static_cast<int>(n) / lattice.posts[0] % lattice.posts[1];
    const int z = static_cast<int>(n) / lattice.posts[0] / lattice.posts[1];
    const double smooth = 128 + 127 * std::sin(glm::dot(wave, glm::dvec3(x, y, z)));
    const std::array<double, 4> values{static_cast<double>(any), any < 230 ? 0.0 : any,
                                       any < 120   ? 0.0
                                       : any < 200 ? 100.0
                                                   : 255.0,
                                       smooth};
    v = static_cast<float>(values[static_cast<std::size_t>(kind)]);
    ++n;
  }
  dense.at(0, 0, 0) = 255;
  VolumeLevel level = build_level(dense);
  if (is_torn)
    for (std::uint8_t& post : level.posts) post = static_cast<std::uint8_t>(random.integer(0, 255));
  return level;
}

// Returns a ray through a random place: in any direction, along an axis, along a face, through posts, along an edge.
inline VolumeRay random_ray(test_support::Random& random, const VolumeLattice& lattice, int kind, double away) {
  glm::dvec3 at;  // in posts
  for (int k = 0; k < 3; ++k) at[k] = random.uniform(1, lattice.posts[static_cast<std::size_t>(k)] - 1);
  glm::dvec3 d = random.direction();
  const int axis = random.integer(0, 2);
  if (kind == 1 || kind == 4) {
    d = {0, 0, 0};
    d[axis] = random.integer(0, 1) == 0 ? 1 : -2;
  }
  if (kind == 2) d[axis] = 0;
  if (kind == 2) at[axis] = std::floor(at[axis]);
  if (kind >= 3) at = glm::floor(at);
  if (kind == 3)
    for (int k = 0; k < 3; ++k) d[k] = random.integer(-2, 2);
  if (d == glm::dvec3(0)) d.z = 1;
  const auto spacing_m = static_cast<double>(lattice.spacing_m);
  d *= spacing_m;
  return {glm::dvec3(lattice.corner_m) + spacing_m * at - away * d, d};
}

}  // namespace objects::volume_fields
