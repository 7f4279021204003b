// Facets found once against surface_height() at every place.
#include "lod/tree/facet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

constexpr int kIntervals = 8;
constexpr double kRadius_m = mars::kMarsRadius_m;

class FacetTest : public testing::Test {
 protected:
  FacetTest() {
    posts_.key = {mars::Face::kPlusY, 6, 11, 40};
    posts_.intervals = kIntervals;
    for (int n = 0; n < posts_.side() * posts_.side(); ++n)
      posts_.height_m.push_back(random_.uniform(-4000, 9000));
    lines_ = lod::grid_lines(posts_.key, kIntervals);
  }

  double u() { return random_.uniform(lines_.u.front(), lines_.u.back()); }
  double v() { return random_.uniform(lines_.v.front(), lines_.v.back()); }

  test_support::Random random_{20261127};
  lod::Posts posts_;
  lod::GridLines lines_;
};

bool same_facet(const lod::Facet& a, const lod::Facet& b) {
  return a.u0 == b.u0 && a.v0 == b.v0 && a.lower == b.lower;
}

TEST_F(FacetTest, HasTheBitsOfSurfaceHeight) {
  for (int n = 0; n < 5000; ++n) {
    // Also beyond the tile, where places are clamped to it.
    const double wide = n % 10 == 0 ? 0.01 : 0;
    const double x = u() + random_.uniform(-wide, wide);
    const double y = v() + random_.uniform(-wide, wide);
    const double exaggeration = n % 3 == 0 ? 2.5 : 1.0;
    glm::dvec3 normal;
    const double height_m = lod::surface_height(posts_, lines_, x, y, kRadius_m, &normal, exaggeration);
    const lod::Facet facet = lod::facet_at(posts_, lines_, x, y, kRadius_m, exaggeration);
    ASSERT_EQ(facet.height_m(std::clamp(x, lines_.u.front(), lines_.u.back()),
                             std::clamp(y, lines_.v.front(), lines_.v.back()), kRadius_m),
              height_m);
    ASSERT_EQ(facet.normal(posts_.key.face), normal);
  }
}

TEST_F(FacetTest, ContainsThePlacesThatHaveIt) {
  int inside = 0;
  const lod::Facet facet = lod::facet_at(posts_, lines_, u(), v(), kRadius_m);
  for (int n = 0; n < 20000; ++n) {
    const double x = random_.uniform(2 * facet.u0 - facet.u1, 2 * facet.u1 - facet.u0);
    const double y = random_.uniform(2 * facet.v0 - facet.v1, 2 * facet.v1 - facet.v0);
    const bool contains = facet.contains(x, y);
    ASSERT_EQ(contains, same_facet(facet, lod::facet_at(posts_, lines_, x, y, kRadius_m))) << x << ' ' << y;
    inside += contains ? 1 : 0;
  }
  EXPECT_GT(inside, 500);
  EXPECT_TRUE(facet.contains(facet.u0, facet.v0) == facet.lower) << "the diagonal belongs to the lower facet";
  EXPECT_FALSE(facet.contains(facet.u1, (facet.v0 + facet.v1) / 2));
}

TEST_F(FacetTest, ContainsAroundMeansAllPlacesWithinTheMargin) {
  const double margin = (lines_.u[1] - lines_.u[0]) / 20;
  int sure = 0;
  for (int n = 0; n < 2000; ++n) {
    const double x = u();
    const double y = v();
    const lod::Facet facet = lod::facet_at(posts_, lines_, x, y, kRadius_m);
    if (!facet.contains_around(x, y, margin)) continue;
    ++sure;
    for (const double dx : {-margin, margin})
      for (const double dy : {-margin, margin}) ASSERT_TRUE(facet.contains(x + dx, y + dy));
  }
  EXPECT_GT(sure, 1000);
  EXPECT_LT(sure, 1900);
}

}  // namespace
