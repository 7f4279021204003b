#include "mars/sources/edge_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <map>

#include "mars/geodesy/sphere.h"
#include "mars/sources/boundary_posts.h"
#include "mars/sources/stack_walk.h"

namespace mars {
namespace {

constexpr double kAtRim_posts = 2;

double share_of(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Posts gathered in cubes of the unit sphere's space, the smallest that leave at most kBendPoints of them.
void gather(const std::vector<BoundaryPost>& posts, double cell, EdgeMatching& bend) {
  using Cell = std::array<std::int64_t, 3>;
  for (;; cell *= 2) {
    std::map<Cell, std::vector<std::size_t>> cells;
    for (std::size_t i = 0; i < posts.size() && cells.size() <= kEdgePoints; ++i) {
      const glm::dvec3 p = glm::floor(posts[i].direction / cell);
      cells[{static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y), static_cast<std::int64_t>(p.z)}]
          .push_back(i);
    }
    if (cells.size() > kEdgePoints) continue;
    bend.cell_m = cell * bend.radius_m;
    for (const auto& [key, members] : cells) {
      glm::dvec3 sum(0);
      std::vector<double> off;
      for (const std::size_t i : members) {
        sum += posts[i].direction;
        off.push_back(posts[i].off_m);
      }
      bend.boundary.push_back(glm::normalize(sum));
      bend.off_m.push_back(share_of(std::move(off), 0.5));
    }
    return;
  }
}

}  // namespace

std::optional<EdgeMatching> fit_edge_matching(const ElevationSource& inset, const ElevationSource& base,
                                              double radius_m, std::size_t max_posts) {
  const std::vector<BoundaryPost> posts = boundary_posts(inset, base, kAtRim_posts, max_posts);
  if (posts.empty()) return std::nullopt;
  EdgeMatching bend;
  bend.radius_m = radius_m;
  bend.posts = static_cast<std::int64_t>(posts.size());
  // What differs within a post of the base is the fade's business: bent, it would be a rim of bumps.
  gather(posts, std::max(4 * resolution_m(inset), resolution_m(base)) / radius_m, bend);
  double squares = 0;
  std::vector<double> sizes;
  for (const BoundaryPost& post : posts) {
    squares += post.off_m * post.off_m;
    sizes.push_back(std::abs(post.off_m));
  }
  bend.rms_m = std::sqrt(squares / static_cast<double>(posts.size()));
  for (const double off : bend.off_m) {
    if (std::abs(off) > std::abs(bend.largest_m)) bend.largest_m = off;
  }
  bend.reach_m = std::max(8 * resolution_m(base), 50 * share_of(std::move(sizes), 0.9));
  bend.cap = enclosing_cap(bend.boundary);
  bend.cap.radius_rad = std::min(kPi, bend.cap.radius_rad + bend.reach_m / radius_m);
  return bend;
}

Adjust matching_edges(const EdgeMatching& bend) {
  return [bend](std::span<const glm::dvec3> directions, std::span<double> heights_m) {
    const double near = std::cos(std::min(kPi, bend.cap.radius_rad + 1e-9));
    const double reach = bend.reach_m / bend.radius_m;
    const double cell2 = (bend.cell_m / bend.radius_m) * (bend.cell_m / bend.radius_m);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (bend.cap.radius_rad < kPi && glm::dot(directions[i], bend.cap.centre) < near) continue;
      double nearest = 5;
      double weights = 0;
      double sum = 0;
      for (std::size_t k = 0; k < bend.boundary.size(); ++k) {
        const glm::dvec3 away = directions[i] - bend.boundary[k];
        const double squared = glm::dot(away, away);
        nearest = std::min(nearest, squared);
        const double weight = 1 / ((squared + cell2) * (squared + cell2));
        weights += weight;
        sum += weight * bend.off_m[k];
      }
      const double distance = std::sqrt(nearest);
      if (distance < reach) heights_m[i] += sum / weights * smooth_step(1 - distance / reach);
    }
  };
}

std::string to_string(const EdgeMatching& bend, const std::string& inset) {
  // The rim's own values are a function of the sources, which are named; these digits tell bends apart.
  char text[160];
  std::snprintf(text, sizeof text, "bent by up to %.17g m (RMS %.17g m) over %.17g m to meet ", bend.largest_m,
                bend.rms_m, bend.reach_m);
  return text + inset;
}

}  // namespace mars
