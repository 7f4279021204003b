// Stated errors of meshes over ground so high, and cells so wide, that what is measured at vertices alone is
// too small.
#include <gtest/gtest.h>

#include <cmath>

#include "lod/mesh/error_meter.h"
#include "lod/tree/posts.h"
#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"
#include "tests/support/worst.h"

namespace {

constexpr double kRadius_m = mars::kMarsRadius_m;

// Two triangles over a tile, which are the posts of a single cell.
lod::TileMesh two_triangles(int intervals) {
  const auto n = static_cast<std::uint16_t>(intervals);
  lod::TileMesh mesh;
  mesh.intervals = intervals;
  mesh.vertices = {{0, 0}, {n, 0}, {n, n}, {0, n}};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  return mesh;
}

TEST(GeometryErrors, HoldBetweenTheVerticesWhereTheyAreMeasured) {
  test_support::Random random(351);
  double worst = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int level = random.integer(0, 3);
    const int last = (1 << level) - 1;
    const lod::TileKey key{static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, last),
                           random.integer(0, last)};
    const double height_error_m = kRadius_m * random.log_uniform(1e-3, 0.6);
    lod::Posts fine{key, 2, {}};
    for (int k = 0; k < 9; ++k) fine.height_m.push_back(random.uniform(-height_error_m, height_error_m));
    const lod::Posts coarse{key, 1, {fine.at(0, 0), fine.at(2, 0), fine.at(0, 2), fine.at(2, 2)}};
    const std::vector<double> corners{fine.at(0, 0), fine.at(2, 0), fine.at(2, 2), fine.at(0, 2)};
    const lod::ErrorTerms terms = lod::measure_error(key, two_triangles(2), corners, fine, kRadius_m);
    const lod::GridLines fine_lines = lod::grid_lines(key, 2);
    const lod::GridLines coarse_lines = lod::grid_lines(key, 1);
    for (int n = 0; n < 1500; ++n) {
      const double u = random.uniform(fine_lines.u.front(), fine_lines.u.back());
      const double v = random.uniform(fine_lines.v.front(), fine_lines.v.back());
      const double off_m = std::abs(lod::surface_height(fine, fine_lines, u, v, kRadius_m) -
                                    lod::surface_height(coarse, coarse_lines, u, v, kRadius_m));
      worst = std::max(worst, off_m / terms.total_m);
    }
  }
  test_support::record_worst("errors of meshes, heights to 0.6 radii: measured anywhere", worst, 1,
                             "of the stated error");
}

}  // namespace
