// Weights of what a budget takes: which tiles become coarser under a coarsening, and under a limit of triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "lod/explain.h"
#include "lod/options.h"
#include "tests/lod/control_fixture.h"

namespace {

using namespace control_fixture;

core::View looking_down() { return view_at(20, 10, 400000, 30, -90); }

SelectOptions with_weights(double tolerance_px, double coarsening, const lod::DegradeWeights& weights) {
  SelectOptions options;
  options.tolerance_px = tolerance_px * coarsening;
  options.control.coarsening = coarsening;
  options.control.degrade = weights;
  return options;
}

bool same_tiles(const Selection& a, const Selection& b) {
  return std::equal(a.tiles.begin(), a.tiles.end(), b.tiles.begin(), b.tiles.end(),
                    [](const auto& x, const auto& y) { return x.key == y.key && x.variant == y.variant; });
}

TEST(Degrade, WeightsChangeNothingUntilABudgetTakesSomething) {
  Random random(71);
  int changed = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const core::View view = random_view(random);
    const double tolerance_px = random.log_uniform(0.2, 5);
    const double distance = random.uniform(0, 3);
    const double centre = random.uniform(0, 3);
    const lod::DegradeWeights weights{distance, centre, random.uniform(0, 3)};
    const Selection even = selected(with_weights(tolerance_px, 1, {}), rough_tree(), view);
    ASSERT_TRUE(same_tiles(even, selected(with_weights(tolerance_px, 1, weights), rough_tree(), view)));
    const Selection coarse = selected(with_weights(tolerance_px, 8, {}), rough_tree(), view);
    changed += same_tiles(coarse, selected(with_weights(tolerance_px, 8, weights), rough_tree(), view)) ? 0 : 1;
  }
  EXPECT_GT(changed, 50);
}

// A tile of weight w is drawn at an error of up to tolerance * coarsening^w, and a tile above it was beyond that.
TEST(Degrade, EachTileLosesByItsWeight) {
  Random random(72);
  int tiles = 0;
  int above = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const core::View view = random_view(random);
    const double coarsening = random.log_uniform(2, 30);
    const double distance = random.uniform(0, 2);
    const double centre = random.uniform(0, 2);
    SelectOptions options = with_weights(0.5, coarsening, {distance, centre, random.uniform(0, 2)});
    options.control.regions = {lod::control_region({20, 10, 1e6, 1}, fake::kRadius_m)};
    const auto limit_px = [&](const lod::TileKey& key) {
      const lod::ControlTerms terms = terms_of(options, rough_tree(), view, key);
      EXPECT_GE(terms.degrade_weight, 0);
      return 0.5 * std::pow(coarsening, terms.degrade_weight) / std::exp2(lod::level_shift(terms.sum));
    };
    const Selection s = selected(options, rough_tree(), view);
    for (const lod::SelectedTile& tile : s.tiles) {
      ASSERT_LE(tile.screen_space_error_px, limit_px(tile.key) * (1 + 1e-9)) << lod::to_string(tile.key);
      ++tiles;
      if (tile.key.level == 0 || tile.variant > 0) continue;
      const lod::TileKey parent = lod::ancestor(tile.key, tile.key.level - 1);
      const auto index = static_cast<TileTree::Index>(rough_tree().find(parent) - &rough_tree()[0]);
      const lod::SelectView seen = lod::select_view(view);
      const double parent_px = lod::measure_tile(options, rough_tree(), seen, index, 0).screen_space_error_px;
      // The parent of a selected tile was refined, with a magnification of at most that of its own parent.
      above += parent_px > limit_px(parent) ? 1 : 0;
      ASSERT_GE(parent_px, limit_px(parent) * (1 - 1e-9)) << lod::to_string(parent);
    }
  }
  EXPECT_GT(tiles, 1000);
  EXPECT_GT(above, 500);
}

