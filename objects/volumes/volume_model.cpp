#include "objects/volumes/volume_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <utility>

#include "objects/volumes/volume_march.h"

namespace objects {

namespace {

// Calls each(place_m) for the posts with extinction.
template <class Each>
void for_filled_posts(const VolumeLevel& level, const Each& each) {
  constexpr int kSide = VolumeLevel::kBrickSide;
  constexpr int kCells = VolumeLevel::kBrickCells;
  const std::array<int, 3> bricks{level.bricks(0), level.bricks(1), level.bricks(2)};
  std::size_t n = 0;
  for (int bz = 0; bz < bricks[2]; ++bz) {
    for (int by = 0; by < bricks[1]; ++by) {
      for (int bx = 0; bx < bricks[0]; ++bx) {
        const std::uint32_t place = level.places[n++];
        if (place == 0) continue;
        const std::uint8_t* post = level.posts.data() + (place - 1) * VolumeLevel::kBrickPosts;
        for (int z = 0; z < kSide; ++z) {
          for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
              if (*post++ == 0) continue;
              const glm::vec3 at(bx * kCells + x, by * kCells + y, bz * kCells + z);
              each(level.lattice.corner_m + level.lattice.spacing_m * at);
            }
          }
        }
      }
    }
  }
}

// The mean over three directions stands for that over all.
VolumeLook look_along_axes(const VolumeLevel& level, const glm::dvec3& low_m, const glm::dvec3& high_m) {
  constexpr int kRays = 64;  // along the longer side
  VolumeLook look;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double step_m = std::max(high_m[u] - low_m[u], high_m[v] - low_m[v]) / kRays;
    for (double y = low_m[v] + step_m / 2; y < high_m[v]; y += step_m) {
      for (double x = low_m[u] + step_m / 2; x < high_m[u]; x += step_m) {
        VolumeRay ray{low_m, {0, 0, 0}};
        ray.origin_m[u] = x;
        ray.origin_m[v] = y;
        ray.direction[axis] = 1;
        const double depth = optical_depth(level, ray, 0, high_m[axis] - low_m[axis]);
        if (!(depth > 0)) continue;
        look.silhouette_m2 += step_m * step_m / 3;
        look.opacity += (1 - std::exp(-depth)) * step_m * step_m / 3;
      }
    }
  }
  if (look.silhouette_m2 > 0) look.opacity /= look.silhouette_m2;
  return look;
}

}  // namespace

double optical_depth(const VolumeLevel& level, const VolumeRay& ray, double begin, double end) {
  double sum = 0;
  march(level, ray, begin, end, [&](const VolumeStep& step) {
    sum += step.depth;
    return true;
  });
  return sum;
}

VolumeModel::VolumeModel(VolumeLevel finest, Rgba colour) : colour_(colour) {
  const std::string problem = check(finest);
  if (!problem.empty()) throw std::invalid_argument("a volume cannot be drawn: " + problem);
  levels_.push_back(std::move(finest));
  colour_.a = 255;
  constexpr float kMost = std::numeric_limits<float>::infinity();
  low_m_ = glm::vec3(kMost);
  high_m_ = glm::vec3(-kMost);
  for_filled_posts(levels_[0], [&](const glm::vec3& place_m) {
    low_m_ = glm::min(low_m_, place_m);
    high_m_ = glm::max(high_m_, place_m);
  });
  if (!(low_m_.x <= high_m_.x)) throw std::invalid_argument("a volume cannot be drawn: it is empty");
  const std::vector<std::uint8_t>& posts = levels_[0].posts;
  largest_per_m_ = *std::max_element(posts.begin(), posts.end()) * static_cast<double>(levels_[0].unit_per_m);
  ball_.centre_m = 0.5F * (low_m_ + high_m_);
  const auto radius_of = [&](const VolumeLevel& level) {
    float farthest_m = 0;
    for_filled_posts(level, [&](const glm::vec3& p) {
      farthest_m = std::max(farthest_m, glm::distance(p, ball_.centre_m));
    });
    return (farthest_m + std::sqrt(3.0F) * level.lattice.spacing_m) * 1.00001F;
  };
  low_m_ -= levels_[0].lattice.spacing_m;
  high_m_ += levels_[0].lattice.spacing_m;
  ball_.radius_m = radius_of(levels_[0]);
  // Levels that would make the ball much larger are left out.
  constexpr float kMostGrowth = 0.15F;
  const float most_radius_m = (1 + kMostGrowth) * ball_.radius_m;
  for (;;) {
    VolumeLevel coarser = halved(levels_.back());
    const float radius_m = radius_of(coarser);
    if (!(radius_m <= most_radius_m)) break;
    ball_.radius_m = std::max(ball_.radius_m, radius_m);
    levels_.push_back(std::move(coarser));
  }
  look_ = look_along_axes(levels_.back(), glm::dvec3(ball_.centre_m - ball_.radius_m),
                          glm::dvec3(ball_.centre_m + ball_.radius_m));
}

double VolumeModel::level_error_m(std::size_t level) const {
  return level == 0 ? 0 : static_cast<double>(levels_[level].lattice.spacing_m);
}

std::size_t VolumeModel::bytes() const {
  std::size_t sum = 0;
  for (const VolumeLevel& level : levels_) sum += level.bytes();
  return sum;
}

}  // namespace objects
