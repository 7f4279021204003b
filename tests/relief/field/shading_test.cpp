// Normals of smooth patches against those of flat facets, where posts are magnified.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "relief/field/height_map.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

// Hills whose shortest wave is 8 posts long.
double hill_m(double x, double y) {
  return 3 * std::sin(0.31 * x + 0.2 * y) + 1.5 * std::cos(0.75 * y - 0.2 * x) + std::sin(0.5 * x - 0.4 * y);
}

glm::dvec3 normal(const glm::dvec2& slope) { return glm::normalize(glm::dvec3(-slope.x, -slope.y, 1)); }

// The slope of the flat triangle at a point; cells are divided from (i, j) to (i + 1, j + 1).
glm::dvec2 facet_slope(const HeightMap& map, double x, double y) {
  const double i = std::floor(x);
  const double j = std::floor(y);
  const double h00 = map.height_m(i, j);
  const double h10 = map.height_m(i + 1, j);
  const double h01 = map.height_m(i, j + 1);
  const double h11 = map.height_m(i + 1, j + 1);
  return x - i > y - j ? glm::dvec2(h10 - h00, h11 - h10) : glm::dvec2(h11 - h01, h01 - h00);
}

TEST(ReliefShading, BicubicNormalsAreFourTimesCloserThanFacets) {
  constexpr int kPosts = 60;
  std::vector<float> posts;
  for (int j = 0; j < kPosts; ++j)
    for (int i = 0; i < kPosts; ++i) posts.push_back(static_cast<float>(hill_m(i, j)));
  const HeightMap cubic({kPosts, kPosts, 0, 0, 1, 1}, posts, Interpolation::kBicubic);
  const HeightMap linear({kPosts, kPosts, 0, 0, 1, 1}, posts, Interpolation::kBilinear);
  samples::Random random(90);
  double cubic_square = 0;
  double linear_square = 0;
  double facet_square = 0;
  for (int n = 0; n < 20000; ++n) {
    const double x = random.in(1.0, kPosts - 2.0);
    const double y = random.in(1.0, kPosts - 2.0);
    const double h = 1e-5;
    const glm::dvec3 truth = normal(
        {(hill_m(x + h, y) - hill_m(x - h, y)) / (2 * h), (hill_m(x, y + h) - hill_m(x, y - h)) / (2 * h)});
    const auto square = [&](const glm::dvec2& slope) {
      const glm::dvec3 apart = normal(slope) - truth;
      return glm::dot(apart, apart);
    };
    cubic_square += square(cubic.gradient(x, y));
    linear_square += square(linear.gradient(x, y));
    facet_square += square(facet_slope(cubic, x, y));
  }
  EXPECT_LT(std::sqrt(cubic_square), 0.25 * std::sqrt(facet_square));
  EXPECT_LT(linear_square, facet_square);
  std::printf("[ MEASURED ] of facets': bicubic %.3f, bilinear %.3f\n", std::sqrt(cubic_square / facet_square),
              std::sqrt(linear_square / facet_square));
}

}  // namespace
}  // namespace relief
