// What patches in memory are made of: changes of ground, plans, meshes of grids, tiles in memory.
#include <gtest/gtest.h>

#include <algorithm>

#include "lod/mesh/error_meter.h"
#include "paging/live/memory_tiles.h"
#include "paging/live/patch_plan.h"
#include "paging/live/planet_ground.h"
#include "paging/live/stitched_grid.h"
#include "tests/paging/live/live_fixture.h"

namespace {

using paging::GroundChange;
using test_support::build_live;
using test_support::FakeElevation;
using test_support::live_places;
using test_support::Planet;
using test_support::Random;
using test_support::TempDir;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kNowhere = std::numeric_limits<double>::infinity();

double source_height(const glm::dvec3& d) { return d.z > 0.5 ? kNan : 1000 + 100 * d.x; }

TEST(GroundChange, MixesTheGroundOfASource) {
  const auto source = std::make_shared<const FakeElevation>(source_height, [](const mars::Cap& cap) {
    return cap.centre.z - cap.radius_rad > 0.5 ? kNowhere : 300.0;
  });
  Random random(3);
  std::vector<glm::dvec3> directions;
  for (int n = 0; n < 500; ++n) directions.push_back(random.direction());
  for (const double share : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const auto change = paging::mixed_ground(source, share);
    std::vector<double> heights(directions.size(), 40.0);
    std::vector<double> none(directions.size(), kNan);
    std::vector<int> decided(directions.size(), 7);
    std::vector<int> decided_none(directions.size(), 7);
    change->change(directions, 100, heights, decided);
    change->change(directions, 100, none, decided_none);
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const double e = source_height(directions[n]);
      if (std::isnan(e)) {
        EXPECT_EQ(heights[n], 40.0);
        EXPECT_TRUE(std::isnan(none[n]));
        EXPECT_EQ(decided[n], -1);
        continue;
      }
      EXPECT_NEAR(heights[n], 40 + share * (e - 40), 1e-9);
      EXPECT_EQ(decided[n], share >= 0.5 ? 0 : -1);
      EXPECT_EQ(std::isnan(none[n]), share < 0.5);
      if (share >= 0.5) {
        EXPECT_EQ(none[n], e);
      }
    }
    EXPECT_EQ(change->touches({{1, 0, 0}, 0.1}), share > 0);
    EXPECT_FALSE(change->touches({{0, 0, 1}, 0.1}));
    EXPECT_EQ(change->spacing_in({{1, 0, 0}, 0.1}), 300);
    EXPECT_EQ(change->infos().size(), 1U);
  }
  EXPECT_THROW(paging::mixed_ground(source, -0.1), std::invalid_argument);
  EXPECT_THROW(paging::mixed_ground(source, kNan), std::invalid_argument);
  EXPECT_THROW(paging::mixed_ground(nullptr, 0.5), std::invalid_argument);
}

// Changes ground in a cap alone. A source that depends on the spacing shows whether tiles agree on shared posts.
class SpacedChange : public GroundChange {
 public:
  SpacedChange(const mars::Cap& cap, double spacing_m) : cap_(cap), spacing_m_(spacing_m) {}
  std::vector<mars::SourceInfo> infos() const override { return FakeElevation(source_height).infos(); }
  bool touches(const mars::Cap& cap) const override {
    return mars::angle_between_rad(cap.centre, cap_.centre) <= cap.radius_rad + cap_.radius_rad;
  }
  double spacing_in(const mars::Cap& cap) const override { return touches(cap) ? spacing_m_ : kNowhere; }
  void change(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
              std::span<int> decided_by) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const bool is_in = mars::angle_between_rad(directions[n], cap_.centre) < cap_.radius_rad;
      if (is_in) heights_m[n] += 20 * std::log2(spacing_m);
      decided_by[n] = is_in ? 0 : -1;
    }
  }

 private:
  mars::Cap cap_;
  double spacing_m_;
};

TEST(PatchMaker, TilesAgreeOnPostsOfChangesThatDependOnTheSpacing) {
  const TempDir dir;
  const Planet planet = build_live(dir / "planet.vpe");
  const paging::PatchMaker maker(planet);
  for (const mars::LonLat& place : live_places()) {
    for (const bool full_grids : {false, true}) {
      const auto made = maker.make(SpacedChange({mars::direction(place), 0.03}, 5000),
                                   {.full_grids = full_grids, .threads = 2});
      test_support::expect_sound(*planet->with(made.patch), 100);
    }
  }
}

