// Hits of rays against closed forms, on every base and with every kind of shape.
#include "relief/cast/caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "relief/field/stack.h"
#include "tests/relief/cast/rays.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

// height sin(x / length) sin(y / length): a shape the caster knows by its bounds alone.
class Wave : public Shape {
 public:
  Wave(double size_m, double length_m) : size_m_(size_m), length_m_(length_m) {}

  Rect support() const override { return kEverywhere; }
  double height_m(double x_m, double y_m) const override {
    return size_m_ * std::sin(x_m / length_m_) * std::sin(y_m / length_m_);
  }
  glm::dvec2 gradient(double x_m, double y_m) const override {
    const double x = x_m / length_m_;
    const double y = y_m / length_m_;
    return size_m_ / length_m_ * glm::dvec2(std::cos(x) * std::sin(y), std::sin(x) * std::cos(y));
  }
  Interval bounds_m(const Rect& rect) const override {
    const double across = (rect.x1_m - rect.x0_m + rect.y1_m - rect.y0_m) / 2;
    const double reach = std::min(2.0, across / length_m_);
    const double mid = height_m(0.5 * (rect.x0_m + rect.x1_m), 0.5 * (rect.y0_m + rect.y1_m));
    if (!(across < 10 * length_m_)) return {-size_m_, size_m_};
    return {std::max(-size_m_, mid - size_m_ * reach), std::min(size_m_, mid + size_m_ * reach)};
  }

 private:
  double size_m_;
  double length_m_;
};

std::shared_ptr<const HeightMap> constant_map(float height_m, double half_m, int posts,
                                              Interpolation interpolation) {
  const double spacing_m = 2 * half_m / (posts - 1);
  return std::make_shared<HeightMap>(
      MapLayout{posts, posts, -half_m, -half_m, spacing_m, spacing_m},
      std::vector<float>(static_cast<std::size_t>(posts) * static_cast<std::size_t>(posts), height_m),
      interpolation);
}

