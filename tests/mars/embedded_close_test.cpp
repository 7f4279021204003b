// The embedded Mars from nearby: rocks, sand, and differences between kinds of ground.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "mars/embedded/detail.h"
#include "mars/embedded/embedded.h"
#include "mars/embedded/surface.h"
#include "tests/mars/patch.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using test_support::Random;

std::vector<double> heights(const std::vector<glm::dvec3>& directions, double spacing_m) {
  std::vector<double> out(directions.size());
  embedded_elevation()->sample(directions, spacing_m, out);
  return out;
}

// Returns the share of the ground under rocks of `detail_m` and more if all stand out.
double rock_cover(double detail_m) {
  Random random(91);
  double covered = 0.0, posts = 0.0;
  for (int k = 0; k < 150; ++k) {
    const auto directions = patch(lon_lat(random.direction()), 16, 0.45);
    embedded::Block block;
    block.count = directions.size();
    for (std::size_t i = 0; i < block.count; ++i) {
      block.x[i] = directions[i].x;
      block.y[i] = directions[i].y;
      block.z[i] = directions[i].z;
    }
    block.finish();
    embedded::Lane<float> bare;
    bare.fill(1.2F);
    embedded::Rocks rocks;
    embedded::strew_rocks(block, detail_m, bare, bare, rocks);
    for (std::size_t i = 0; i < block.count; ++i) covered += rocks.height_m[i] > 0.0F;
    posts += static_cast<double>(block.count);
  }
  return covered / posts;
}

TEST(EmbeddedClose, RocksFollowThePublishedSizes) {
  // F(D) = k exp(-q D) at k = 0.35. Only the shape is compared: facets and burial remove a fixed share.
  const auto published = [](double d) { return 0.35 * std::exp(-2.22 * d); };
  const double all = rock_cover(0.25) / published(0.25);
  EXPECT_GT(all, 0.4);
  EXPECT_LT(all, 1.1);
  for (const double d : {0.0625, 0.5, 1.0}) {
    EXPECT_NEAR(rock_cover(d) / published(d), all, 0.3 * all) << d;
  }
}

TEST(EmbeddedClose, ContinuousAmongRocksAndRipples) {
  Random random(92);
  std::vector<glm::dvec3> a, b;
  for (const LonLat& p : {LonLat{-33.25, 19.1}, LonLat{-66.2333, -12.56}, LonLat{134.3, 47.7}, LonLat{178, 81},
                          LonLat{77.4, 18.5}, LonLat{-97, -7}, LonLat{-36, 14}}) {
    for (int i = 0; i < 400; ++i) {
      const glm::dvec3 away = random.direction();
      a.push_back(glm::normalize(direction(p) + away * random.log_uniform(1e-7, 1e-3)));
      b.push_back(glm::normalize(a.back() + random.direction() * (1e-3 / kMarsRadius_m)));
    }
  }
  const auto ha = heights(a, 0.0625), hb = heights(b, 0.0625);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const LonLat p = lon_lat(a[i]);
    EXPECT_NEAR(ha[i], hb[i], kEmbeddedStep_m) << p.lon_deg << "," << p.lat_deg;
  }
}

TEST(EmbeddedClose, GroundsDifferFromCameraLevel) {
  // Mean curvature between neighbouring posts a quarter of a metre apart, and its skewness: rocks stand out,
  // ripples have sharp crests, ice has neither.
  struct Texture {
    double bend_m, skew;
  };
  const auto texture_at = [](LonLat p) {
    const auto h = heights(patch(p, 160, 0.25), 0.25);
    double curvature = 0.0, square = 0.0, cube = 0.0, n = 0.0;
    for (std::size_t i = 1; i + 1 < h.size(); ++i) {
      if (i % 160 == 0 || i % 160 == 159) continue;
      const double c = 2.0 * h[i] - h[i - 1] - h[i + 1];
      curvature += std::abs(c);
      square += c * c;
      cube += c * c * c;
      n += 1.0;
    }
    return Texture{curvature / n, cube / n / std::pow(square / n, 1.5)};
  };
  const Texture rocky = texture_at({-64.5, -12.1});
  const Texture sandy = texture_at({-66.0, -11.95});
  const Texture ice = texture_at({20, 88});
  EXPECT_GT(rocky.bend_m, 0.005);
  EXPECT_GT(rocky.bend_m, 3.0 * ice.bend_m);
  EXPECT_GT(sandy.bend_m, 1.5 * ice.bend_m);
  EXPECT_GT(rocky.skew, 1.0);
  EXPECT_GT(sandy.skew, 0.3);
}

}  // namespace
}  // namespace mars
