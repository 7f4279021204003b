#include "lod/tree/posts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

using lod::Edge;
using lod::Posts;
using lod::TileKey;

// Oracle arithmetic: quadruple, as the differences of two posts a metre apart leave long double 13 digits.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Wide;
#else
typedef long double Wide;
#endif

Wide root(Wide x) {
  if (x == 0) return 0;
  const Wide guess = std::sqrt(static_cast<long double>(x));
  return (guess + x / guess) / 2;
}

struct Vec {
  Wide x, y, z;
};
Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Wide dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Wide length(const Vec& a) { return root(dot(a, a)); }

// Face coordinates are enough: the faces are congruent.
Vec point(Wide u, Wide v, Wide radius_m) {
  const Wide n = root(u * u + v * v + 1);
  return {u / n * radius_m, v / n * radius_m, radius_m / n};
}

// Radius where the ray (u, v, 1) from the centre meets the plane of a triangle, and its unit normal.
Wide plane_radius(double u, double v, const std::array<Vec, 3>& t, Vec* normal = nullptr) {
  const Vec n = cross(t[1] - t[0], t[2] - t[0]);
  const Vec ray = point(u, v, 1);
  if (normal != nullptr) {
    const Wide size = dot(n, ray) < 0 ? -length(n) : length(n);
    *normal = {n.x / size, n.y / size, n.z / size};
  }
  return dot(n, t[0]) / dot(n, ray);
}

Posts random_posts(test_support::Random& random, const TileKey& key, int intervals, double height_error_m) {
  Posts posts{key, intervals, {}};
  posts.height_m.resize(static_cast<std::size_t>(posts.side()) * static_cast<std::size_t>(posts.side()));
  for (double& h : posts.height_m) h = random.uniform(-height_error_m, height_error_m);
  return posts;
}

TileKey random_tile(test_support::Random& random, int max_level) {
  const int level = random.integer(0, max_level);
  const int last = (1 << level) - 1;
  return {static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, last),
          random.integer(0, last)};
}

TEST(Posts, GridLinesNestAndMeetTheTilesRectangle) {
  test_support::Random random(11);
  for (int trial = 0; trial < 300; ++trial) {
    const TileKey key = random_tile(random, lod::kMaxLevel - 1);
    const mars::ChartRect rect = lod::chart_rect(key);
    const lod::GridLines lines = lod::grid_lines(key, 16);
    ASSERT_EQ(lines.u.size(), 17U);
    EXPECT_EQ(lines.u.front(), rect.u0);
    EXPECT_EQ(lines.u.back(), rect.u1);
    EXPECT_EQ(lines.v.front(), rect.v0);
    EXPECT_EQ(lines.v.back(), rect.v1);
    EXPECT_TRUE(std::is_sorted(lines.u.begin(), lines.u.end()));
    const lod::GridLines below = lod::grid_lines(lod::child(key, 3), 16);
    for (std::size_t k = 0; k <= 8; ++k) {
      EXPECT_EQ(below.u[2 * k], lines.u[k + 8]);
      EXPECT_EQ(below.v[2 * k], lines.v[k + 8]);
    }
  }
}

TEST(Posts, SpacingIsThatOfTheMiddle) {
  const double radius = mars::kMarsRadius_m;
  EXPECT_NEAR(lod::post_spacing_m(4, 128, radius), lod::nominal_side_m(11, radius), 0.001 * 2605);
  EXPECT_DOUBLE_EQ(lod::post_spacing_m(0, 2, radius), radius * mars::kPi / 4.0);
  EXPECT_DOUBLE_EQ(lod::post_spacing_m(0, 1, radius), radius * mars::kPi / 2.0);
}