Surface flat(std::shared_ptr<const Shape> shape, const Rect& domain = kEverywhere) {
  return parallel_surface(Base::plane({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, std::move(shape),
                          domain);
}

// The first root of |o + s d|^2 = r^2 from s = 0.
double sphere_hit(const glm::dvec3& o, const glm::dvec3& d, double radius) {
  const double b = glm::dot(o, d);
  const double discriminant = b * b - glm::dot(o, o) + radius * radius;
  if (discriminant < 0) return kNoHit;
  const double root = std::sqrt(discriminant);
  if (-b - root >= 0) return -b - root;
  return -b + root >= 0 ? -b + root : kNoHit;
}

void expect_hit(double found, double expected, double slack) {
  if (expected == kNoHit) {
    EXPECT_EQ(found, kNoHit);
  } else {
    EXPECT_NEAR(found, expected, slack);
  }
}

TEST(ReliefCaster, ARampIsHitWhereItsPlaneIs) {
  for (const Interpolation interpolation : {Interpolation::kBilinear, Interpolation::kBicubic}) {
    std::vector<float> posts;
    for (int j = 0; j < 50; ++j)
      for (int i = 0; i < 60; ++i) posts.push_back(static_cast<float>(0.5 * i - 0.25 * j));
    const auto map = std::make_shared<HeightMap>(MapLayout{60, 50, 0, 0, 1, 1}, posts, interpolation);
    const Surface ramp = flat(map, map->support());
    samples::Random random(60);
    for (int n = 0; n < 2000; ++n) {
      const glm::dvec3 from{random.in(-20.0, 80.0), random.in(-20.0, 70.0), random.in(-20.0, 60.0)};
      const glm::dvec3 d = random.direction();
      const double s = -(from.z - 0.5 * from.x + 0.25 * from.y) / (d.z - 0.5 * d.x + 0.25 * d.y);
      const glm::dvec3 p = from + s * d;
      const double margin = std::min(std::min(p.x, 59 - p.x), std::min(p.y, 49 - p.y));
      if (std::abs(margin) < 1e-9 || std::abs(s) > 1e4) continue;
      expect_hit(cast_ray(ramp, from, d), s >= 0 && margin > 0 ? s : kNoHit, 1e-9 * (1 + s));
    }
  }
}

TEST(ReliefCaster, BareBasesAreHitWhereTheyAre) {
  const Base ball = Base::sphere({0, 0, 0}, 5);
  const glm::dvec3 axes{6, 4, 3};
  const Base egg = Base::ellipsoid({0, 0, 0}, axes);
  Quadratic f;  // z - (x^2 + y^2) / 8
  f.matrix[0][0] = f.matrix[1][1] = -1.0 / 8;
  f.linear = {0, 0, 0.5};
  const Surface bowl = parallel_surface(Base::quadric(f, {0, 0, 0}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, nullptr);
  const Surface sphere = cube_surface(ball, 5, {});
  const Surface ellipsoid = cube_surface(egg, 5, {});
  const Surface halves = parallel_surface(egg, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, nullptr);
  samples::Random random(61);
  for (int n = 0; n < 3000; ++n) {
    const glm::dvec3 from = random.in_box(12);
    const glm::dvec3 d = random.direction();
    expect_hit(cast_ray(sphere, from, d), sphere_hit(from, d, 5), 1e-7);
    const double stretched =
        sphere_hit(from / axes / glm::length(d / axes), glm::normalize(d / axes), 1 / glm::length(d / axes));
    expect_hit(cast_ray(ellipsoid, from, d), stretched, 1e-7);
    expect_hit(cast_ray(halves, from, d), stretched, 1e-7);
    const double a = (d.x * d.x + d.y * d.y) / 8;
    const double b = (from.x * d.x + from.y * d.y) / 4 - d.z;
    const double c = (from.x * from.x + from.y * from.y) / 8 - from.z;
    double expected = kNoHit;
    if (b * b >= 4 * a * c) {
      const double root = std::sqrt(b * b - 4 * a * c);
      for (const double s : {(-b - root) / (2 * a), (-b + root) / (2 * a)})
        if (s >= 0) expected = std::min(expected, s);
    }
    if (expected < kNoHit && expected > 1e6) continue;  // nearly parallel to the axis
    expect_hit(cast_ray(bowl, from, d), expected, 1e-7 * (1 + std::min(expected, 1e6)));
  }
}

TEST(ReliefCaster, AConstantShapeMakesALargerSphere) {
  for (const Interpolation interpolation : {Interpolation::kBilinear, Interpolation::kBicubic}) {
    std::array<std::shared_ptr<const Shape>, mars::kFaces> shapes;
    shapes.fill(constant_map(0.75F, 5, 20, interpolation));
    const Surface body = cube_surface(Base::sphere({0, 0, 0}, 5), 5, shapes);
    samples::Random random(62);
    for (int n = 0; n < 2000; ++n) {
      const glm::dvec3 from = random.in_box(12);
      const glm::dvec3 d = random.direction();
      expect_hit(cast_ray(body, from, d), sphere_hit(from, d, 5.75), 1e-7);
    }
  }
}

TEST(ReliefCaster, ADatumOfMarsIsHitWithinAMicrometre) {
  const double radius = 3396190;
  std::array<std::shared_ptr<const Shape>, mars::kFaces> shapes;
  shapes.fill(constant_map(1234.5F, radius, 100, Interpolation::kBicubic));
  const Surface body = cube_surface(Base::sphere({0, 0, 0}, radius), radius, shapes);
  samples::Random random(63);
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 up = random.direction();
    const double height = std::pow(10.0, random.in(0.5, 6.0));
    const glm::dvec3 from = up * (radius + 1234.5 + height);
    const glm::dvec3 d = glm::normalize(random.direction() - 1.5 * up);
    expect_hit(cast_ray(body, from, d), sphere_hit(from, d, radius + 1234.5), 1e-6);
  }
}

TEST(ReliefCaster, EveryShapeOnEveryBaseIsHitFirstWhereItIsMet) {
  const auto bicubic = samples::rough_map(40, 40, 0.4, Interpolation::kBicubic, 64, 0.25, 0.25);
  const auto bilinear = samples::rough_map(40, 40, 0.4, Interpolation::kBilinear, 65, 0.25, 0.25);
  const auto wave = std::make_shared<Wave>(0.5, 1.5);
  const auto stack = std::make_shared<Stack>(
      std::vector<StackLayer>{{wave, Compose::kSum, nullptr}, {bicubic, Compose::kSum, nullptr}});
  Quadratic f;
  f.matrix[0][0] = f.matrix[1][1] = -1.0 / 40;
  f.linear = {0, 0, 0.5};
  const std::vector<std::shared_ptr<const Shape>> shapes{bicubic, bilinear, wave, stack};
  std::vector<Surface> surfaces;
  for (const auto& shape : shapes) {
    surfaces.push_back(flat(shape, {-4, -4, 4, 4}));
    surfaces.push_back(
        parallel_surface(Base::quadric(f, {0, 0, 0}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, shape, {-4, -4, 4, 4}));
    surfaces.push_back(Surface(Base::sphere({0, 0, -8}, 8),
                               {{Chart::central({0, 0, -8}, {1, 0, 0}, {0, 1, 0}, 8, {-4, -4, 4, 4}), shape}}));
    surfaces.push_back(Surface(Base::ellipsoid({0, 0, -8}, {9, 7, 8}),
                               {{Chart::central({0, 0, -8}, {1, 0, 0}, {0, 1, 0}, 8, {-4, -4, 4, 4}), shape}}));
    surfaces.push_back(Surface(
        Base::sphere({0, 0, -8}, 8),
        {{Chart::parallel({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-4, -4, 4, 4}).cut({{0, 0, 1}, 8}), shape}}));
  }
  samples::Random random(66);
  int hits = 0;
  for (const Surface& surface : surfaces) {
    for (int n = 0; n < 150; ++n) {
      const glm::dvec3 at{random.in(-3.5, 3.5), random.in(-3.5, 3.5), random.in(-0.5, 0.5)};
      const glm::dvec3 from = at + glm::dvec3(0, 0, 3) + random.in_box(3);
      const glm::dvec3 d = glm::normalize(at - from);
      const double hit = cast_ray(surface, from, d, 0, 30);
      hits += hit < kNoHit ? 1 : 0;
      rays::expect_first(surface, from, d, hit, 30, 1e-8);
    }
  }
  EXPECT_GT(hits, 100 * static_cast<int>(surfaces.size()));
}

TEST(ReliefCaster, LimitsAreRangesAlongTheRay) {
  const Surface ground = flat(constant_map(1, 50, 11, Interpolation::kBilinear));
  const glm::dvec3 from{0, 0, 11};
  const glm::dvec3 down{0, 0, -1};
  EXPECT_NEAR(cast_ray(ground, from, down), 10, 1e-12);
  EXPECT_NEAR(cast_ray(ground, from, down, 9.999, 10.001), 10, 1e-12);
  EXPECT_EQ(cast_ray(ground, from, down, 0, 9.99), kNoHit);
  EXPECT_EQ(cast_ray(ground, from, down, 10.01, 100), kNoHit);
}

TEST(ReliefCaster, ACameraInTheGroundSeesItFromBelow) {
  const auto map = samples::rough_map(30, 30, 0.5, Interpolation::kBicubic, 67);
  const Surface ground = flat(map, map->support());
  samples::Random random(68);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 from{random.in(-4.0, 4.0), random.in(-4.0, 4.0), random.in(-6.0, -4.0)};
    const glm::dvec3 d = glm::normalize(glm::dvec3(random.in(-1.0, 1.0), random.in(-1.0, 1.0), 1));
    const double hit = cast_ray(ground, from, d);
    ASSERT_LT(hit, 30);
    rays::expect_first(ground, from, d, hit, 30, 1e-9);
  }
  const Surface ball = cube_surface(Base::sphere({0, 0, 0}, 5), 5, {});
  EXPECT_NEAR(cast_ray(ball, {0, 0, 0}, {0, 0.6, 0.8}), 5, 1e-12);
  EXPECT_NEAR(cast_ray(ball, {1, 2, 0}, {1, 0, 0}), std::sqrt(21) - 1, 1e-12);
}

TEST(ReliefCaster, AShapeThatEndsAboveItsBaseEndsInAWall) {
  const Surface table = flat(constant_map(2, 10, 5, Interpolation::kBilinear));
  EXPECT_NEAR(cast_ray(table, {-30, 0, 1}, {1, 0, 0}), 20, 1e-9);
  EXPECT_NEAR(cast_ray(table, {0, 0, 1}, {1, 0, 0}), 10, 1e-9);
  EXPECT_EQ(cast_ray(table, {-30, 0, 2.5}, {1, 0, 0}), kNoHit);
  EXPECT_NEAR(cast_ray(table, {-30, 0, 1}, glm::normalize(glm::dvec3(1, 0, -0.1))), std::hypot(10, 1), 1e-9);
}

TEST(ReliefCaster, RaysThatMissAndRaysAlongTheAxes) {
  const auto map = samples::rough_map(16, 16, 0.5, Interpolation::kBicubic, 69);
  const Surface ground = flat(map, map->support());
  EXPECT_EQ(cast_ray(ground, {0, 0, 10}, {0, 0, 1}), kNoHit);
  EXPECT_EQ(cast_ray(ground, {0, 0, 10}, {1, 0, 0}), kNoHit);
  EXPECT_EQ(cast_ray(ground, {50, 0, 10}, {0, 0, -1}), kNoHit);
  for (int n = -7; n <= 7; ++n) {
    // Down through posts and through the borders of cells.
    EXPECT_NEAR(cast_ray(ground, {n + 0.5, 0.5, 10}, {0, 0, -1}), 10 - map->height_m(n + 0.5, 0.5), 1e-9);
    EXPECT_NEAR(cast_ray(ground, {n + 0.5, 0.25, 10}, {0, 0, -1}), 10 - map->height_m(n + 0.5, 0.25), 1e-9);
    EXPECT_NEAR(cast_ray(ground, {0.3, n + 0.4, 10}, {0, 0, -1}), 10 - map->height_m(0.3, n + 0.4), 1e-9);
  }
}

TEST(ReliefCaster, BadRaysAreRefused) {
  const Surface ground = flat(nullptr);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(cast_ray(ground, {0, 0, 1}, {0, 0, -2}), std::invalid_argument);
  EXPECT_THROW(cast_ray(ground, {0, 0, nan}, {0, 0, -1}), std::invalid_argument);
  EXPECT_THROW(cast_ray(ground, {0, 0, 1}, {0, 0, -1}, 5, 5), std::invalid_argument);
  EXPECT_THROW(cast_ray(ground, {0, 0, 1}, {0, 0, -1}, -1, 5), std::invalid_argument);
  EXPECT_THROW(cast_ray(ground, {0, 0, 1}, {0, 0, -1}, 0, 1e16), std::invalid_argument);
  EXPECT_THROW(cast_ray(ground, {0, 0, 1}, {0, 0, -1}, nan, 5), std::invalid_argument);
}

}  // namespace
}  // namespace relief
