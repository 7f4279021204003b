// Heights within a bound against the surface.
#include "paging/surface/height_cursor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/paging/surface_fixture.h"

namespace {

class HeightCursorTest : public test_support::SurfaceTest<test_support::bumpy_height> {};

glm::dvec3 any_direction(test_support::Random& random) {
  glm::dvec3 d{0, 0, 0};
  while (glm::length(d) < 0.1) d = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  return d;
}

TEST_F(HeightCursorTest, AreWithinWhatIsAskedFor) {
  test_support::Random random(20261128);
  paging::HeightCursor cursor(*surface_);
  double worst_share = 0;
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 d = n % 3 == 0 ? glm::dvec3(1, random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1))
                                    : any_direction(random);
    const double most_m = random.log_uniform(0.1, 1e4);
    const double off_m = std::abs(cursor.height_m(d, most_m) - surface_->at(d).height_m);
    ASSERT_LE(off_m, most_m * (1 + 1e-9) + 1e-6) << n;
    worst_share = std::max(worst_share, off_m / most_m);
  }
  EXPECT_GT(worst_share, 0.1) << "heights are exact: nothing was tested";
}

TEST_F(HeightCursorTest, AreThoseOfTheSurfaceWhereNoErrorIsAllowed) {
  test_support::Random random(3);
  paging::HeightCursor cursor(*surface_);
  for (int n = 0; n < 3000; ++n) {
    const glm::dvec3 d = any_direction(random);
    if (n % 2 == 0) cursor.height_m(any_direction(random), 500);
    ASSERT_EQ(cursor.height_m(d, n % 3 == 0 ? -1.0 : 0.0), surface_->at(d).height_m);
  }
}

// Whatever came before, also in the same tile and on the same facet.
TEST_F(HeightCursorTest, DoNotDependOnThoseBefore) {
  test_support::Random random(4);
  paging::HeightCursor cursor(*surface_);
  glm::dvec3 d{1, 0, 0};
  for (int n = 0; n < 3000; ++n) {
    d = glm::normalize(d + random.log_uniform(1e-5, 0.3) * glm::normalize(any_direction(random)));
    const double most_m = random.log_uniform(1, 5000);
    ASSERT_EQ(cursor.height_m(d, most_m), paging::HeightCursor(*surface_).height_m(d, most_m)) << n;
  }
}

TEST_F(HeightCursorTest, ReadFewerTilesFromFar) {
  const paging::Surface near(planet_, 64 << 20);
  const paging::Surface far(planet_, 64 << 20);
  paging::HeightCursor exact(near);
  paging::HeightCursor rough(far);
  test_support::Random random(5);
  for (int n = 0; n < 2000; ++n) {
    const glm::dvec3 d = any_direction(random);
    exact.height_m(d, 0);
    rough.height_m(d, 2000);
  }
  EXPECT_LT(2 * far.bytes_resident(), near.bytes_resident());
}

}  // namespace