TEST(PatchMaker, MixesARasterIntoTheGround) {
  const TempDir dir;
  const Planet planet = build_live(dir / "planet.vpe");
  const mars::Cap cap{mars::direction(live_places()[5]), 0.01};
  const auto source = std::make_shared<const FakeElevation>(
      [&](const glm::dvec3& d) { return glm::length(d - cap.centre) < cap.radius_rad ? 7000.0 : kNan; },
      [&](const mars::Cap& other) {
        return glm::length(other.centre - cap.centre) < other.radius_rad + cap.radius_rad ? 3000.0 : kNowhere;
      });
  const paging::PatchMaker maker(planet);
  const double before_m = maker.ground_m(cap.centre);
  for (const double share : {0.25, 1.0}) {
    const auto made = maker.make(*paging::mixed_ground(source, share), {.full_grids = true, .threads = 2});
    const Planet patched = planet->with(made.patch);
    test_support::expect_sound(*patched, 100);
    EXPECT_NEAR(paging::Surface(patched, 1 << 24).at(cap.centre).height_m, before_m + share * (7000 - before_m),
                1)
        << "facets lie below their posts by less than a metre";
  }
  EXPECT_EQ(maker.make(*paging::mixed_ground(source, 0)).patch, nullptr);
}

TEST(PatchMaker, RefusesGroundThatCannotBeStored) {
  const TempDir dir;
  const Planet planet = build_live(dir / "planet.vpe");
  const auto deep =
      std::make_shared<const FakeElevation>([](const glm::dvec3&) { return -mars::kMarsRadius_m; });
  try {
    paging::PatchMaker(planet).make(*paging::mixed_ground(deep, 1));
    FAIL();
  } catch (const paging::PlanetError& e) {
    EXPECT_NE(std::string(e.what()).find("lon "), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("make the change smaller"), std::string::npos);
  }
}

TEST(PlanetGround, IsTheReferenceSurfaceAtPostsOfAnyGrid) {
  const TempDir dir;
  const Planet planet = build_live(dir / "planet.vpe");
  const paging::PlanetGround ground(planet, std::size_t{1} << 24);
  const paging::Surface surface(planet, std::size_t{1} << 24);
  Random random(1);
  for (int n = 0; n < 40; ++n) {
    const lod::TileKey key = lod::tile_at(mars::chart_point(random.direction()), random.integer(0, 9));
    const auto grid = ground.grid(key);
    ASSERT_EQ(grid->height_m.size(), 17U * 17U);
    for (std::size_t p = 0; p < grid->height_m.size(); ++p) {
      EXPECT_NEAR(grid->height_m[p], surface.at(grid->directions[p]).height_m, 1e-8);
      EXPECT_NEAR(ground.height_m(grid->directions[p]), grid->height_m[p], 1e-8);
    }
    EXPECT_TRUE(grid->nodata.empty());
    EXPECT_TRUE(grid->source.empty());
    EXPECT_GT(grid->bytes(), 17U * 17U * 32U);
    EXPECT_EQ(ground.grid(key), grid) << "it is kept";
  }
}

TEST(PatchPlanner, DividesTilesWhereAChangeWantsIt) {
  const TempDir dir;
  const Planet planet = build_live(dir / "planet.vpe");
  const paging::PatchPlanner planner(planet->tree());
  const mars::Cap cap{mars::direction(live_places()[0]), 0.02};
  const paging::PatchPlan plan = planner.plan(SpacedChange(cap, 2500), {});
  std::set<lod::TileKey> made(plan.leaves.begin(), plan.leaves.end());
  EXPECT_EQ(made.size(), plan.leaves.size());
  for (const lod::TileKey& key : plan.tiles->leaves()) {
    const lod::TileInfo* was = planet->tree().find(key);
    const mars::Cap own = lod::bounding_cap(key);
    const bool is_touched = mars::angle_between_rad(own.centre, cap.centre) <= own.radius_rad + cap.radius_rad;
    if (is_touched) {
      EXPECT_LE(lod::post_spacing_m(key.level, 16, planet->radius_m()), 2500);
    }
    if (is_touched || was == nullptr) {
      EXPECT_TRUE(made.contains(key)) << lod::to_string(key);
    }
    // Finest tiles that share an edge differ by one level at most.
    for (const lod::Edge edge : lod::kEdges) {
      const lod::TileKey beside = lod::neighbour(key, edge).key;
      EXPECT_TRUE(plan.tiles->exists(beside) || plan.tiles->is_leaf(lod::parent(beside)));
    }
  }
  for (const lod::TileKey& key : plan.leaves)
    for (lod::TileKey above = key; above.level > 0;) {
      above = lod::parent(above);
      EXPECT_NE(std::find(plan.inner.begin(), plan.inner.end(), above), plan.inner.end());
    }
  EXPECT_TRUE(std::ranges::is_sorted(plan.inner, std::greater(), &lod::TileKey::level));
  // It is the tree that is planned for a whole planet.
  const paging::BuildPlan whole(planet->meta().tile, planet->radius_m(),
                                [&](const lod::TileKey& key, const mars::Cap& of) {
                                  const lod::TileInfo* was = planet->tree().find(key);
                                  const double own_m = was != nullptr && was->has_children ? 0 : kNowhere;
                                  return std::min(own_m, SpacedChange(cap, 2500).spacing_in(of));
                                });
  EXPECT_EQ(plan.tiles->leaves(), whole.leaves());
  EXPECT_EQ(plan.tiles->inner(), whole.inner());
}

