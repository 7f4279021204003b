#include "tests/voxel/brute_force.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace test_support {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr int kBlock = 8;            // cells a side
constexpr double kRounding = 4e-15;  // of the edge tests, relative to their factors
constexpr int kSamples = 64;

// Returns true if the part t >= 0 of the ray may meet the ball.
bool meets(const glm::dvec3& camera, const glm::dvec3& direction, const glm::dvec3& centre, double radius_m) {
  const glm::dvec3 to = centre - camera;
  const double along = glm::dot(to, direction);
  const glm::dvec3 off = to - along * direction;
  const double wide = radius_m * (1.0 + 1e-9) + 1e-6;
  return glm::dot(off, off) <= wide * wide && along >= -wide;
}

}  // namespace

BruteForce::BruteForce(const paging::PlanetFile& planet) {
  for (const lod::TileInfo& tile : planet.tree().tiles()) {
    if (!tile.has_children) add_tile(planet.heights(tile.key), planet.radius_m());
  }
}

void BruteForce::add_tile(const paging::TileHeights& tile, double radius_m) {
  const lod::Posts& posts = tile.posts;
  const lod::GridLines lines = lod::grid_lines(posts.key, posts.intervals);
  std::vector<glm::dvec3> points;
  points.reserve(posts.height_m.size());
  for (int j = 0; j < posts.side(); ++j) {
    for (int i = 0; i < posts.side(); ++i) {
      const glm::dvec3 p = mars::cube_point(posts.key.face, lines.u[static_cast<std::size_t>(i)],
                                            lines.v[static_cast<std::size_t>(j)]);
      points.push_back(p * ((radius_m + posts.at(i, j)) / mars::cube_length(p)));
    }
  }
  const auto point = [&](int i, int j) {
    return points[static_cast<std::size_t>(j) * static_cast<std::size_t>(posts.side()) +
                  static_cast<std::size_t>(i)];
  };
  const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    Triangle t{a, b - a, c - a, 0};
    t.longest_m = std::max({glm::length(t.edge1), glm::length(t.edge2), glm::length(t.edge2 - t.edge1)});
    triangles_.push_back(t);
  };
  const auto ball_around = [&](int i0, int j0, int i1, int j1) {
    Ball ball;
    ball.centre = point((i0 + i1) / 2, (j0 + j1) / 2);
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i)
        ball.radius_m = std::max(ball.radius_m, glm::length(point(i, j) - ball.centre));
    }
    return ball;
  };
  Ball whole = ball_around(0, 0, posts.intervals, posts.intervals);
  whole.begin = blocks_.size();
  for (int j0 = 0; j0 < posts.intervals; j0 += kBlock) {
    for (int i0 = 0; i0 < posts.intervals; i0 += kBlock) {
      const int i1 = std::min(i0 + kBlock, posts.intervals);
      const int j1 = std::min(j0 + kBlock, posts.intervals);
      Ball block = ball_around(i0, j0, i1, j1);
      block.begin = triangles_.size();
      for (int j = j0; j < j1; ++j) {
        for (int i = i0; i < i1; ++i) {
          add(point(i, j), point(i + 1, j), point(i + 1, j + 1));
          add(point(i, j), point(i + 1, j + 1), point(i, j + 1));
        }
      }
      block.end = triangles_.size();
      blocks_.push_back(block);
    }
  }
  whole.end = blocks_.size();
  tiles_.push_back(whole);
}

template <typename Visit>
void BruteForce::each_crossing(const glm::dvec3& camera_m, const glm::dvec3& direction, Visit&& visit) const {
  for (const Ball& tile : tiles_) {
    if (!meets(camera_m, direction, tile.centre, tile.radius_m)) continue;
    for (std::size_t b = tile.begin; b < tile.end; ++b) {
      const Ball& block = blocks_[b];
      if (!meets(camera_m, direction, block.centre, block.radius_m)) continue;
      for (std::size_t n = block.begin; n < block.end; ++n) {
        const Triangle& triangle = triangles_[n];
        const glm::dvec3 p = glm::cross(direction, triangle.edge2);
        double area = glm::dot(triangle.edge1, p);
        if (area == 0.0) continue;  // edge-on: its neighbours are not
        const double sign = area < 0.0 ? -1.0 : 1.0;
        area *= sign;
        const glm::dvec3 from = camera_m - triangle.corner;
        const double slack = kRounding * (glm::length(from) + triangle.longest_m) * triangle.longest_m;
        const double u = sign * glm::dot(from, p);
        if (u < -slack || u > area + slack) continue;
        const glm::dvec3 q = glm::cross(from, triangle.edge1);
        const double v = sign * glm::dot(direction, q);
        if (v < -slack || u + v > area + slack) continue;
        const double t = sign * glm::dot(triangle.edge2, q) / area;
        if (t >= 0.0) visit(t);
      }
    }
  }
}

std::vector<double> BruteForce::crossings(const glm::dvec3& camera_m, const glm::dvec3& direction) const {
  std::vector<double> found;
  each_crossing(camera_m, direction, [&](double t) { found.push_back(t); });
  std::sort(found.begin(), found.end());
  return found;
}

double BruteForce::cast(const glm::dvec3& camera_m, const glm::dvec3& direction) const {
  double nearest = kNone;
  each_crossing(camera_m, direction, [&](double t) { nearest = std::min(nearest, t); });
  return nearest;
}

double BruteForce::radius_m(const glm::dvec3& direction) const {
  return cast(glm::dvec3(0), glm::normalize(direction));
}

double BruteForce::deepest_m(const glm::dvec3& camera_m, const glm::dvec3& direction, double from,
                             double to) const {
  const auto depth = [&](double t) {
    const glm::dvec3 at = camera_m + t * direction;
    return radius_m(at) - glm::length(at);
  };
  std::vector<double> cuts{from};
  for (const double t : crossings(camera_m, direction)) {
    if (t > from && t < to) cuts.push_back(t);
  }
  if (std::isfinite(to)) cuts.push_back(to);
  double deepest = depth(from);
  for (std::size_t n = 0; n + 1 < cuts.size(); ++n) {
    for (int s = 1; s <= kSamples; ++s)
      deepest = std::max(deepest, depth(cuts[n] + (cuts[n + 1] - cuts[n]) * s / kSamples));
  }
  return deepest;
}

Verdict judge(const BruteForce& truth, const glm::dvec3& camera_m, const glm::dvec3& direction,
              double claimed_m, const Tie& tie) {
  const double exact_m = truth.cast(camera_m, direction);
  if (claimed_m == exact_m) return Verdict::kSame;  // none, too
  if (std::isfinite(exact_m) && std::abs(claimed_m - exact_m) <= kSameRange * exact_m) return Verdict::kSame;
  if (claimed_m > exact_m) {
    const double sunk_m = truth.deepest_m(camera_m, direction, exact_m, claimed_m);
    return sunk_m < tie.share * exact_m + tie.metres ? Verdict::kTie : Verdict::kMissed;
  }
  // Also catches NaN.
  const double above_m = -truth.deepest_m(camera_m, direction, claimed_m, claimed_m);
  return above_m < tie.share * claimed_m + tie.metres ? Verdict::kTie : Verdict::kPhantom;
}

}  // namespace test_support
