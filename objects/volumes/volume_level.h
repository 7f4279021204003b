// Fields of extinction in bricks: what light loses on a metre of its way through dust or cloud.
//
// A field is given at the posts of a lattice, is interpolated trilinearly between them and is 0 outside. Bricks of 8 x 8 x
// 8 cells hold their posts, those of their upper sides too, so that a cell needs one brick. Bricks without extinction are
// not stored. A coarser level has posts twice as far apart and the same sum of extinction.
//
// Typical usage:
//   DenseVolume dense({{nx, ny, nz}, 0.5F, corner_m});
//   dense.at(i, j, k) = 0.02F;
//   const VolumeLevel level = build_level(dense);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace objects {

// Gives the limits that check() enforces, so that no file can claim all memory.
struct VolumeLimits {
  static constexpr int kMostSide = 2048;                           // posts along an axis
  static constexpr std::size_t kMostPosts = std::size_t{1} << 26;  // of a level, with those of empty bricks
  static constexpr float kMostExtinction_per_m = 1e6F;
  static constexpr float kMostExtent_m = 1e8F;  // of a coordinate
};

// Places posts in the model frame (objects/model/mesh.h).
struct VolumeLattice {
  std::array<int, 3> posts{0, 0, 0};  // along x, y and z; at least 2
  float spacing_m = 0;
  glm::vec3 corner_m{0, 0, 0};  // of post (0, 0, 0)

  bool operator==(const VolumeLattice&) const = default;
};

// Returns the number of posts of a lattice. Pure.
std::size_t post_count(const VolumeLattice& lattice);

// Holds a field without bricks, for making it.
class DenseVolume {
 public:
  // Makes a field of 0. Throws std::invalid_argument for a lattice beyond VolumeLimits.
  explicit DenseVolume(const VolumeLattice& lattice);

  const VolumeLattice& lattice() const { return lattice_; }
  float& at(int x, int y, int z) { return per_m_[index(x, y, z)]; }
  float at(int x, int y, int z) const { return per_m_[index(x, y, z)]; }
  std::vector<float>& values() { return per_m_; }

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(lattice_.posts[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(lattice_.posts[0]) +
           static_cast<std::size_t>(x);
  }

  VolumeLattice lattice_;
  std::vector<float> per_m_;  // extinction; x runs fastest
};

struct VolumeLevel {
  static constexpr int kBrickCells = 8;
  static constexpr int kBrickSide = kBrickCells + 1;  // posts
  static constexpr std::size_t kBrickPosts = std::size_t{kBrickSide} * kBrickSide * kBrickSide;

  VolumeLattice lattice;
  float unit_per_m = 0;               // extinction of a stored 1
  std::vector<std::uint32_t> places;  // of bricks, x runs fastest: 1 + the number of the brick; 0: empty
  std::vector<std::uint8_t> posts;    // kBrickPosts for each brick, x runs fastest

  bool operator==(const VolumeLevel&) const = default;
  std::size_t bytes() const { return places.size() * sizeof(places[0]) + posts.size(); }
  // Returns the number of places of bricks along an axis.
  int bricks(std::size_t axis) const { return (lattice.posts[axis] + kBrickCells - 2) / kBrickCells; }
};

// Returns the number of places of bricks that a level on a lattice has. Pure.
std::size_t place_count(const VolumeLattice& lattice);

// Returns a field in bricks, with posts of 0 all around it, so that it has no steps. Values are rounded to a 255th of the
// largest one. Values below 0 and those that are not finite count as 0. Throws std::invalid_argument for a field beyond
// VolumeLimits.
VolumeLevel build_level(const DenseVolume& dense);

// Returns the next coarser level. The sum of extinction stays, but for the rounding of values: each post gives half of its
// value to the coarse post at its place, or a quarter to each of those beside it, along each axis.
VolumeLevel halved(const VolumeLevel& level);

// Returns "" if rays can be cast through a level, else what is wrong with it: sizes, numbers of bricks, numbers that are
// not finite, limits. Pure.
std::string check(const VolumeLevel& level);

// Returns the extinction at a place of the model frame, 1/m. Pure.
double extinction_per_m(const VolumeLevel& level, const glm::dvec3& place_m);

}  // namespace objects