// The grid covers the tile once, has the borders that it was given and the posts beside them.
TEST(StitchedGrid, CoversTheTileWithItsBorders) {
  Random random(2);
  for (int round = 0; round < 60; ++round) {
    const int n = 2 << random.integer(1, 4);
    lod::BorderPosts borders;
    for (std::vector<int>& border : borders) {
      for (int a = 0; a <= n; ++a)
        if (a == 0 || a == n || random.integer(0, 2) == 0) border.push_back(a);
    }
    const lod::TileMesh mesh = paging::stitched_grid(n, borders);
    EXPECT_EQ(mesh.intervals, n);
    EXPECT_TRUE(std::is_sorted(mesh.vertices.begin(), mesh.vertices.end(), [](const auto& a, const auto& b) {
      return a.j != b.j ? a.j < b.j : a.i < b.i;
    }));
    int area2 = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      const auto a = mesh.vertices[mesh.triangles[t]];
      const auto b = mesh.vertices[mesh.triangles[t + 1]];
      const auto c = mesh.vertices[mesh.triangles[t + 2]];
      const int twice = (b.i - a.i) * (c.j - a.j) - (b.j - a.j) * (c.i - a.i);
      ASSERT_GT(twice, 0);
      area2 += twice;
    }
    EXPECT_EQ(area2, 2 * n * n);
    std::array<std::vector<int>, 4> found;
    for (const lod::MeshVertex& v : mesh.vertices) {
      if (v.i == 0) found[0].push_back(v.j);
      if (v.i == n) found[1].push_back(v.j);
      if (v.j == 0) found[2].push_back(v.i);
      if (v.j == n) found[3].push_back(v.i);
    }
    EXPECT_EQ(found, borders);
  }
}

TEST(StitchedGrid, IsTheGridOfEverySecondPostIfItsBordersAre) {
  constexpr int kIntervals = 16;
  lod::BorderPosts borders;
  for (std::vector<int>& border : borders)
    for (int a = 0; a <= kIntervals; a += 2) border.push_back(a);
  const lod::TileMesh mesh = paging::stitched_grid(kIntervals, borders);
  EXPECT_EQ(mesh.vertices.size(), 81U);
  ASSERT_EQ(mesh.triangle_count(), 128U);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    int diagonals = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto a = mesh.vertices[mesh.triangles[t + c]];
      const auto b = mesh.vertices[mesh.triangles[t + (c + 1) % 3]];
      if (a.i != b.i && a.j != b.j) {
        ++diagonals;
        EXPECT_EQ(b.i - a.i, b.j - a.j) << "diagonals run from south-west to north-east";
        EXPECT_EQ(std::abs(b.i - a.i), 2);
      }
    }
    EXPECT_EQ(diagonals, 1);
  }
  // With one post more the strips beside the borders are triangulated.
  borders[0].insert(borders[0].begin() + 1, 1);
  EXPECT_EQ(paging::stitched_grid(kIntervals, borders).triangle_count(), 129U);
}

TEST(MemoryTiles, HoldWhatIsPutAndReadTheRest) {
  const TempDir dir;
  const Planet planet = build_live(dir / "planet.vpe");
  paging::MemoryTiles tiles(*planet);
  const lod::TileKey root{mars::Face::kPlusX, 0, 0, 0};
  const auto heights = [&] { return paging::decode_heights(tiles.heights(root), 17); };
  for (std::size_t p = 0; p < heights().size(); ++p)
    EXPECT_EQ(heights()[p] * planet->meta().quantum_m, planet->heights(root).posts.height_m[p]);
  EXPECT_TRUE(tiles.nodata(root).empty());
  EXPECT_EQ(paging::decode_mesh(tiles.mesh(root, 0), 32).mesh.triangles, planet->mesh(root, 0).mesh.triangles);
  paging::NodeRow row;
  row.key = lod::pack(root);
  tiles.put_tile(row, {{1, 2}, {3}, {}, {{4, 5}}});
  EXPECT_EQ(tiles.heights(root), (paging::Bytes{1, 2}));
  EXPECT_EQ(tiles.nodata(root), (paging::Bytes{3}));
  EXPECT_EQ(tiles.mesh(root, 0), (paging::Bytes{4, 5}));
  row.max_m = 7;
  tiles.replace_row(row);
  const std::vector<paging::PatchTile> taken = tiles.take();
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken.front().row.max_m, 7);
  EXPECT_TRUE(tiles.take().empty());
}

}  // namespace
