#include "objects/points/outward_normals.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "objects/points/sky_view.h"
#include "objects/points/voxel_cube.h"

namespace objects {

namespace {

constexpr int kClearlyMoreSky = 6;    // of kSkySteps
constexpr double kLevelNormal = 0.2;  // the vertical part of a normal that is about level
constexpr int kMoreSteps = 3;         // beyond the width of gaps, to find an end of the filled voxels

class OutwardTurns {
 public:
  OutwardTurns(const PointVoxels& points, const PointSurroundings& around, std::vector<VoxelNormal>& normals)
      : points_(points), around_(around), normals_(normals) {}

  void run() {
    best_.assign(normals_.size(), std::numeric_limits<float>::infinity());
    if (has_outward()) spread();
    use_insides();
    use_skies();
    spread();
    use_positions();
  }

 private:
  struct Open {
    std::uint32_t number = 0;
    glm::ivec3 front{0, 0, 0};  // where the normal points
    glm::ivec3 back{0, 0, 0};
    int more_sky = 0;  // in front
  };
  struct Offer {
    float bend = 0;
    std::uint32_t to = 0;
    std::uint32_t from = 0;
  };
  struct Later {
    bool operator()(const Offer& a, const Offer& b) const {
      return std::tuple(a.bend, a.to, a.from) > std::tuple(b.bend, b.to, b.from);
    }
  };

  bool has_outward() const {
    return std::any_of(normals_.begin(), normals_.end(),
                       [](const VoxelNormal& n) { return n.state == NormalState::kOutward; });
  }

  void settle(std::uint32_t n, bool is_turned) {
    if (is_turned) normals_[n].normal = -normals_[n].normal;
    normals_[n].state = NormalState::kOutward;
  }

  // Returns the first empty voxel on one side, or nullopt if the filled ones are thicker than gaps are wide.
  std::optional<glm::ivec3> end_of_filled(std::uint32_t n, double sign) const {
    const glm::dvec3 at = points_.middle(n);
    for (int step = 1; step <= 2 * around_.close_voxels + kMoreSteps; ++step) {
      const glm::ivec3 v(glm::floor(at + sign * step * normals_[n].normal));
      if (!around_.filled.is_set(v.x, v.y, v.z)) return v;
    }
    return {};
  }

  void use_insides() {
    for (std::uint32_t n = 0; n < normals_.size(); ++n) {
      if (normals_[n].state != NormalState::kTwoSided) continue;
      const std::optional<glm::ivec3> front = end_of_filled(n, 1);
      const std::optional<glm::ivec3> back = end_of_filled(n, -1);
      if (front && back)
        open_.push_back({n, *front, *back, 0});
      else if (front || back)
        settle(n, !front);
    }
  }

  void use_skies() {
    if (open_.empty()) return;
    for (const glm::ivec3& step : kSkySteps) {
      const VoxelGrid view = sky_view(around_.filled, step);
      for (Open& o : open_)
        o.more_sky += (sees_sky(view, o.front, step) ? 1 : 0) - (sees_sky(view, o.back, step) ? 1 : 0);
    }
    for (const Open& o : open_)
      if (std::abs(o.more_sky) >= kClearlyMoreSky) settle(o.number, o.more_sky < 0);
  }

  // Returns how far a surface bends between two voxels, 0 to 2: 0 for two of one plane, 1 for the sides of a plate.
  float bend(std::uint32_t a, std::uint32_t b) const {
    const glm::dvec3 own = normals_[a].normal;
    const double along = glm::dot(own, normals_[b].normal);
    const glm::dvec3 other = along < 0 ? -normals_[b].normal : normals_[b].normal;
    const glm::dvec3 way = points_.middle(b) - points_.middle(a);
    const double length = glm::length(way);
    const double across = length > 0 ? std::abs(glm::dot(own + other, way)) / (2 * length) : 0.0;
    return static_cast<float>(1 - std::abs(along) + across);
  }

  template <class Visit>
  void for_each_neighbour(std::uint32_t n, const Visit& visit) const {
    for_each_in_cube(around_.held, around_.held.voxel_of(points_.places()[n]), normals_[n].reach,
                     [&](std::uint64_t place) { visit(points_.number(place)); });
  }

  void offer(std::uint32_t from, std::uint32_t to) {
    const float cost = bend(from, to);
    if (cost > best_[to]) return;
    best_[to] = cost;
    offers_.push({cost, to, from});
  }

  void settle_all() {
    while (!offers_.empty()) {
      const Offer next = offers_.top();
      offers_.pop();
      if (normals_[next.to].state != NormalState::kTwoSided) continue;
      settle(next.to, glm::dot(normals_[next.from].normal, normals_[next.to].normal) < 0);
      offer_to_neighbours(next.to);
    }
  }

  void offer_to_neighbours(std::uint32_t from) {
    for_each_neighbour(from, [&](std::uint32_t to) {
      if (normals_[to].state == NormalState::kTwoSided) offer(from, to);
    });
  }

  // Begins at the two-sided ones, of which there are few where the others are known.
  void spread() {
    for (std::uint32_t to = 0; to < normals_.size(); ++to) {
      if (normals_[to].state != NormalState::kTwoSided) continue;
      for_each_neighbour(to, [&](std::uint32_t from) {
        if (normals_[from].state == NormalState::kOutward) offer(from, to);
      });
    }
    settle_all();
  }

  void use_positions() {
    std::vector<std::uint32_t> rest;
    for (std::uint32_t n = 0; n < normals_.size(); ++n)
      if (normals_[n].state == NormalState::kTwoSided) rest.push_back(n);
    const auto key = [&](std::uint32_t n) {
      return std::tuple(-around_.held.voxel_of(points_.places()[n]).z, points_.places()[n]);
    };
    std::sort(rest.begin(), rest.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    const glm::dvec3 middle = middle_of_all();
    for (const std::uint32_t n : rest) {
      if (normals_[n].state != NormalState::kTwoSided) continue;
      const glm::dvec3 normal = normals_[n].normal;
      double side = normal.z;
      if (std::abs(side) < kLevelNormal) side = glm::dot(normal, points_.middle(n) - middle);
      for (int k = 2; k >= 0 && side == 0; --k) side = normal[k];
      settle(n, side < 0);
      offer_to_neighbours(n);
      settle_all();
    }
  }

  glm::dvec3 middle_of_all() const {
    glm::ivec3 low(StickLimits::kMostSide);
    glm::ivec3 high(0);
    for (const std::uint64_t place : points_.places()) {
      low = glm::min(low, around_.held.voxel_of(place));
      high = glm::max(high, around_.held.voxel_of(place));
    }
    return 0.5 * glm::dvec3(low + high + 1);
  }

  const PointVoxels& points_;
  const PointSurroundings& around_;
  std::vector<VoxelNormal>& normals_;
  std::vector<Open> open_;
  std::vector<float> best_;  // the least bend offered so far
  std::priority_queue<Offer, std::vector<Offer>, Later> offers_;
};

}  // namespace

void turn_outward(const PointVoxels& points, const PointSurroundings& around,
                  std::vector<VoxelNormal>& normals) {
  OutwardTurns(points, around, normals).run();
}

}  // namespace objects
