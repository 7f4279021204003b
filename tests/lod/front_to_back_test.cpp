// Along every half circle from the point under the camera, nearer tiles come first.
#include "lod/front_to_back.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

using test_support::Random;

// A random cut through the quadtree of all faces.
void split(Random& random, const lod::TileKey& key, const glm::dvec3& focus, std::vector<lod::TileKey>& tiles) {
  const mars::Cap cap = lod::bounding_cap(key);
  const bool near = mars::angle_between_rad(cap.centre, focus) < 1.5 * cap.radius_rad;
  if (key.level < 9 && (near ? random.integer(0, 9) > 0 : key.level < 4 && random.integer(0, 1) > 0)) {
    for (int c = 0; c < 4; ++c) split(random, lod::child(key, c), focus, tiles);
  } else if (random.integer(0, 5) > 0) {  // some are culled
    tiles.push_back(key);
  }
}

TEST(FrontToBack, NearerTilesComeFirstAlongEveryHalfCircle) {
  Random random(91);
  int steps = 0;
  for (int trial = 0; trial < 150; ++trial) {
    std::vector<lod::TileKey> tiles;
    const glm::dvec3 focus = random.direction();
    for (int face = 0; face < mars::kFaces; ++face)
      split(random, {static_cast<mars::Face>(face), 0, 0, 0}, focus, tiles);
    std::sort(tiles.begin(), tiles.end(),
              [](const auto& a, const auto& b) { return morton_position(a) < morton_position(b); });
    glm::dvec3 nadir = random.integer(0, 1) == 0 ? focus : random.direction();
    if (random.integer(0, 5) == 0) nadir = {0, 0, 1};
    if (random.integer(0, 5) == 0) nadir = glm::normalize(glm::dvec3(1, 1, random.integer(0, 1)));
    std::vector<std::uint32_t> order;
    lod::front_to_back(tiles, nadir, order);
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), tiles.size());
    for (std::uint32_t n = 0; n < sorted.size(); ++n) ASSERT_EQ(sorted[n], n);
    std::vector<std::size_t> rank(tiles.size());
    for (std::size_t n = 0; n < order.size(); ++n) rank[order[n]] = n;
    for (int circle = 0; circle < 40; ++circle) {
      const glm::dvec3 east = mars::any_perpendicular(nadir);
      const double turn = random.uniform(-3.15, 3.15);
      const glm::dvec3 ahead = std::cos(turn) * east + std::sin(turn) * glm::cross(nadir, east);
      std::size_t last = tiles.size();
      for (double angle = 1e-4; angle < 3.14; angle += random.uniform(0, 0.01)) {
        const mars::ChartPoint p = mars::chart_point(std::cos(angle) * nadir + std::sin(angle) * ahead);
        const std::int64_t z = lod::morton_position(lod::tile_at(p, lod::kMaxLevel));
        const auto after = std::upper_bound(
            tiles.begin(), tiles.end(), z,
            [](std::int64_t at, const lod::TileKey& t) { return at < lod::morton_position(t); });
        if (after == tiles.begin()) continue;
        const auto n = static_cast<std::size_t>(after - tiles.begin() - 1);
        if (z >= lod::morton_position(tiles[n]) + lod::morton_extent(tiles[n].level) || n == last) continue;
        if (last < tiles.size()) {
          ASSERT_LT(rank[last], rank[n])
              << lod::to_string(tiles[last]) << " hides " << lod::to_string(tiles[n]);
          ++steps;
        }
        last = n;
      }
    }
  }
  EXPECT_GT(steps, 50000);
}

TEST(FrontToBack, HandlesNoTilesAndOne) {
  std::vector<std::uint32_t> order{7};
  lod::front_to_back({}, {0, 0, 1}, order);
  EXPECT_TRUE(order.empty());
  const lod::TileKey key{mars::Face::kMinusZ, 3, 1, 2};
  lod::front_to_back(std::span(&key, 1), {0, 0, 1}, order);
  EXPECT_EQ(order, std::vector<std::uint32_t>{0});
}

}  // namespace
