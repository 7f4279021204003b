// Tests coarser tiles in place of absent ones: their posts, and what an image is told of them.
#include "vpe/voxel/cast/tile_fallbacks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/paging/planet_fixture.h"
#include "tests/support/support.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using vpe::voxel::AbsentTile;
using vpe::voxel::FallbackTile;
using vpe::voxel::HeightGridLines;
using vpe::voxel::HeightGridStore;
using vpe::voxel::LineFamily;
using vpe::voxel::ReadingRule;
using vpe::voxel::TileFallbacks;
using vpe::voxel::TileHeightGrids;
using Tile = lod::TileTree::Index;

constexpr LineFamily kFamilies[] = {LineFamily::kColumns, LineFamily::kRows, LineFamily::kDiagonals};
constexpr double kUnlimited_m = 1e5;

class TileFallbacksTest : public ::testing::Test {
 protected:
  void SetUp() override {
    planet_ = build_fake(path(), FakeElevation(bumpy_height), 60000);
    ASSERT_GE(planet_->meta().finest_level, 2);
  }
  std::filesystem::path path() const { return dir_ / "p.vpe"; }
  const lod::TileTree& tree() const { return planet_->tree(); }
  Tile tile_of(const lod::TileKey& key) const {
    return static_cast<Tile>(tree().find(key) - tree().tiles().data());
  }
  Tile finest() const { return static_cast<Tile>(tree().size() - 1); }

  test_support::TempDir dir_;
  std::shared_ptr<const paging::PlanetFile> planet_;
};

// Returns the inverse depth of the facets of a tile's grids at a chart point of it.
template <typename T>
double depth_at(const TileHeightGrids<T>& grids, const lod::TileKey& key, int intervals, double radius_m,
                double u, double v) {
  const lod::GridLines lines = lod::grid_lines(key, intervals);
  const auto cell = [&](const std::vector<double>& at, double x) {
    const auto n = static_cast<int>(std::upper_bound(at.begin() + 1, at.end() - 1, x) - at.begin()) - 1;
    const auto k = static_cast<std::size_t>(n);
    return std::pair(n, (x - at[k]) / (at[k + 1] - at[k]));
  };
  const auto [i, s] = cell(lines.u, u);
  const auto [j, t] = cell(lines.v, v);
  const int n = intervals / grids.per_side();
  const HeightGridLines<T>& grid = grids.lines(i / n, j / n);
  const auto post = [&](int di, int dj) {
    const int x = i % n + di, y = j % n + dj;
    const T h = grids.family() == LineFamily::kColumns ? grid.line(x)[y]
                : grids.family() == LineFamily::kRows  ? grid.line(y)[x]
                                                       : grid.line(x - y)[x];
    return grid.reference.w0 + grid.reference.wx * x + grid.reference.wy * y -
           static_cast<double>(h) / (radius_m * radius_m);
  };
  const double middle = s >= t ? post(1, 0) : post(0, 1);
  return post(0, 0) + std::max(s, t) * (middle - post(0, 0)) + std::min(s, t) * (post(1, 1) - middle);
}

double height_at(double inverse_depth, double u, double v, double radius_m) {
  return std::sqrt(u * u + v * v + 1) / inverse_depth - radius_m;
}

TEST_F(TileFallbacksTest, FamiliesAreCopiesOfEachOther) {
  const double radius_m = planet_->radius_m();
  for (const Tile tile : {Tile{0}, tree().first_child(0), finest()}) {
    const paging::TileHeights heights = planet_->heights(tree()[tile].key);
    for (const LineFamily from : kFamilies) {
      const TileHeightGrids<float> first(heights, radius_m, 1, from);
      for (const LineFamily to : kFamilies) {
        const TileHeightGrids<float> direct(heights, radius_m, 1, to);
        const TileHeightGrids<float> copied(first, to);
        ASSERT_EQ(copied.family(), to);
        ASSERT_EQ(copied.bytes(), direct.bytes());
        for (int g = 0; g < direct.per_side() * direct.per_side(); ++g) {
          const HeightGridLines<float>& a = direct.lines(g % direct.per_side(), g / direct.per_side());
          const HeightGridLines<float>& b = copied.lines(g % direct.per_side(), g / direct.per_side());
          EXPECT_EQ(a.reference.w0, b.reference.w0);
          const auto all = static_cast<std::ptrdiff_t>(a.block_max - a.posts);
          ASSERT_EQ(all, b.block_max - b.posts);
          EXPECT_TRUE(std::equal(a.posts, a.posts + all, b.posts));
        }
      }
    }
  }
}

