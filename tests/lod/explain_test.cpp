// The explanation of each drawn tile is that of the selection.
#include "lod/explain.h"

#include <cmath>
#include <map>
#include <set>

#include "lod/options.h"
#include "mars/geodesy/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

namespace {

using lod::LevelReason;
using lod::Selection;
using lod::SelectOptions;
using lod::TileExplanation;
using test_support::Random;
namespace core = vpe::core;

const lod::TileTree& rough_tree() {
  static const lod::TileTree tree = fake::tree(fake::rough(3, 9));
  return tree;
}

core::View view_at(double lon, double lat, double alt_m, double yaw, double pitch) {
  core::View view;
  view.camera = mars::to_camera(mars::Pose{lon, lat, alt_m, yaw, pitch, 0}, fake::kRadius_m);
  return view;
}

struct Explained {
  Selection selection;
  std::vector<TileExplanation> tiles;
};

Explained explained(const SelectOptions& options, const core::View& view) {
  Explained out;
  lod::SelectScratch scratch;
  const lod::SelectView seen = lod::select_view(view);
  lod::select(options, rough_tree(), seen, scratch, out.selection);
  out.tiles = lod::explain(options, rough_tree(), seen, out.selection);
  return out;
}

TEST(Explain, EveryReasonIsThatOfSelection) {
  Random random(81);
  std::map<LevelReason, int> seen;
  for (int trial = 0; trial < 400; ++trial) {
    core::DrawRequest request;
    core::SettingsValues& s = request.settings;
    const double lon = random.uniform(-180, 180);
    const double lat = random.uniform(-90, 90);
    const double alt = 8500 + random.log_uniform(10, 3e6);
    const double yaw = random.uniform(0, 360);
    request.view = view_at(lon, lat, alt, yaw, random.uniform(-90, 0));
    s.lod_metric = random.integer(0, 1) == 0 ? core::LodMetric::kError : core::LodMetric::kDistance;
    s.lod_tolerance_px = random.log_uniform(0.2, 10);
    s.lod_centre_weight = random.integer(0, 1) == 0 ? 0 : random.uniform(0, 2);
    s.exaggeration = random.integer(0, 1) == 0 ? 1 : random.log_uniform(0.2, 5);
    request.interest = {{0, 0, 1e6, random.integer(-2, 2)}};
    const SelectOptions options =
        lod::select_options(request, fake::kRadius_m, random.integer(20'000, 2'000'000));
    const Explained all = explained(options, request.view);
    ASSERT_EQ(all.tiles.size(), all.selection.tiles.size());
    bool spent = false;
    for (std::size_t n = 0; n < all.tiles.size(); ++n) {
      const TileExplanation& e = all.tiles[n];
      const lod::SelectedTile& t = all.selection.tiles[n];
      const lod::TileInfo& info = rough_tree()[t.index];
      ASSERT_EQ(e.key, t.key);
      ASSERT_EQ(e.screen_space_error_px, t.screen_space_error_px);
      ASSERT_EQ(e.variants, static_cast<int>(info.variants.size()));
      // The terms, worked out again, are those that the selection went by, to the bit.
      if (s.lod_metric == core::LodMetric::kDistance) {
        ASSERT_EQ(lod::wanted_level_count(e.terms.sum), e.wanted_level + 1);
        ASSERT_EQ(e.wanted_level + 1, t.control);
        ASSERT_EQ(e.terms.sum,
                  e.terms.distance.weighted() + e.terms.centre.weighted() + e.terms.interest.weighted());
      } else {
        ASSERT_EQ(lod::level_shift(e.terms.sum), e.shift);
        ASSERT_EQ(e.shift, t.control);
        ASSERT_EQ(e.terms.sum, e.terms.centre.weighted() + e.terms.interest.weighted());
      }
      switch (e.reason) {
        case LevelReason::kFinestThere: ASSERT_EQ(e.geometric_error_m, 0.0); break;
        case LevelReason::kWithinTolerance:
          ASSERT_EQ(s.lod_metric, core::LodMetric::kError);
          ASSERT_LE(e.screen_space_error_px * std::exp2(e.shift), options.tolerance_px);
          break;
        case LevelReason::kLevelReached:
          ASSERT_EQ(s.lod_metric, core::LodMetric::kDistance);
          ASSERT_LE(e.wanted_level, e.key.level);
          break;
        case LevelReason::kBudgetSpent: spent = true; break;
        case LevelReason::kReplaced: FAIL(); break;
      }
      ++seen[e.reason];
    }
    ASSERT_EQ(spent, all.selection.capped);
  }
  EXPECT_EQ(seen.size(), 4U);
  for (const auto& [reason, count] : seen) EXPECT_GT(count, 50) << lod::to_string(reason);
}

TEST(Explain, PostSpacingIsThatOfTheLevel) {
  // A quarter of the equator over 128 posts is 41.7 km at level 0, and halves from level to level.
  for (const TileExplanation& e : explained({}, view_at(10, 20, 1e6, 0, -70)).tiles) {
    EXPECT_NEAR(e.post_spacing_m, 41677.8 / std::exp2(e.key.level), 0.1);
  }
}

TEST(Explain, AskingChangesNothing) {
  // The same tiles with and without weights of 0: x is reported all the same.
  const Explained all = explained({}, view_at(10, 20, 1e6, 0, -70));
  double farthest = 0;
  for (const TileExplanation& e : all.tiles) {
    EXPECT_EQ(e.terms.sum, 0.0);
    EXPECT_EQ(e.terms.centre.levels, 0.0);
    EXPECT_NEAR(e.terms.distance.x, e.min_distance_m, 1e5);
    farthest = std::max(farthest, e.terms.centre.x);
  }
  EXPECT_GT(farthest, 0.9);
}

}  // namespace
