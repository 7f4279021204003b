// Grazing rays at bilinear and bicubic maps against the trial of every cell.
#include <gtest/gtest.h>

#include <cmath>

#include "relief/cast/caster.h"
#include "tests/relief/cast/brute_force.h"
#include "tests/relief/cast/rays.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

struct Outcome {
  int rays = 0;
  int hits = 0;       // of the oracle
  int missed = 0;     // no hit, or one behind the oracle's
  int invented = 0;   // a hit in front of the oracle's that is not on the ground
  int undecided = 0;  // rays that go below the ground by less than rounding
};

// Rays that pass a point of the ground along a tangent, at heights from 1e-6 to 1 m above and below it.
Outcome graze(const HeightMap& map, const Surface& surface, int rays, unsigned seed) {
  samples::Random random(seed);
  Outcome found;
  const Rect area = map.support();
  for (found.rays = 0; found.rays < rays; ++found.rays) {
    const glm::dvec2 at{random.in(area.x0_m, area.x1_m), random.in(area.y0_m, area.y1_m)};
    const glm::dvec2 slope = map.gradient(at.x, at.y);
    const double heading = random.in(0.0, 6.28318);
    const glm::dvec2 level{std::cos(heading), std::sin(heading)};
    const glm::dvec3 d = glm::normalize(glm::dvec3(level, glm::dot(slope, level)));
    const double above = (random.in(0, 1) == 0 ? -1 : 1) * std::pow(10.0, random.in(-6.0, 0.0));
    const glm::dvec3 p{at, map.height_m(at.x, at.y) + above};
    glm::dvec3 from = p - d * random.in(0.0, 30.0);
    // From the edge of the map at least: beyond it there is no ground.
    if (!overlap(area, {from.x, from.y, from.x, from.y})) from = p;
    const int sign = surface.offset_m(from) > 0 ? 1 : -1;
    if (std::abs(surface.offset_m(from)) < 1e-7) continue;
    const double expected = brute::first_hit(map, from, d, 100, sign);
    const double hit = cast_ray(surface, from, d, 0, 100);
    const double slack = 1e-7;
    if (expected < kNoHit) ++found.hits;
    if (hit < expected - slack && std::abs(surface.offset_m(from + hit * d)) > 1e-9) ++found.invented;
    if (hit > expected + slack) {
      // How far the ray goes through the ground behind the oracle's hit.
      double depth = 0;
      for (double s = 0; s < 1; s += 1e-3)
        depth = std::max(depth, -sign * surface.offset_m(from + (expected + s) * d));
      ++(depth > 1e-9 ? found.missed : found.undecided);
    }
  }
  return found;
}

void expect_none_missed(Interpolation interpolation, int side, int rays, unsigned seed) {
  const auto map = samples::rough_map(side, side - 3, 0.6, interpolation, seed);
  const Surface surface =
      parallel_surface(Base::plane({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, map, map->support());
  const Outcome found = graze(*map, surface, rays, seed + 1);
  EXPECT_EQ(found.missed, 0);
  EXPECT_EQ(found.invented, 0);
  EXPECT_LE(found.undecided, rays / 1000);
  EXPECT_GT(found.hits, rays / 3);
}

TEST(ReliefGrazing, NoHitOfABilinearMapIsMissed) { expect_none_missed(Interpolation::kBilinear, 24, 5000, 41); }
TEST(ReliefGrazing, NoHitOfABicubicMapIsMissed) { expect_none_missed(Interpolation::kBicubic, 24, 5000, 42); }

// Curved bases, whose rays meet no polynomials: against samples 0.01 m apart, whose dips are longer than that.
TEST(ReliefGrazing, OnCurvedBasesNoSampleLiesBehindTheGround) {
  Quadratic f;
  f.matrix[0][0] = f.matrix[1][1] = -1.0 / 80;
  f.linear = {0, 0, 0.5};
  const Chart central = Chart::central({0, 0, -30}, {1, 0, 0}, {0, 1, 0}, 30, {-9, -8, 9, 8});
  const Chart parallel = Chart::parallel({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-9, -8, 9, 8});
  for (const Interpolation interpolation : {Interpolation::kBilinear, Interpolation::kBicubic}) {
    const auto map = samples::rough_map(24, 22, 0.6, interpolation, 46);
    samples::Random random(47);
    for (const Surface& surface :
         {Surface(Base::sphere({0, 0, -30}, 30), {{central, map}}),
          Surface(Base::sphere({0, 0, -30}, 30), {{parallel.cut({{0, 0, 1}, 30}), map}}),
          Surface(Base::ellipsoid({0, 0, -30}, {40, 25, 30}), {{central, map}}),
          Surface(Base::quadric(f, {0, 0, 0}), {{parallel, map}}),
          Surface(Base::quadric(f, {0, 0, 0}), {{central, map}})}) {
      int hits = 0;
      for (int n = 0; n < 200; ++n) {
        // A point of the ground under (x, y), and a tangent there.
        glm::dvec3 p{random.in(-6.0, 6.0), random.in(-6.0, 6.0), 20};
        p.z -= cast_ray(surface, p, {0, 0, -1});
        const glm::dvec3 normal = surface.normal(p);
        const glm::dvec3 d = glm::normalize(glm::cross(normal, random.direction()));
        const double above = (n % 2 == 0 ? -1 : 1) * std::pow(10.0, random.in(-3.0, 0.0));
        const glm::dvec3 from = p + above * normal - d * random.in(0.0, 8.0);
        if (!(std::abs(surface.offset_m(from)) > 1e-6)) continue;
        const double hit = cast_ray(surface, from, d, 0, 20);
        hits += hit < kNoHit ? 1 : 0;
        rays::expect_first(surface, from, d, hit, 20, 1e-8);
      }
      EXPECT_GT(hits, 50);
    }
  }
}

TEST(LongReliefGrazing, NoHitOfABilinearMapIsMissed) {
  expect_none_missed(Interpolation::kBilinear, 64, 100000, 43);
}
TEST(LongReliefGrazing, NoHitOfABicubicMapIsMissed) {
  expect_none_missed(Interpolation::kBicubic, 64, 100000, 44);
}

TEST(ReliefBruteForce, BernsteinFormsHaveTheValuesOfTheirPolynomials) {
  samples::Random random(45);
  for (int n = 0; n < 100; ++n) {
    brute::Terms values;
    for (brute::Real& value : values) value = random.in(-1.0, 1.0);
    const brute::Terms form = brute::to_bernstein(values);
    constexpr double kChoose[] = {1, 6, 15, 20, 15, 6, 1};
    for (std::size_t k = 0; k < brute::kTerms; ++k) {
      const double t = static_cast<double>(k) / 6;
      double value = 0;
      for (std::size_t m = 0; m < brute::kTerms; ++m)
        value += kChoose[m] * std::pow(t, static_cast<double>(m)) *
                 std::pow(1 - t, 6.0 - static_cast<double>(m)) * static_cast<double>(form[m]);
      EXPECT_NEAR(value, static_cast<double>(values[k]), 1e-12);
    }
  }
}

}  // namespace
}  // namespace relief
