#include "objects/volumes/volume_level.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <stdexcept>

namespace objects {

namespace {

using BrickPlace = std::array<int, 3>;

std::string problem_of_lattice(const VolumeLattice& lattice) {
  for (const int side : lattice.posts) {
    if (side < 2 || side > VolumeLimits::kMostSide) return "a side is out of range";
  }
  if (post_count(lattice) > VolumeLimits::kMostPosts) return "it has too many posts";
  if (!(lattice.spacing_m > 0 && lattice.spacing_m <= VolumeLimits::kMostExtent_m))
    return "the distance of its posts is out of range";
  for (int k = 0; k < 3; ++k) {
    const float end_m = lattice.corner_m[k] +
                        lattice.spacing_m * static_cast<float>(lattice.posts[static_cast<std::size_t>(k)]);
    if (!(std::abs(lattice.corner_m[k]) <= VolumeLimits::kMostExtent_m) ||
        !(std::abs(end_m) <= VolumeLimits::kMostExtent_m))
      return "it reaches too far";
  }
  return "";
}

// Calls each(place, number of the place) for all places of bricks.
template <class Each>
void for_bricks(const VolumeLevel& level, const Each& each) {
  std::size_t n = 0;
  for (int z = 0; z < level.bricks(2); ++z) {
    for (int y = 0; y < level.bricks(1); ++y) {
      for (int x = 0; x < level.bricks(0); ++x) each(BrickPlace{x, y, z}, n++);
    }
  }
}

std::size_t post_of_brick(int x, int y, int z) {
  constexpr int kSide = VolumeLevel::kBrickSide;
  return static_cast<std::size_t>(x + kSide * (y + kSide * z));
}

// Returns the least lattice that has a post beside each post of this one.
VolumeLattice widened_lattice(const VolumeLattice& lattice) {
  VolumeLattice out = lattice;
  for (int k = 0; k < 3; ++k) {
    out.posts[static_cast<std::size_t>(k)] += 2;
    out.corner_m[k] -= lattice.spacing_m;
  }
  return out;
}

// Takes the value of a post by its number along each axis, 0 outside.
template <class Value>
VolumeLevel in_bricks(const VolumeLattice& lattice, float largest, const Value& value) {
  constexpr int kCells = VolumeLevel::kBrickCells;
  constexpr int kSide = VolumeLevel::kBrickSide;
  VolumeLevel level;
  level.lattice = lattice;
  level.unit_per_m = largest / 255;
  if (!(level.unit_per_m > 0)) level.unit_per_m = 1;
  level.places.assign(place_count(lattice), 0);
  std::array<std::uint8_t, VolumeLevel::kBrickPosts> brick{};
  std::uint32_t count = 0;
  for_bricks(level, [&](const BrickPlace& b, std::size_t n) {
    bool is_empty = true;
    std::size_t at = 0;
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const float v = value(b[0] * kCells + x, b[1] * kCells + y, b[2] * kCells + z);
          brick[at] = static_cast<std::uint8_t>(std::lround(v / level.unit_per_m));
          is_empty = is_empty && brick[at] == 0;
          ++at;
        }
      }
    }
    if (is_empty) return;
    level.posts.insert(level.posts.end(), brick.begin(), brick.end());
    level.places[n] = ++count;
  });
  level.posts.shrink_to_fit();
  return level;
}

}  // namespace

std::size_t post_count(const VolumeLattice& lattice) {
  std::size_t count = 1;
  for (const int side : lattice.posts) count *= static_cast<std::size_t>(side);
  return count;
}

std::size_t place_count(const VolumeLattice& lattice) {
  VolumeLevel level;
  level.lattice = lattice;
  std::size_t count = 1;
  for (std::size_t k = 0; k < 3; ++k) count *= static_cast<std::size_t>(level.bricks(k));
  return count;
}

DenseVolume::DenseVolume(const VolumeLattice& lattice) : lattice_(lattice) {
  const std::string problem = problem_of_lattice(lattice);
  if (!problem.empty()) throw std::invalid_argument("a volume cannot be made: " + problem);
  per_m_.assign(post_count(lattice), 0);
}

VolumeLevel build_level(const DenseVolume& dense) {
  const VolumeLattice lattice = widened_lattice(dense.lattice());
  const std::string problem = problem_of_lattice(lattice);
  if (!problem.empty()) throw std::invalid_argument("a volume cannot be made: " + problem);
  const auto sound = [](float v) { return std::isfinite(v) && v > 0 ? v : 0.0F; };
  const std::array<int, 3>& posts = dense.lattice().posts;
  const auto value = [&](int x, int y, int z) {
    const bool is_inside = x >= 1 && y >= 1 && z >= 1 && x <= posts[0] && y <= posts[1] && z <= posts[2];
    return is_inside ? sound(dense.at(x - 1, y - 1, z - 1)) : 0.0F;
  };
  float largest = 0;
  for (int z = 1; z <= posts[2]; ++z) {
    for (int y = 1; y <= posts[1]; ++y) {
      for (int x = 1; x <= posts[0]; ++x) largest = std::max(largest, value(x, y, z));
    }
  }
  if (largest > VolumeLimits::kMostExtinction_per_m)
    throw std::invalid_argument("a volume cannot be made: its extinction is too large");
  return in_bricks(lattice, largest, value);
}