// The facets of a fallback are those of its ancestor, at any number of levels.
TEST_F(TileFallbacksTest, AFallbackHasTheFacetsOfItsAncestor) {
  const int intervals = tree().shape().intervals();
  const double radius_m = planet_->radius_m();
  test_support::Random random(31);
  for (const double exaggeration : {1.0, 20.0}) {
    for (const Tile tile : {finest(), Tile(tree().size() - 14), tree().first_child(3) + 2}) {
      const lod::TileKey key = tree()[tile].key;
      for (int up = 1; up <= key.level; ++up) {
        const lod::TileKey coarser = lod::ancestor(key, key.level - up);
        const TileHeightGrids<float> from(planet_->heights(coarser, exaggeration), radius_m, exaggeration,
                                          LineFamily::kDiagonals);
        const FallbackTile replaced{key, coarser, intervals, -kUnlimited_m, kUnlimited_m};
        for (const LineFamily family : kFamilies) {
          const TileHeightGrids<float> grids(from, replaced, radius_m, exaggeration, family);
          const mars::ChartRect rect = lod::chart_rect(key);
          for (int n = 0; n < 200; ++n) {
            const double u = random.uniform(rect.u0, rect.u1);
            const double v = random.uniform(rect.v0, rect.v1);
            const double wanted = height_at(depth_at(from, coarser, intervals, radius_m, u, v), u, v, radius_m);
            const double shown = height_at(depth_at(grids, key, intervals, radius_m, u, v), u, v, radius_m);
            EXPECT_NEAR(shown, wanted, 0.1) << lod::to_string(key) << " of " << lod::to_string(coarser);
          }
        }
      }
    }
  }
}

TEST_F(TileFallbacksTest, AFallbackKeepsWithinTheHeightsOfWhatItReplaces) {
  const int intervals = tree().shape().intervals();
  const double radius_m = planet_->radius_m();
  const HeightGridStore store(planet_, std::size_t{1} << 26);
  const double exaggeration = 3;
  for (Tile tile = 6; tile < tree().size(); ++tile) {
    const lod::TileInfo& info = tree()[tile];
    const Tile root = tile_of(lod::ancestor(info.key, 0));
    const auto grids = store.fallback_grids(tile, root, LineFamily::kRows, exaggeration);
    const auto exact = store.exact_fallback_grids(tile, root, LineFamily::kRows, exaggeration);
    const lod::GridLines lines = lod::grid_lines(info.key, intervals);
    for (std::size_t k = 0; k < lines.u.size(); k += 3) {
      const double u = lines.u[k], v = lines.v[lines.v.size() - 1 - k];
      const double height_m = height_at(depth_at(*grids, info.key, intervals, radius_m, u, v), u, v, radius_m);
      EXPECT_GE(height_m, exaggeration * info.min_height_m - 0.1);
      EXPECT_LE(height_m, exaggeration * info.max_height_m + 0.1);
      EXPECT_NEAR(height_at(depth_at(*exact, info.key, intervals, radius_m, u, v), u, v, radius_m), height_m,
                  0.1);
    }
  }
  // Limits that the ancestor exceeds.
  const lod::TileKey key = tree()[finest()].key;
  const FallbackTile narrow{key, lod::ancestor(key, 0), intervals, 100, 101};
  const auto root = store.any_grids(tile_of(narrow.coarser), 1);
  const TileHeightGrids<float> flat(*root, narrow, radius_m, 1, LineFamily::kRows);
  const lod::GridLines lines = lod::grid_lines(key, intervals);
  for (std::size_t k = 0; k < lines.u.size(); ++k) {
    const double height_m = height_at(depth_at(flat, key, intervals, radius_m, lines.u[k], lines.v[k]),
                                      lines.u[k], lines.v[k], radius_m);
    EXPECT_NEAR(height_m, 100.5, 0.6);
  }
}

// What may not be read is shown with its nearest ancestor that is held; what is held is shown as itself.
TEST_F(TileFallbacksTest, NothingIsReadWhereReadingIsForbidden) {
  std::set<std::string> reads;
  const auto watched = paging::PlanetFile::open(
      path().string(), [&](const lod::TileKey& tile) { reads.insert(lod::to_string(tile)); });
  const HeightGridStore store(watched, std::size_t{1} << 26);
  const lod::TileKey key = tree()[finest()].key;
  const Tile root = tile_of(lod::ancestor(key, 0));
  const Tile parent = tile_of(lod::ancestor(key, key.level - 1));
  {
    TileFallbacks fallbacks(store, 1, ReadingRule::never());
    fallbacks.grids(finest(), LineFamily::kRows);
    EXPECT_EQ(reads, (std::set<std::string>{lod::to_string(tree()[root].key)})) << "the root is needed";
    ASSERT_EQ(fallbacks.absent().size(), 1U);
    EXPECT_EQ(fallbacks.absent()[0].tile, finest());
    EXPECT_EQ(fallbacks.absent()[0].source, root);
    EXPECT_EQ(fallbacks.absent()[0].family, LineFamily::kRows);
    EXPECT_FALSE(fallbacks.absent()[0].failure);
    EXPECT_EQ(fallbacks.source_of(finest()), root);
    // The decision holds for the image, whatever arrives.
    store.grids(finest(), LineFamily::kRows, 1);
    fallbacks.grids(finest(), LineFamily::kColumns);
    EXPECT_EQ(fallbacks.source_of(finest()), root);
  }
  {
    TileFallbacks fallbacks(store, 1, ReadingRule::never());
    fallbacks.grids(finest(), LineFamily::kRows);
    EXPECT_TRUE(fallbacks.absent().empty());
  }
  {
    // At another exaggeration nothing is held but what is read now.
    TileFallbacks fallbacks(store, 2, ReadingRule::never());
    fallbacks.require(parent);
    fallbacks.grids(finest(), LineFamily::kRows);
    EXPECT_EQ(fallbacks.source_of(finest()), parent);
  }
}

