// Rays against meshes: closed forms, brute force, watertightness.
#include "objects/model/triangle_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "objects/model/distance_tree.h"
#include "objects/model/shapes.h"

namespace objects {
namespace {

const auto kAny = [](const TriangleHit&) { return true; };
constexpr float kFar = std::numeric_limits<float>::infinity();

TEST(TriangleTree, MeetsABoxWhereItsSidesAre) {
  const Mesh box = make_box({2, 4, 6});  // foot at z = 0
  const TriangleTree tree(box);
  const auto top = tree.nearest({{0.3F, 0.7F, 20}, {0, 0, -1}}, kFar, kAny);
  ASSERT_TRUE(top);
  EXPECT_FLOAT_EQ(top->t, 14);
  EXPECT_FALSE(top->is_back);
  const auto from_inside = tree.nearest({{0.3F, 0.7F, 3}, {0, 0, 2}}, kFar, kAny);
  ASSERT_TRUE(from_inside);
  EXPECT_FLOAT_EQ(from_inside->t, 1.5F);  // in lengths of the direction
  EXPECT_TRUE(from_inside->is_back);
  EXPECT_FALSE(tree.nearest({{5, 0, 3}, {0, 1, 0}}, kFar, kAny));
  EXPECT_FALSE(tree.nearest({{0.3F, 0.7F, 20}, {0, 0, -1}}, 13.9F, kAny));
}

TEST(TriangleTree, NoTriangleReachesIntoTheClearDistance) {
  EXPECT_EQ(TriangleTree().clear_distance_m({0, 0, 0}), std::numeric_limits<double>::infinity());
  for (const Mesh& mesh : {make_rock(5, 3), make_torus(0.7F, 0.25F, 48, 16)}) {
    const TriangleTree tree(mesh);
    const DistanceTree exact(mesh);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-2, 2);
    double lost = 0;
    for (int n = 0; n < 500; ++n) {
      const glm::dvec3 place_m(any(random), any(random), any(random));
      const double away_m = exact.nearest(place_m).distance_m;
      const double clear_m = tree.clear_distance_m(place_m);
      EXPECT_LE(clear_m, away_m);
      lost = std::max(lost, away_m - clear_m);
    }
    EXPECT_LT(lost, 0.25);  // boxes of a few triangles
    EXPECT_GT(tree.clear_distance_m({0, 0, 100}), 97);
  }
}

TEST(TriangleTree, WeightsGiveThePlace) {
  const Mesh rock = make_rock(5, 3);
  const TriangleTree tree(rock);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  int hits = 0;
  for (int n = 0; n < 2000; ++n) {
    const glm::vec3 from(any(random) * 3, any(random) * 3, any(random) * 3);
    const glm::vec3 near = glm::vec3(any(random), any(random), any(random)) * 0.4F;
    const ModelRay ray{from, near - from};
    const auto hit = tree.nearest(ray, kFar, kAny);
    if (!hit) continue;
    ++hits;
    const glm::uvec3 t = rock.triangles[hit->triangle];
    const glm::vec3 by_weights = rock.positions_m[t.x] * (1 - hit->u - hit->v) +
                                 rock.positions_m[t.y] * hit->u + rock.positions_m[t.z] * hit->v;
    EXPECT_LT(glm::distance(by_weights, ray.origin_m + hit->t * ray.direction),
              2e-6F * (1 + glm::length(ray.origin_m)));
  }
  EXPECT_GT(hits, 200);
}

// Returns the nearest hit by testing all triangles in double.
double brute_force(const Mesh& mesh, const glm::dvec3& o, const glm::dvec3& d) {
  double best = std::numeric_limits<double>::infinity();
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions_m[t.x]);
    const glm::dvec3 e1 = glm::dvec3(mesh.positions_m[t.y]) - a;
    const glm::dvec3 e2 = glm::dvec3(mesh.positions_m[t.z]) - a;
    const glm::dvec3 p = glm::cross(d, e2);
    const double det = glm::dot(e1, p);
    if (det == 0) continue;
    const double u = glm::dot(o - a, p) / det;
    const double v = glm::dot(d, glm::cross(o - a, e1)) / det;
    const double at = glm::dot(e2, glm::cross(o - a, e1)) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && at >= 0) best = std::min(best, at);
  }
  return best;
}

