// Volumes of known content for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <random>

#include "objects/scene/model.h"
#include "objects/volumes/volume_model.h"

namespace objects {

// Returns nx * ny * nz posts of one extinction, symmetric about the origin along x and y, with the lowest posts at z = 0.
// Across it a ray meets n * spacing * extinction, as the field falls to 0 within a spacing beyond the last posts.
inline VolumeLevel slab_level(int nx, int ny, int nz, float spacing_m, float extinction) {
  const auto half = [&](int n) { return -0.5F * spacing_m * static_cast<float>(n - 1); };
  DenseVolume dense({{nx, ny, nz}, spacing_m, {half(nx), half(ny), 0}});
  for (float& v : dense.values()) v = extinction;
  return build_level(dense);
}

// Returns a ball about the origin. Posts take the share of a cell around them that lies in it.
inline VolumeLevel ball_level(float radius_m, float extinction, int posts) {
  const float spacing_m = 2.2F * radius_m / static_cast<float>(posts - 1);
  DenseVolume dense({{posts, posts, posts}, spacing_m, glm::vec3(-1.1F * radius_m)});
  constexpr int kParts = 4;
  for (int z = 0; z < posts; ++z) {
    for (int y = 0; y < posts; ++y) {
      for (int x = 0; x < posts; ++x) {
        int inside = 0;
        for (int n = 0; n < kParts * kParts * kParts; ++n) {
          const glm::vec3 part(n % kParts, n / kParts % kParts, n / kParts / kParts);
          const glm::vec3 at =
              dense.lattice().corner_m +
              spacing_m * (glm::vec3(x, y, z) + (part + 0.5F) / static_cast<float>(kParts) - 0.5F);
          inside += glm::length(at) < radius_m ? 1 : 0;
        }
        dense.at(x, y, z) = extinction * static_cast<float>(inside) / (kParts * kParts * kParts);
      }
    }
  }
  return build_level(dense);
}

// Returns posts of chance, most of them 0, so that bricks are missing.
inline VolumeLevel chance_level(std::uint32_t seed, int side = 21) {
  std::mt19937 random(seed);
  DenseVolume dense({{side, side - 4, side + 6}, 0.5F, {-3, 2, 1}});
  for (int n = 0; n < 160; ++n) {
    const auto any = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
    dense.at(any(side), any(side - 4), any(10)) = static_cast<float>(any(256)) / 100;
  }
  dense.at(1, 1, side + 5) = 0.3F;
  return build_level(dense);
}

inline std::shared_ptr<const Model> volume_model(VolumeLevel level, Rgba colour = {255, 255, 255, 255}) {
  return std::make_shared<const Model>("volume", std::make_shared<const VolumeModel>(std::move(level), colour));
}

// Returns the sum of extinction, in square metres.
inline double mass_m2(const VolumeLevel& level) {
  constexpr int kCells = VolumeLevel::kBrickCells;
  constexpr int kSide = VolumeLevel::kBrickSide;
  double sum = 0;
  for (const std::uint32_t place : level.places) {
    if (place == 0) continue;
    for (int z = 0; z < kCells; ++z) {
      for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
          sum += level.posts[(place - 1) * VolumeLevel::kBrickPosts +
                             static_cast<std::size_t>(x + kSide * (y + kSide * z))];
        }
      }
    }
  }
  const auto spacing_m = static_cast<double>(level.lattice.spacing_m);
  return sum * static_cast<double>(level.unit_per_m) * spacing_m * spacing_m * spacing_m;
}

}  // namespace objects
