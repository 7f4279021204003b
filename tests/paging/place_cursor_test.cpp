// Cursors against answers at single places.
#include "paging/surface/place_cursor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "paging/surface/query.h"
#include "tests/paging/surface_fixture.h"

namespace {

class PlaceCursorTest : public test_support::SurfaceTest<test_support::bumpy_height> {};

// Steps of all sizes, so that places are on the same facet, in the same tile, and elsewhere.
glm::dvec3 step(test_support::Random& random, const glm::dvec3& from) {
  const double size = random.log_uniform(1e-6, 1);
  const glm::dvec3 by{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
  return glm::normalize(from + by);
}

TEST_F(PlaceCursorTest, EqualsTheSurfaceWhereverItComesFrom) {
  test_support::Random random(20261127);
  paging::PlaceCursor cursor(*surface_);
  glm::dvec3 d{1, 0, 0};
  for (int n = 0; n < 5000; ++n) {
    // Posts and edges of cubes and tiles among them.
    d = n % 50 == 0 ? glm::dvec3(1, n % 100 == 0 ? 1 : 0, 0.25) : step(random, d);
    const paging::SurfacePoint& point = cursor.move_to(d);
    const paging::SurfacePoint expected = surface_->at(d);
    ASSERT_EQ(point.height_m, expected.height_m) << n;
    ASSERT_EQ(point.radius_m, expected.radius_m);
    ASSERT_EQ(point.normal, expected.normal);
    ASSERT_EQ(point.tile, expected.tile);
    ASSERT_EQ(point.nodata, expected.nodata);
    ASSERT_EQ(cursor.source(), paging::source_at(*surface_, d));
  }
}

TEST_F(PlaceCursorTest, KnowsFacetsThatAnErrorCannotChange) {
  constexpr double kError_rad = 1e-4;
  test_support::Random random(7);
  paging::PlaceCursor cursor(*surface_);
  glm::dvec3 d{1, 0, 0};
  int sure = 0;
  for (int n = 0; n < 3000; ++n) {
    d = step(random, d);
    const paging::SurfacePoint* point = cursor.move_near(d, kError_rad);
    if (point == nullptr) continue;
    ++sure;
    ASSERT_EQ(point->height_m, surface_->at(d).height_m);
    for (int k = 0; k < 8; ++k) {
      const glm::dvec3 off{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      const paging::SurfacePoint other =
          surface_->at(glm::normalize(d + glm::normalize(off) * kError_rad * 0.99));
      ASSERT_EQ(point->normal, other.normal);
      ASSERT_EQ(point->tile, other.tile);
    }
  }
  EXPECT_GT(sure, 1000);
  EXPECT_LT(sure, 3000);
  // A post, an edge of the cube.
  EXPECT_EQ(cursor.move_near({1, 0, 0}, 1e-12), nullptr);
  EXPECT_EQ(cursor.move_near(glm::normalize(glm::dvec3(1, 1, 0.3)), 1e-12), nullptr);
}

}  // namespace