TEST(Posts, HeightAtAPostIsThePostsHeight) {
  test_support::Random random(12);
  for (int trial = 0; trial < 300; ++trial) {
    const double height_error = random.log_uniform(1.0, 1e6);
    const TileKey key = random_tile(random, 20);
    const Posts posts = random_posts(random, key, 16, height_error);
    const lod::GridLines lines = lod::grid_lines(key, 16);
    for (int j = 0; j <= 16; ++j) {
      for (int i = 0; i <= 16; ++i) {
        const double h = lod::surface_height(posts, lines, lines.u[static_cast<std::size_t>(i)],
                                             lines.v[static_cast<std::size_t>(j)], mars::kMarsRadius_m);
        ASSERT_NEAR(h, posts.at(i, j), 1e-9 + 1e-15 * height_error)
            << i << " " << j << " " << lod::to_string(key);
      }
    }
  }
}

TEST(Posts, HeightAndNormalAgreeWithRaysThroughTriangles) {
  test_support::Random random(13);
  double worst_height = 0;
  double worst_normal = 0;
  const double radius = mars::kMarsRadius_m;
  for (int trial = 0; trial < 1000; ++trial) {
    const TileKey key = random_tile(random, 20);
    const double height_error = random.log_uniform(1e-2, 1e5);
    const Posts posts = random_posts(random, key, 8, height_error);
    const lod::GridLines lines = lod::grid_lines(key, 8);
    for (int sample = 0; sample < 20; ++sample) {
      const int i = random.integer(0, 7);
      const int j = random.integer(0, 7);
      const auto at = [&](int a, int b) {
        return point(lines.u[static_cast<std::size_t>(a)], lines.v[static_cast<std::size_t>(b)],
                     static_cast<Wide>(radius) + static_cast<Wide>(posts.at(a, b)));
      };
      const double u0 = lines.u[static_cast<std::size_t>(i)];
      const double v0 = lines.v[static_cast<std::size_t>(j)];
      const double du = lines.u[static_cast<std::size_t>(i) + 1] - u0;
      const double dv = lines.v[static_cast<std::size_t>(j) + 1] - v0;
      const double fu = random.uniform(0.001, 0.998);
      double fv = random.uniform(0.001, 0.998);
      if (std::abs(fu - fv) < 1e-3) fv = fu + 1.5e-3;
      const double u = u0 + fu * du;
      const double v = v0 + fv * dv;
      const std::array<Vec, 3> triangle{at(i, j), fu > fv ? at(i + 1, j) : at(i, j + 1), at(i + 1, j + 1)};
      Vec expected{};
      const Wide truth = plane_radius(u, v, triangle, &expected) - static_cast<Wide>(radius);
      glm::dvec3 normal;
      const double h = lod::surface_height(posts, lines, u, v, radius, &normal);
      const double side = std::min(du, dv);
      const double height_bound = radius * std::max(du, dv) + height_error;
      worst_height = std::max(worst_height, std::abs(static_cast<double>(h - truth)) / height_bound);
      const mars::FaceAxes& axes = mars::face_axes(key.face);
      const Vec got{glm::dot(normal, axes.right), glm::dot(normal, axes.up), glm::dot(normal, axes.out)};
      const double angle = static_cast<double>(length(got - expected));
      worst_normal = std::max(worst_normal, angle / (1.0 + height_error / (radius * side)));
    }
  }
  EXPECT_LE(worst_height, lod::kHeightError);
  EXPECT_GE(worst_height, lod::kHeightError / 20);
  EXPECT_LE(worst_normal, lod::kNormalError);
  EXPECT_GE(worst_normal, lod::kNormalError / 20);
}

TEST(Posts, SmoothSphereHasRadialNormalsAndSagOfItsChords) {
  const double radius = 1e6;
  const TileKey key{mars::Face::kPlusZ, 5, 16, 16};
  Posts posts{key, 1, std::vector<double>(4, 0.0)};
  const lod::GridLines lines = lod::grid_lines(key, 1);
  glm::dvec3 normal;
  const double u = 0.5 * (lines.u[0] + lines.u[1]);
  const double v = 0.5 * (lines.v[0] + lines.v[1]);
  const double h = lod::surface_height(posts, lines, u, v, radius, &normal);
  // The middle lies on the diagonal: the middle of the chord between two opposite corners.
  const double half = 0.5 * mars::angle_between_rad(mars::chart_direction(key.face, lines.u[0], lines.v[0]),
                                                    mars::chart_direction(key.face, lines.u[1], lines.v[1]));
  EXPECT_NEAR(h, -2.0 * radius * std::pow(std::sin(half / 2), 2), 0.02 * std::abs(h));
  EXPECT_LT(mars::angle_between_rad(normal, mars::chart_direction(key.face, u, v)), 0.05);
  EXPECT_NEAR(glm::length(normal), 1.0, 1e-15);
}