TEST(Degrade, TheCentreKeepsItsDetail) {
  Random random(73);
  int lost = 0;
  int rim_lost = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const double lon = random.uniform(-180, 180);
    const double lat = random.uniform(-80, 80);
    const core::View view = view_at(lon, lat, random.log_uniform(3e5, 3e6), 30, -90);
    const lod::TileKey middle = lod::tile_at(mars::chart_point(mars::direction({lon, lat})), lod::kMaxLevel);
    const auto at_centre = [&](const Selection& s) {
      return *std::find_if(s.tiles.begin(), s.tiles.end(),
                           [&](const auto& t) { return lod::contains(t.key, middle); });
    };
    const lod::SelectedTile full = at_centre(selected(with_weights(0.05, 1, {}), rough_tree(), view));
    const Selection even = selected(with_weights(0.05, 16, {}), rough_tree(), view);
    const Selection kept = selected(with_weights(0.05, 16, {1, 0, 1}), rough_tree(), view);
    ASSERT_EQ(at_centre(kept).key, full.key);
    ASSERT_EQ(at_centre(kept).variant, full.variant);
    lost += at_centre(even).screen_space_error_px > full.screen_space_error_px ? 1 : 0;
    rim_lost += kept.max_screen_space_error_px > 0.05 ? 1 : 0;
  }
  EXPECT_GT(lost, 50);
  EXPECT_GT(rim_lost, 50);
}

// The limit holds with any weights, and the triangles go to what is to lose less.
TEST(Degrade, UnderALimitOfTrianglesTheOrderChanges) {
  const core::View view = looking_down();
  constexpr std::int64_t kMost = 60'000;
  const auto capped = [&](const lod::DegradeWeights& weights) {
    SelectOptions options = with_weights(0.02, 1, weights);
    options.max_triangles = kMost;
    const Selection s = selected(options, rough_tree(), view);
    EXPECT_TRUE(s.capped);
    EXPECT_LE(s.triangles, kMost);
    return s;
  };
  // Returns the largest error within a tenth of the image's half height from its centre, and beyond the image's.
  const auto errors_px = [&](const Selection& s) {
    std::pair<double, double> out{0, 0};
    for (const lod::SelectedTile& tile : s.tiles) {
      const double y = terms_of(SelectOptions(), rough_tree(), view, tile.key).centre.x;
      double& largest = y < 0.1 ? out.first : out.second;
      if (y < 0.1 || y > 1) largest = std::max(largest, tile.screen_space_error_px);
    }
    return out;
  };
  const auto [even_centre, even_rim] = errors_px(capped({}));
  const auto [kept_centre, kept_rim] = errors_px(capped({1, 0.2, 1}));
  const auto [lost_centre, lost_rim] = errors_px(capped({1, 4, 1}));
  EXPECT_LT(kept_centre, even_centre);
  EXPECT_GT(kept_rim, even_rim);
  EXPECT_GT(lost_centre, even_centre);
  EXPECT_LT(lost_rim, even_rim);
}

TEST(Degrade, ByDistanceTheLevelsFollow) {
  SelectOptions options = by_distance({1e6, 3, 1, {}, 4.0});
  options.control.coarsening = 4;
  const core::View view = looking_down();
  const lod::TileKey root{mars::Face::kPlusX, 0, 0, 0};
  const auto levels = [&](const lod::DegradeWeights& weights) {
    options.control.degrade = weights;
    return terms_of(options, rough_tree(), view, root).distance.levels;
  };
  options.control.degrade = {};
  const double x = terms_of(options, rough_tree(), view, root).distance.x;
  EXPECT_NEAR(levels({}), 1e6 / (4 * x) + 3, 1e-9);
  EXPECT_NEAR(levels({0, 0, 0}), 1e6 / x + 3, 1e-9);
  EXPECT_NEAR(levels({2, 2, 2}), 1e6 / (16 * x) + 3, 1e-9);
}

TEST(Degrade, ReasonsKnowTheWeights) {
  const core::View view = looking_down();
  const SelectOptions options = with_weights(0.2, 16, {1.5, 0, 1});
  const Selection s = selected(options, rough_tree(), view);
  for (const lod::TileExplanation& e : lod::explain(options, rough_tree(), lod::select_view(view), s)) {
    EXPECT_NE(e.reason, lod::LevelReason::kBudgetSpent) << lod::to_string(e.key);
  }
}

TEST(Degrade, WeightsOutOfRangeAreRefused) {
  for (const lod::DegradeWeights& weights :
       {lod::DegradeWeights{-1, 1, 1}, lod::DegradeWeights{1, std::nan(""), 1},
        lod::DegradeWeights{1, 1, HUGE_VAL}}) {
    EXPECT_THROW(selected(with_weights(1, 2, weights), rough_tree(), looking_down()), std::invalid_argument);
  }
  EXPECT_THROW(selected(with_weights(1, 0.5, {}), rough_tree(), looking_down()), std::invalid_argument);
}

}  // namespace
