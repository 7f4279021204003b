// Surfaces: which piece holds a point, heights over the ground, normals.
#include "relief/field/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/relief/samples.h"

namespace relief {
namespace {

TEST(ReliefSurface, ReliefRisesFromItsBase) {
  const auto map = samples::rough_map(9, 9, 3, Interpolation::kBicubic, 30);
  const Surface ground =
      parallel_surface(Base::plane({0, 0, 5}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, map);
  EXPECT_NEAR(ground.offset_m({1.3, 0.4, 9}), 4 - map->height_m(1.3, 0.4), 1e-14);
  EXPECT_NEAR(ground.offset_m({50, 0, 9}), 4, 1e-14);
  EXPECT_EQ(ground.normal({50, 0, 5}), glm::dvec3(0, 0, 1));
  const glm::dvec2 rise = map->gradient(1.3, 0.4);
  const glm::dvec3 normal = ground.normal({1.3, 0.4, 5 + map->height_m(1.3, 0.4)});
  EXPECT_LT(glm::length(normal - glm::normalize(glm::dvec3(-rise.x, -rise.y, 1))), 1e-14);
}

TEST(ReliefSurface, OnASphereAParallelShapeActsOnItsOwnHalf) {
  const auto map = samples::rough_map(5, 5, 1, Interpolation::kBilinear, 31);
  const Surface ball = parallel_surface(Base::sphere({1, 1, 1}, 100), {1, 1, 1}, {1, 0, 0}, {0, 1, 0}, map);
  EXPECT_NEAR(ball.offset_m({1.5, 1.5, 104}), std::sqrt(103 * 103 + 0.5) - 100 - map->height_m(0.5, 0.5),
              1e-12);
  EXPECT_NEAR(ball.offset_m({1.5, 1.5, -102}), std::sqrt(103 * 103 + 0.5) - 100, 1e-12);
}

TEST(ReliefSurface, FacesCarryTheirOwnShapes) {
  const auto map = samples::rough_map(5, 5, 1, Interpolation::kBilinear, 32);
  std::array<std::shared_ptr<const Shape>, mars::kFaces> shapes;
  shapes[static_cast<std::size_t>(mars::Face::kPlusZ)] = map;
  const Surface body = cube_surface(Base::ellipsoid({0, 0, 0}, {10, 9, 8}), 10, shapes);
  EXPECT_NEAR(body.offset_m({0, 0, 11}), 3 - map->height_m(0, 0), 1e-14);
  EXPECT_NEAR(body.offset_m({0, 0, -11}), 3, 1e-14);
  EXPECT_THROW(cube_surface(Base::plane({0, 0, 0}, {0, 0, 1}), 10, shapes), std::invalid_argument);
}

TEST(ReliefSurface, NormalsAreThoseOfDifferences) {
  const auto map = samples::rough_map(30, 30, 0.3, Interpolation::kBicubic, 33, 0.7, 0.7);
  std::array<std::shared_ptr<const Shape>, mars::kFaces> shapes;
  shapes.fill(map);
  const Surface body = cube_surface(Base::ellipsoid({0, 0, 0}, {10, 9, 8}), 10, shapes);
  samples::Random random(34);
  const double h = 1e-6;
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 p = random.direction() * random.in(7.0, 11.0);
    const mars::ChartPoint at = mars::chart_point(p);
    if (std::max(std::abs(at.u), std::abs(at.v)) > 0.99) continue;  // no differences across faces
    const auto slope = [&](const glm::dvec3& step) {
      return (body.offset_m(p + step) - body.offset_m(p - step)) / (2 * h);
    };
    const glm::dvec3 expected =
        glm::normalize(glm::dvec3(slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})));
    EXPECT_LT(glm::length(body.normal(p) - expected), 1e-5);
  }
}

TEST(ReliefSurface, BeyondAllDomainsThereIsNoGround) {
  const Surface ground = parallel_surface(Base::plane({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                          nullptr, {0, 0, 1, 1});
  EXPECT_EQ(ground.offset_m({0.5, 0.5, 2}), 2);
  EXPECT_TRUE(std::isnan(ground.offset_m({2, 0.5, 2})));
  EXPECT_EQ(ground.normal({2, 0.5, 2}), glm::dvec3(0, 0, 0));
  EXPECT_THROW(Surface(Base::plane({0, 0, 0}, {0, 0, 1}), {}), std::invalid_argument);
  EXPECT_THROW(Surface(ground.base(), std::vector<Piece>(kMaxPieces + 1, ground.pieces()[0])),
               std::invalid_argument);
}

}  // namespace
}  // namespace relief