TEST(TriangleTree, AgreesWithBruteForce) {
  const Mesh torus = make_torus(2, 0.7F, 40, 20);
  const TriangleTree tree(torus);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  int hits = 0;
  for (int n = 0; n < 3000; ++n) {
    const glm::dvec3 o(any(random) * 4, any(random) * 4, any(random) * 4);
    const glm::dvec3 near(any(random) * 2.5, any(random) * 2.5, any(random));
    const glm::dvec3 d = glm::normalize(near - o);
    const auto hit = tree.nearest({glm::vec3(o), glm::vec3(d)}, kFar, kAny);
    const double truth = brute_force(torus, glm::dvec3(glm::vec3(o)), glm::dvec3(glm::vec3(d)));
    if (hit) ++hits;
    // At an edge-on triangle the two may differ about whether it is met.
    if (hit.has_value() != std::isfinite(truth)) {
      ADD_FAILURE() << "ray " << n << ": " << hit.has_value() << " against " << truth;
      continue;
    }
    if (hit) {
      EXPECT_NEAR(static_cast<double>(hit->t), truth, 1e-5 * (1 + truth)) << n;
    }
  }
  EXPECT_GT(hits, 600);
}

// A closed surface lets no ray out: aimed at its vertices and along its edges.
TEST(TriangleTree, NoRayLeavesAClosedSurfaceThroughAnEdge) {
  const Mesh ball = make_ellipsoid({1, 1, 1}, 24);
  const TriangleTree tree(ball);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-0.5F, 0.5F);
  std::uniform_int_distribution<std::size_t> which(0, ball.triangles.size() - 1);
  for (int n = 0; n < 20000; ++n) {
    const glm::vec3 from(any(random), any(random), any(random));
    const glm::uvec3 t = ball.triangles[which(random)];
    const float s = any(random) + 0.5F;
    const glm::vec3 on_edge = ball.positions_m[t.x] * (1 - s) + ball.positions_m[t.y] * s;
    EXPECT_TRUE(tree.nearest({from, on_edge - from}, kFar, kAny)) << n;
  }
}

TEST(TriangleTree, RefusedHitsAreSeenThrough) {
  const Mesh box = make_box({2, 2, 2});
  const TriangleTree tree(box);
  std::vector<float> seen;
  const auto behind = tree.nearest({{0.1F, 0.2F, 10}, {0, 0, -1}}, kFar, [&](const TriangleHit& hit) {
    seen.push_back(hit.t);
    return hit.is_back;
  });
  ASSERT_TRUE(behind);
  EXPECT_FLOAT_EQ(behind->t, 10);
  EXPECT_EQ(seen.size(), 2U);
}

TEST(TriangleTree, ManyEqualTrianglesMakeNoDeepTree) {
  Mesh mesh = make_box({1, 1, 1});
  const glm::uvec3 one = mesh.triangles[0];
  mesh.triangles.assign(100'000, one);
  mesh.materials.assign(100'000, 0);
  const TriangleTree tree(mesh);
  const glm::vec3 middle = (mesh.positions_m[one.x] + mesh.positions_m[one.y] + mesh.positions_m[one.z]) / 3.0F;
  const glm::vec3 from = middle * 5.0F + glm::vec3(0.01F, 0.02F, 0.03F);
  const auto hit = tree.nearest({from, middle - from}, kFar, kAny);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 0U);  // the lowest of equals
}

TEST(TriangleTree, FlatAndEmptyOnesAreHarmless) {
  EXPECT_FALSE(TriangleTree().nearest({{0, 0, 0}, {0, 0, 1}}, kFar, kAny));
  Mesh flat;
  flat.positions_m = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};  // no area
  flat.triangles = {{0, 1, 2}};
  flat.materials = {0};
  flat.material_table.resize(1);
  EXPECT_EQ(check(flat), "");
  EXPECT_FALSE(TriangleTree(flat).nearest({{0.5F, 0, 1}, {0, 0, -1}}, kFar, kAny));
}

}  // namespace
}  // namespace objects