TEST(Posts, PlacesOutsideAreClampedToTheTile) {
  test_support::Random random(14);
  const TileKey key{mars::Face::kPlusY, 3, 2, 5};
  const Posts posts = random_posts(random, key, 4, 100.0);
  const lod::GridLines lines = lod::grid_lines(key, 4);
  EXPECT_NEAR(lod::surface_height(posts, lines, -9, -9, 1e6), posts.at(0, 0), 1e-9);
  EXPECT_NEAR(lod::surface_height(posts, lines, 9, 9, 1e6), posts.at(4, 4), 1e-9);
  EXPECT_NEAR(lod::surface_height(posts, lines, 9, -9, 1e6), posts.at(4, 0), 1e-9);
}

TEST(Posts, ConstrainedEdgeLiesOnTheCoarseEdge) {
  test_support::Random random(15);
  const double radius = mars::kMarsRadius_m;
  constexpr int kIntervals = 16;
  for (int trial = 0; trial < 2000; ++trial) {
    const TileKey key = random_tile(random, 16);
    const double height_error = random.log_uniform(1.0, 2e4);
    Posts posts = random_posts(random, key, kIntervals, height_error);
    const Posts before = posts;
    const lod::GridLines lines = lod::grid_lines(key, kIntervals);
    const Edge edge = lod::kEdges[static_cast<std::size_t>(random.integer(0, 3))];
    const int step = 1 << random.integer(0, 4);
    lod::constrain_edge(posts, lines, edge, step, radius);
    const bool vertical = edge == Edge::kWest || edge == Edge::kEast;
    const int fixed = edge == Edge::kEast || edge == Edge::kNorth ? kIntervals : 0;
    const auto height = [&](const Posts& p, int k) { return vertical ? p.at(fixed, k) : p.at(k, fixed); };
    const auto chart = [&](int k) {
      return std::array<double, 2>{lines.u[static_cast<std::size_t>(vertical ? fixed : k)],
                                   lines.v[static_cast<std::size_t>(vertical ? k : fixed)]};
    };
    for (int k = 0; k <= kIntervals; ++k) {
      const int start = std::min(k / step * step, kIntervals - step);
      if (k % step == 0) {
        ASSERT_EQ(height(posts, k), height(before, k));
        continue;
      }
      // Distance of the moved post to the straight coarse edge in space.
      const auto [u, v] = chart(k);
      const auto at = [&](int post) {
        const auto [pu, pv] = chart(post);
        return point(pu, pv, static_cast<Wide>(radius) + static_cast<Wide>(height(posts, post)));
      };
      const Vec a = at(start);
      const Vec b = at(start + step);
      const Vec p = at(k);
      const double distance = static_cast<double>(length(cross(p - a, b - a)) / length(b - a));
      ASSERT_LE(distance, lod::kHeightError * (radius * (std::abs(chart(start + step)[0] - chart(start)[0]) +
                                                         std::abs(chart(start + step)[1] - chart(start)[1])) +
                                               height_error))
          << u << " " << v;
      ASSERT_LE(distance, 2e-9);
    }
    // Nothing else moved.
    int moved = 0;
    for (std::size_t n = 0; n < posts.height_m.size(); ++n)
      moved += posts.height_m[n] != before.height_m[n] ? 1 : 0;
    ASSERT_EQ(moved, kIntervals - kIntervals / step);
  }
}

