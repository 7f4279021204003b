#include "mars/sources/edge_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "mars/geodesy/sphere.h"
#include "mars/sources/boundary_posts.h"
#include "mars/sources/stack_walk.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"

namespace mars {
namespace {

constexpr double kBoundaryWidth_posts = 2;

// Groups posts by cubes of space, the smallest that give at most kEdgePoints groups.
void group(const std::vector<BoundaryPost>& posts, double cell, EdgeMatching& matching) {
  using Cell = std::array<std::int64_t, 3>;
  for (;; cell *= 2) {
    std::map<Cell, std::vector<std::size_t>> cells;
    for (std::size_t i = 0; i < posts.size() && cells.size() <= kEdgePoints; ++i) {
      const glm::dvec3 p = glm::floor(posts[i].direction / cell);
      cells[{static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y), static_cast<std::int64_t>(p.z)}]
          .push_back(i);
    }
    if (cells.size() > kEdgePoints) continue;
    matching.cell_m = cell * matching.radius_m;
    for (const auto& [key, members] : cells) {
      glm::dvec3 sum(0);
      std::vector<double> off;
      for (const std::size_t i : members) {
        sum += posts[i].direction;
        off.push_back(posts[i].off_m);
      }
      matching.boundary.push_back(glm::normalize(sum));
      matching.off_m.push_back(vpe::base::quantile_floor(off, 0.5));
    }
    return;
  }
}

}  // namespace

std::optional<EdgeMatching> fit_edge_matching(const ElevationSource& inset, const ElevationSource& base,
                                              double radius_m, std::size_t max_posts) {
  const std::vector<BoundaryPost> posts = boundary_posts(inset, base, kBoundaryWidth_posts, max_posts);
  if (posts.empty()) return std::nullopt;
  EdgeMatching matching;
  matching.radius_m = radius_m;
  matching.posts = static_cast<std::int64_t>(posts.size());
  // Differences that change within a post of the base are left to the fade: matched, they would leave a string
  // of bumps along the boundary.
  group(posts, std::max(4 * resolution_m(inset), resolution_m(base)) / radius_m, matching);
  double squares = 0;
  std::vector<double> sizes;
  for (const BoundaryPost& post : posts) {
    squares += post.off_m * post.off_m;
    sizes.push_back(std::abs(post.off_m));
  }
  matching.rms_m = std::sqrt(squares / static_cast<double>(posts.size()));
  for (const double off : matching.off_m) {
    if (std::abs(off) > std::abs(matching.largest_m)) matching.largest_m = off;
  }
  matching.reach_m = std::max(8 * resolution_m(base), 50 * vpe::base::quantile_floor(sizes, 0.9));
  matching.cap = enclosing_cap(matching.boundary);
  matching.cap.radius_rad = std::min(kPi, matching.cap.radius_rad + matching.reach_m / radius_m);
  return matching;
}

HeightAdjustment edge_adjustment(const EdgeMatching& matching) {
  return [matching](std::span<const glm::dvec3> directions, std::span<double> heights_m) {
    const double near = std::cos(std::min(kPi, matching.cap.radius_rad + 1e-9));
    const double reach = matching.reach_m / matching.radius_m;
    const double cell2 = (matching.cell_m / matching.radius_m) * (matching.cell_m / matching.radius_m);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (matching.cap.radius_rad < kPi && glm::dot(directions[i], matching.cap.centre) < near) continue;
      double nearest = 5;
      double weights = 0;
      double sum = 0;
      for (std::size_t k = 0; k < matching.boundary.size(); ++k) {
        const glm::dvec3 away = directions[i] - matching.boundary[k];
        const double squared = glm::dot(away, away);
        nearest = std::min(nearest, squared);
        const double weight = 1 / ((squared + cell2) * (squared + cell2));
        weights += weight;
        sum += weight * matching.off_m[k];
      }
      const double distance = std::sqrt(nearest);
      if (distance < reach) heights_m[i] += sum / weights * smooth_step(1 - distance / reach);
    }
  };
}

std::string to_string(const EdgeMatching& matching, const std::string& inset) {
  // The sources determine the correction and are named in the file; these digits distinguish versions of the
  // fit.
  const auto digits = [](double value) { return vpe::base::format_general(value, 17); };
  return "bent by up to " + digits(matching.largest_m) + " m (RMS " + digits(matching.rms_m) + " m) over " +
         digits(matching.reach_m) + " m to meet " + inset;
}

}  // namespace mars