TEST_F(TileFallbacksTest, ChildrenThatAreHeldStandInForTheirParent) {
  const HeightGridStore store(planet_, std::size_t{1} << 26);
  const lod::TileKey key = tree()[finest()].key;
  const Tile parent = tile_of(lod::ancestor(key, key.level - 1));
  const Tile first = tree().first_child(parent);
  TileFallbacks fallbacks(store, 1, ReadingRule::never());
  for (Tile child = first; child < first + 4; ++child) {
    EXPECT_FALSE(fallbacks.prefers_children(parent));
    store.grids(child, LineFamily::kRows, 1);
  }
  EXPECT_TRUE(fallbacks.prefers_children(parent));
  ASSERT_EQ(fallbacks.absent().size(), 1U);
  EXPECT_EQ(fallbacks.absent()[0].tile, parent);
  EXPECT_EQ(fallbacks.absent()[0].source, parent);
  store.grids(parent, LineFamily::kRows, 1);
  TileFallbacks later(store, 1, ReadingRule::never());
  EXPECT_FALSE(later.prefers_children(parent));
}

TEST_F(TileFallbacksTest, UnreadableTilesAreReadOnce) {
  const lod::TileKey key = tree()[finest()].key;
  const lod::TileKey above = lod::ancestor(key, key.level - 1);
  int reads = 0;
  const auto damaged = paging::PlanetFile::open(path().string(), [&](const lod::TileKey& tile) {
    if (tile != key && tile != above) return;
    ++reads;
    throw paging::PlanetError("p.vpe: tile " + lod::to_string(tile) + " is damaged");
  });
  const HeightGridStore store(damaged, std::size_t{1} << 26);
  for (int image = 0; image < 3; ++image) {
    TileFallbacks fallbacks(store, 1, ReadingRule::always());
    for (const LineFamily family : kFamilies) fallbacks.grids(finest(), family);
    EXPECT_EQ(fallbacks.source_of(finest()), tile_of(lod::ancestor(key, key.level - 2)));
    const std::vector<AbsentTile> absent = fallbacks.absent();
    ASSERT_EQ(absent.size(), 1U);
    ASSERT_TRUE(absent[0].failure);
    EXPECT_NE(absent[0].failure->find(lod::to_string(key)), std::string::npos);
  }
  EXPECT_EQ(reads, 2);
}

// Tiles for single rays are read by themselves, and their failures are remembered too.
TEST_F(TileFallbacksTest, TilesForSingleRaysAreHeldOrAbsent) {
  const lod::TileKey key = tree()[finest()].key;
  int reads = 0;
  const auto damaged = paging::PlanetFile::open(path().string(), [&](const lod::TileKey& tile) {
    if (tile != key) return;
    ++reads;
    throw paging::PlanetError("p.vpe: tile " + lod::to_string(tile) + " is damaged");
  });
  const HeightGridStore store(damaged, std::size_t{1} << 26);
  const paging::Surface surface(damaged, std::size_t{1} << 26);
  const lod::TileKey other = tree()[finest() - 1].key;
  TileFallbacks never(store, 1, ReadingRule::never());
  EXPECT_EQ(never.surface_tile(surface, other), nullptr);
  ASSERT_EQ(never.absent().size(), 1U);
  EXPECT_TRUE(never.absent()[0].for_single_rays);
  EXPECT_FALSE(never.absent()[0].failure);
  for (int image = 0; image < 3; ++image) {
    TileFallbacks always(store, 1, ReadingRule::always());
    EXPECT_NE(always.surface_tile(surface, other), nullptr);
    EXPECT_EQ(always.surface_tile(surface, key), nullptr);
    ASSERT_EQ(always.absent().size(), 1U);
    EXPECT_TRUE(always.absent()[0].failure);
  }
  EXPECT_EQ(reads, 1);
}

TEST(ReadingRule, EndsWhenItsTimeIsSpentWithReading) {
  const ReadingRule rule(1e-3, 2);
  EXPECT_TRUE(rule.may_read());
  const ReadingRule copy = rule;
  EXPECT_EQ(copy.timed([] {
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(3);
    while (std::chrono::steady_clock::now() < until) {
    }
    return 7;
  }),
            7);
  EXPECT_FALSE(rule.may_read());
  EXPECT_FALSE(ReadingRule::never().may_read());
  EXPECT_TRUE(ReadingRule::always().may_read());
  EXPECT_FALSE(ReadingRule(0, 8).may_read());
}

}  // namespace