TEST(Posts, SurfaceIsWatertightAcrossAChangeOfDepth) {
  // A coarse tile east of fine ones: along the shared line both give the same heights.
  test_support::Random random(16);
  const double radius = mars::kMarsRadius_m;
  constexpr int kIntervals = 8;
  for (int trial = 0; trial < 200; ++trial) {
    const int level = random.integer(0, 12);
    const int last = (1 << level) - 1;
    const TileKey coarse_key{static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, last),
                             random.integer(0, last)};
    const Edge edge = lod::kEdges[static_cast<std::size_t>(random.integer(0, 3))];
    const lod::Neighbour next = lod::neighbour(coarse_key, edge);
    const Posts coarse = random_posts(random, coarse_key, kIntervals, 5000.0);
    const lod::GridLines coarse_lines = lod::grid_lines(coarse_key, kIntervals);
    // The first of the two fine tiles along the neighbour's edge.
    const bool next_vertical = next.edge == Edge::kWest || next.edge == Edge::kEast;
    const int far = next.edge == Edge::kEast || next.edge == Edge::kNorth ? 1 : 0;
    const TileKey fine_key = lod::child(next.key, next_vertical ? far : 2 * far);
    Posts fine = random_posts(random, fine_key, kIntervals, 5000.0);
    const lod::GridLines fine_lines = lod::grid_lines(fine_key, kIntervals);
    const bool vertical = edge == Edge::kWest || edge == Edge::kEast;
    const int coarse_fixed = edge == Edge::kEast || edge == Edge::kNorth ? kIntervals : 0;
    // Every second fine post is a coarse one.
    for (int t = 0; t <= kIntervals; t += 2) {
      const int k = next.reversed ? kIntervals - t / 2 : t / 2;
      const double h = vertical ? coarse.at(coarse_fixed, k) : coarse.at(k, coarse_fixed);
      const int i = next_vertical ? far * kIntervals : t;
      const int j = next_vertical ? t : far * kIntervals;
      fine.height_m[static_cast<std::size_t>(j * fine.side() + i)] = h;
    }
    const double exaggeration = trial % 2 == 0 ? 1.0 : random.log_uniform(0.1, 100);
    lod::constrain_edge(fine, fine_lines, next.edge, 2, radius, exaggeration);
    for (int sample = 0; sample < 20; ++sample) {
      const double t = random.uniform(0.0, 1.0);
      const auto mix = [t](const std::vector<double>& l) { return l.front() + t * (l.back() - l.front()); };
      const double u =
          next_vertical ? (far == 1 ? fine_lines.u.back() : fine_lines.u.front()) : mix(fine_lines.u);
      const double v =
          next_vertical ? mix(fine_lines.v) : (far == 1 ? fine_lines.v.back() : fine_lines.v.front());
      const mars::ChartPoint other = mars::chart_on(coarse_key.face, mars::cube_point(fine_key.face, u, v));
      ASSERT_NEAR(lod::surface_height(fine, fine_lines, u, v, radius, nullptr, exaggeration),
                  lod::surface_height(coarse, coarse_lines, other.u, other.v, radius, nullptr, exaggeration),
                  2e-9 * std::max(1.0, exaggeration))
          << lod::to_string(coarse_key) << " " << lod::to_string(fine_key) << " times " << exaggeration;
    }
  }
}

// A facet through exaggerated posts is not the exaggerated facet: its sagitta is what it was.
TEST(SurfaceHeight, SagittaIsNotExaggerated) {
  constexpr double kR = 1e6;
  lod::Posts posts{{mars::Face::kPlusX, 3, 2, 5}, 4, std::vector<double>(25, 0.0)};
  const lod::GridLines lines = lod::grid_lines(posts.key, 4);
  const double u = 0.4 * lines.u[1] + 0.6 * lines.u[2];
  const double v = 0.7 * lines.v[2] + 0.3 * lines.v[3];
  const double sagitta = lod::surface_height(posts, lines, u, v, kR);
  EXPECT_LT(sagitta, -50.0);
  EXPECT_EQ(lod::surface_height(posts, lines, u, v, kR, nullptr, 5.0), sagitta);
  for (double& h : posts.height_m) h = 1000.0;
  lod::Posts high = posts;
  for (double& h : high.height_m) h = 3000.0;
  EXPECT_EQ(lod::surface_height(posts, lines, u, v, kR, nullptr, 3.0),
            lod::surface_height(high, lines, u, v, kR));
}

