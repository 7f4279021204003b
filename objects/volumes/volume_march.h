// Rays through fields of extinction.
//
// A ray is cut where it passes from cell to cell. Along it the field of a cell is a polynomial of degree three, which
// Simpson's rule integrates exactly. So the optical depth has no error but rounding (1e-6 of it), whatever the spacing.
//
// Typical usage:
//   const double through = std::exp(-optical_depth(level, ray, 0, until));
//   march(level, ray, 0, until, [&](const VolumeStep& step) { return add(step); });
//   visit_cells(level, in_lattice(level.lattice, ray, 0, until), [&](const CellStretch& s) { return look_at(s); });
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "objects/volumes/volume_level.h"

namespace objects {

// A ray of the model frame. t counts in lengths of its direction, which is not 0.
struct VolumeRay {
  glm::dvec3 origin_m{0, 0, 0};
  glm::dvec3 direction{0, 0, 1};
};

// Describes a stretch of a ray in one cell.
struct VolumeStep {
  double begin = 0;
  double end = 0;
  double depth = 0;  // optical depth, above 0
};

// Describes a ray in the coordinates of a lattice, in which posts are 1 apart and post (0, 0, 0) is the origin, and its
// stretch in the lattice. There is none unless begin < end.
struct LatticeRay {
  glm::dvec3 origin{0, 0, 0};
  glm::dvec3 direction{0, 0, 0};
  glm::dvec3 inverse{0, 0, 0};  // of the direction; 0 where that is 0
  double begin = 0;
  double end = 0;
};

// Returns the part of a ray between two t that lies in a lattice. Pure.
inline LatticeRay in_lattice(const VolumeLattice& lattice, const VolumeRay& ray, double begin, double end) {
  const double per_m = 1 / static_cast<double>(lattice.spacing_m);
  LatticeRay r;
  r.origin = (ray.origin_m - glm::dvec3(lattice.corner_m)) * per_m;
  r.direction = ray.direction * per_m;
  for (int k = 0; k < 3; ++k) {
    const int cells = lattice.posts[static_cast<std::size_t>(k)] - 1;
    if (r.direction[k] == 0) {
      if (!(r.origin[k] >= 0 && r.origin[k] <= cells)) return {};
      continue;
    }
    r.inverse[k] = 1 / r.direction[k];
    const double a = -r.origin[k] * r.inverse[k];
    const double b = (cells - r.origin[k]) * r.inverse[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  r.begin = begin;
  r.end = end;
  return r;
}

// Describes a stretch of a ray in one cell of a brick that is stored.
struct CellStretch {
  const std::uint8_t* brick = nullptr;  // its posts
  glm::ivec3 cell{0, 0, 0};             // in the lattice
  double begin = 0;
  double end = 0;  // above begin

  // Returns the post of the cell's low corner. Those of its other corners follow as those of the brick do.
  const std::uint8_t* posts() const {
    constexpr int kSide = VolumeLevel::kBrickSide;
    constexpr int kCells = VolumeLevel::kBrickCells;
    return brick + (cell.x % kCells + kSide * (cell.y % kCells + kSide * (cell.z % kCells)));
  }
};

namespace volume_march_detail {

// Walks along a ray over cubes of a grid, from the one at t = begin on.
class GridWalk {
 public:
  GridWalk(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& inverse, double begin,
           int side, const glm::ivec3& low, const glm::ivec3& high)
      : origin_(origin), inverse_(inverse), side_(side), low_(low), high_(high) {
    for (int k = 0; k < 3; ++k) {
      turn_[k] = direction[k] > 0 ? 1 : -1;
      is_along_[k] = direction[k] != 0;
      const double place = std::floor((origin[k] + direction[k] * begin) / side);
      at_[k] =
          static_cast<int>(std::clamp(place, static_cast<double>(low[k]), static_cast<double>(high[k] - 1)));
      set_leave(k);
    }
  }
  const glm::ivec3& at() const { return at_; }
  double leave() const { return std::min({leave_[0], leave_[1], leave_[2]}); }
  // Goes on to the next cube. Returns false if there is none.
  bool advance() {
    const int k = leave_[0] <= leave_[1] ? (leave_[0] <= leave_[2] ? 0 : 2) : (leave_[1] <= leave_[2] ? 1 : 2);
    at_[k] += turn_[k];
    if (at_[k] < low_[k] || at_[k] >= high_[k]) return false;
    set_leave(k);
    return true;
  }

 private:
  void set_leave(int k) {
    leave_[k] = is_along_[k] ? ((at_[k] + (turn_[k] > 0 ? 1 : 0)) * side_ - origin_[k]) * inverse_[k]
                             : std::numeric_limits<double>::infinity();
  }

  glm::dvec3 origin_;
  glm::dvec3 inverse_;
  int side_;
  glm::ivec3 low_;
  glm::ivec3 high_;
  glm::ivec3 at_{};
  glm::ivec3 turn_{};
  glm::bvec3 is_along_{};
  glm::dvec3 leave_{};
};

// The posts of a cell.
class VolumeCell {
 public:
  // Takes the post of its low corner in its brick.
  explicit VolumeCell(const std::uint8_t* p) {
    constexpr int kSide = VolumeLevel::kBrickSide;
    int any = 0;
    for (int n = 0; n < 4; ++n) {
      const std::uint8_t* row = p + (n & 1) * kSide + (n >> 1) * kSide * kSide;
      low_[n] = row[0];
      step_[n] = static_cast<float>(row[1] - row[0]);
      any |= row[0] | row[1];
    }
    is_empty_ = any == 0;
  }
  bool is_empty() const { return is_empty_; }
  // Takes a place by its shares of the cell's edges, 0 to 1.
  float at(const glm::vec3& share) const {
    const float a = low_[0] + share.x * step_[0];
    const float b = low_[1] + share.x * step_[1];
    const float c = low_[2] + share.x * step_[2];
    const float d = low_[3] + share.x * step_[3];
    const float below = a + share.y * (b - a);
    const float above = c + share.y * (d - c);
    return below + share.z * (above - below);
  }

 private:
  float low_[4];
  float step_[4];
  bool is_empty_;
};

}  // namespace volume_march_detail

// Calls visit(CellStretch) from near to far for each cell of a stored brick that a ray crosses, until it returns false.
// Stretches of cells that follow each other meet at one t, to the bit. Pure.
template <class Visit>
void visit_cells(const VolumeLevel& level, const LatticeRay& ray, const Visit& visit) {
  using volume_march_detail::GridWalk;
  constexpr int kCells = VolumeLevel::kBrickCells;
  if (!(ray.begin < ray.end)) return;
  const glm::ivec3 cells(level.lattice.posts[0] - 1, level.lattice.posts[1] - 1, level.lattice.posts[2] - 1);
  const glm::ivec3 bricks(level.bricks(0), level.bricks(1), level.bricks(2));
  GridWalk walk(ray.origin, ray.direction, ray.inverse, ray.begin, kCells, glm::ivec3(0), bricks);
  double t = ray.begin;
  while (t < ray.end) {
    const glm::ivec3& b = walk.at();
    const double brick_end = std::min(walk.leave(), ray.end);
    const std::uint32_t place =
        level.places[(static_cast<std::size_t>(b.z) * static_cast<std::size_t>(bricks.y) +
                      static_cast<std::size_t>(b.y)) *
                         static_cast<std::size_t>(bricks.x) +
                     static_cast<std::size_t>(b.x)];
    if (place != 0 && t < brick_end) {
      const std::uint8_t* posts = level.posts.data() + (place - 1) * VolumeLevel::kBrickPosts;
      const glm::ivec3 low = b * kCells;
      const glm::ivec3 high = glm::ivec3(std::min(low.x + kCells, cells.x), std::min(low.y + kCells, cells.y),
                                         std::min(low.z + kCells, cells.z));
      GridWalk inner(ray.origin, ray.direction, ray.inverse, t, 1, low, high);
      while (t < brick_end) {
        const double leave = std::min(inner.leave(), brick_end);
        if (leave > t) {
          if (!visit(CellStretch{posts, inner.at(), t, leave})) return;
          t = leave;
        }
        if (!inner.advance()) break;
      }
    }
    t = std::max(t, brick_end);
    if (!walk.advance()) return;
  }
}

// Calls visit(VolumeStep) from near to far for each cell with extinction that a ray crosses between two t, until it
// returns false. Pure.
template <class Visit>
void march(const VolumeLevel& level, const VolumeRay& ray, double begin, double end, const Visit& visit) {
  using volume_march_detail::VolumeCell;
  const LatticeRay r = in_lattice(level.lattice, ray, begin, end);
  // Is the depth of a stored 1 along t = 1, with the third of Simpson's rule.
  const double unit = glm::length(ray.direction) * static_cast<double>(level.unit_per_m) / 6;
  const std::uint8_t* brick = nullptr;
  float value = -1;  // where the last cell of the brick ended; below 0: not known
  visit_cells(level, r, [&](const CellStretch& s) {
    if (s.brick != brick) {
      brick = s.brick;
      value = -1;
    }
    const VolumeCell cell(s.posts());
    if (cell.is_empty()) {
      value = 0;
      return true;
    }
    const glm::dvec3 corner(s.cell);
    const glm::vec3 from = glm::clamp(glm::vec3(r.origin + s.begin * r.direction - corner), 0.0F, 1.0F);
    const glm::vec3 to = glm::clamp(glm::vec3(r.origin + s.end * r.direction - corner), 0.0F, 1.0F);
    const float first = value < 0 ? cell.at(from) : value;
    const float middle = cell.at(0.5F * (from + to));
    value = cell.at(to);
    const double depth = static_cast<double>(first + 4 * middle + value) * (s.end - s.begin) * unit;
    return !(depth > 0) || visit(VolumeStep{s.begin, s.end, depth});
  });
}

// Returns the optical depth of a ray between two t, the integral of the extinction. Pure.
double optical_depth(const VolumeLevel& level, const VolumeRay& ray, double begin, double end);

}  // namespace objects