VolumeLevel halved(const VolumeLevel& level) {
  // Coarse post n lies at the fine post 2 n - 2, so the first and the last one are 0.
  VolumeLattice lattice = level.lattice;
  lattice.spacing_m *= 2;
  for (int k = 0; k < 3; ++k) {
    int& side = lattice.posts[static_cast<std::size_t>(k)];
    side = (side + 3) / 2 + 1;
    lattice.corner_m[k] -= lattice.spacing_m;
  }
  std::vector<float> sums(post_count(lattice), 0);
  const auto index = [&](int x, int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(lattice.posts[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(lattice.posts[0]) +
           static_cast<std::size_t>(x);
  };
  constexpr int kCells = VolumeLevel::kBrickCells;
  for_bricks(level, [&](const BrickPlace& b, std::size_t n) {
    if (level.places[n] == 0) return;
    const std::uint8_t* posts = level.posts.data() + (level.places[n] - 1) * VolumeLevel::kBrickPosts;
    // Posts of upper sides belong to the next brick.
    for (int z = 0; z < kCells; ++z) {
      for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
          const std::uint8_t post = posts[post_of_brick(x, y, z)];
          if (post == 0) continue;
          const std::array<int, 3> fine{b[0] * kCells + x, b[1] * kCells + y, b[2] * kCells + z};
          // A file may have values beyond its lattice.
          const std::array<int, 3>& sides = level.lattice.posts;
          if (fine[0] >= sides[0] || fine[1] >= sides[1] || fine[2] >= sides[2]) continue;
          for (int corner = 0; corner < 8; ++corner) {
            std::array<int, 3> at{};
            float weight = 1;
            for (std::size_t k = 0; k < 3; ++k) {
              const int side = (corner >> k) & 1;
              const bool is_between = fine[k] % 2 != 0;
              at[k] = (is_between ? (fine[k] + 1) / 2 : fine[k] / 2 + 1) + side;
              weight *= is_between ? 0.25F : (side == 0 ? 0.5F : 0.0F);
            }
            if (weight > 0) sums[index(at[0], at[1], at[2])] += weight * static_cast<float>(post);
          }
        }
      }
    }
  });
  float largest = 0;
  for (float& v : sums) largest = std::max(largest, v *= level.unit_per_m);
  return in_bricks(lattice, largest, [&](int x, int y, int z) {
    const bool is_inside = x < lattice.posts[0] && y < lattice.posts[1] && z < lattice.posts[2];
    return is_inside ? sums[index(x, y, z)] : 0.0F;
  });
}

std::string check(const VolumeLevel& level) {
  std::string problem = problem_of_lattice(level.lattice);
  if (!problem.empty()) return problem;
  if (level.places.size() != place_count(level.lattice)) return "it has another number of places of bricks";
  if (!(level.unit_per_m > 0 && level.unit_per_m <= VolumeLimits::kMostExtinction_per_m))
    return "its extinction is out of range";
  if (level.posts.size() % VolumeLevel::kBrickPosts != 0) return "a brick is incomplete";
  const std::size_t bricks = level.posts.size() / VolumeLevel::kBrickPosts;
  // Each brick has one place, in the order of places.
  std::uint32_t next = 1;
  for (const std::uint32_t place : level.places) {
    if (place == 0) continue;
    if (place != next) return "its bricks are out of order";
    ++next;
  }
  if (next - 1 != bricks) return "it has another number of bricks";
  return "";
}

double extinction_per_m(const VolumeLevel& level, const glm::dvec3& place_m) {
  const glm::dvec3 at =
      (place_m - glm::dvec3(level.lattice.corner_m)) / static_cast<double>(level.lattice.spacing_m);
  std::array<int, 3> cell{};
  glm::dvec3 share{};
  for (int k = 0; k < 3; ++k) {
    const auto n = static_cast<std::size_t>(k);
    const int last = level.lattice.posts[n] - 1;
    if (!(at[k] >= 0 && at[k] <= last)) return 0;
    cell[n] = std::min(static_cast<int>(at[k]), last - 1);
    share[k] = at[k] - cell[n];
  }
  constexpr int kCells = VolumeLevel::kBrickCells;
  const std::size_t place =
      (static_cast<std::size_t>(cell[2] / kCells) * static_cast<std::size_t>(level.bricks(1)) +
       static_cast<std::size_t>(cell[1] / kCells)) *
          static_cast<std::size_t>(level.bricks(0)) +
      static_cast<std::size_t>(cell[0] / kCells);
  if (level.places[place] == 0) return 0;
  const std::uint8_t* posts = level.posts.data() + (level.places[place] - 1) * VolumeLevel::kBrickPosts;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int, 3> post{};
    for (int k = 0; k < 3; ++k) {
      const auto n = static_cast<std::size_t>(k);
      const int side = (corner >> k) & 1;
      post[n] = cell[n] % kCells + side;
      weight *= side == 1 ? share[k] : 1 - share[k];
    }
    sum += weight * posts[post_of_brick(post[0], post[1], post[2])];
  }
  return sum * static_cast<double>(level.unit_per_m);
}

}  // namespace objects