// Against the facets' normals as surface_height() gives them, at places all over the tile.
TEST(SteepestSlope, BoundsTheSlopesOfTheFacets) {
  test_support::Random random(23);
  for (const int level : {0, 3, 9, 16}) {
    const TileKey key{mars::Face::kMinusY, level, 0, 0};
    Posts posts{key, 16, {}};
    const double rough_m = 0.3 * lod::nominal_side_m(level, mars::kMarsRadius_m) / 16;
    for (int n = 0; n < 17 * 17; ++n) posts.height_m.push_back(random.uniform(0, rough_m));
    const lod::GridLines lines = lod::grid_lines(key, 16);
    const double bound = lod::steepest_slope(posts, lines, mars::kMarsRadius_m);
    double steepest = 0;
    for (int n = 0; n < 20000; ++n) {
      const double u = random.uniform(lines.u.front(), lines.u.back());
      const double v = random.uniform(lines.v.front(), lines.v.back());
      glm::dvec3 normal;
      lod::surface_height(posts, lines, u, v, mars::kMarsRadius_m, &normal);
      const double cosine = glm::dot(normal, mars::chart_direction(key.face, u, v));
      const double tangent = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / cosine;
      ASSERT_LE(tangent, bound * (1 + 1e-9)) << level;
      steepest = std::max(steepest, tangent);
    }
    EXPECT_GE(steepest, level == 0 ? 0.5 * bound : 0.9 * bound) << level;
  }
}

// One facet after the other, in plain code.
TEST(SteepestSlope, IsTheSameToTheBitOnAnyInstructionSet) {
  test_support::Random random(24);
  for (const int intervals : {1, 2, 16, 128, 256}) {
    const TileKey key{mars::Face::kPlusZ, 4, 5, 11};
    Posts posts{key, intervals, {}};
    const int side = intervals + 1;
    for (int n = 0; n < side * side; ++n) posts.height_m.push_back(random.uniform(-3000, 5000));
    const lod::GridLines lines = lod::grid_lines(key, intervals);
    const auto post = [&](int i, int j) {
      return mars::chart_direction(key.face, lines.u[static_cast<std::size_t>(i)],
                                   lines.v[static_cast<std::size_t>(j)]) *
             (mars::kMarsRadius_m + posts.at(i, j));
    };
    double tangent2 = 0;
    double longest2 = 0;
    const auto facet = [&](const glm::dvec3& shared, const glm::dvec3& b, const glm::dvec3& c) {
      const glm::dvec3 normal = glm::cross(b - shared, c - shared);
      const double up = glm::dot(normal, shared);
      tangent2 = std::max(tangent2, glm::dot(normal, normal) * glm::dot(shared, shared) / (up * up) - 1.0);
    };
    for (int j = 0; j < intervals; ++j) {
      for (int i = 0; i < intervals; ++i) {
        facet(post(i, j), post(i + 1, j), post(i + 1, j + 1));
        facet(post(i, j), post(i + 1, j + 1), post(i, j + 1));
        const glm::dvec3 diagonal = post(i + 1, j + 1) - post(i, j);
        const glm::dvec3 other = post(i, j + 1) - post(i + 1, j);
        longest2 = std::max({longest2, glm::dot(diagonal, diagonal), glm::dot(other, other)});
      }
    }
    const double lowest_m = *std::min_element(posts.height_m.begin(), posts.height_m.end());
    const double turn = std::sqrt(longest2) / (mars::kMarsRadius_m + lowest_m);
    const double tangent = std::sqrt(tangent2);
    ASSERT_LT(turn * tangent, 0.9);
    EXPECT_EQ(lod::steepest_slope(posts, lines, mars::kMarsRadius_m),
              (tangent + 1.1 * turn) / (1.0 - turn * tangent))
        << intervals;
  }
}

}  // namespace
