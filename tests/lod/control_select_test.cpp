// Both metrics over whole selections, and the properties of a selection that control must not break.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

#include "lod/options.h"
#include "tests/lod/control_fixture.h"

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace {

using namespace control_fixture;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Expects disjoint tiles, and each finest tile that the same view sees at tolerance 0 in one of them.
void expect_cover(const Selection& s, const core::View& view) {
  std::vector<std::int64_t> begins;
  std::int64_t end = -1;
  for (const lod::SelectedTile& t : s.tiles) {
    ASSERT_GE(lod::morton_position(t.key), end);
    begins.push_back(lod::morton_position(t.key));
    end = lod::morton_position(t.key) + lod::morton_extent(t.key.level);
  }
  ASSERT_EQ(s.visited, s.culled_frustum + s.culled_horizon + s.refined + static_cast<int>(s.tiles.size()));
  SelectOptions all;
  all.tolerance_px = 0;
  for (const lod::SelectedTile& leaf : selected(all, rough_tree(), view).tiles) {
    const auto after = std::upper_bound(begins.begin(), begins.end(), lod::morton_position(leaf.key));
    ASSERT_NE(after, begins.begin());
    ASSERT_TRUE(lod::contains(s.tiles[static_cast<std::size_t>(after - begins.begin()) - 1].key, leaf.key))
        << lod::to_string(leaf.key);
  }
}

const lod::SelectedTile* holder(const Selection& s, const glm::dvec3& place) {
  const lod::TileKey key = lod::tile_at(mars::chart_point(place), lod::kMaxLevel);
  for (const lod::SelectedTile& t : s.tiles) {
    if (lod::contains(t.key, key)) return &t;
  }
  return nullptr;
}

TEST(ControlSelection, ByDefaultNothingChanges) {
  // A request with default settings and default options give the same selection, to the bit.
  rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    const core::View view = random_view(random);
    SelectOptions plain;
    plain.tolerance_px = random.log_uniform(0.2, 20);
    plain.max_triangles = random.integer(0, 1) == 0 ? 1'000'000'000 : random.integer(10'000, 300'000);
    core::DrawRequest request;
    request.settings.lod_tolerance_px = plain.tolerance_px;
    const SelectOptions asked = lod::select_options(request, fake::kRadius_m, plain.max_triangles);
    RC_ASSERT(lod::is_neutral(asked.control));
    const Selection a = selected(plain, rough_tree(), view);
    const Selection b = selected(asked, rough_tree(), view);
    RC_ASSERT(a.tiles.size() == b.tiles.size());
    for (std::size_t n = 0; n < a.tiles.size(); ++n) {
      RC_ASSERT(a.tiles[n].key == b.tiles[n].key);
      RC_ASSERT(a.tiles[n].variant == b.tiles[n].variant);
      RC_ASSERT(a.tiles[n].screen_space_error_px == b.tiles[n].screen_space_error_px);
      RC_ASSERT(b.tiles[n].control == 0.0);
    }
  });
}

TEST(ControlSelection, TheDistanceMetricHoldsAtEveryTile) {
  Random random(62);
  int finest = 0;
  int reached = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const core::View view = random_view(random);
    const lod::ControlFunction distance{random.log_uniform(1e4, 1e7), random.uniform(-2, 6), 1, {}};
    SelectOptions options =
        by_distance(distance, {random.uniform(0, 1), random.uniform(-2, 1), random.uniform(0, 2), {}});
    if (trial % 3 == 0) options.control.distance.table = {{0, 12}, {1e5, 8}, {1e6, 5}, {2e6, 3}};
    options.control.regions = {lod::control_region({0, 0, 1e6, random.integer(-3, 3)}, fake::kRadius_m)};
    const Selection s = selected(options, rough_tree(), view);
    expect_cover(s, view);
    if (HasFatalFailure()) return;
    ASSERT_FALSE(s.capped);
    for (const lod::SelectedTile& t : s.tiles) {
      const lod::TileInfo& info = rough_tree()[t.index];
      const int wanted = lod::wanted_level_count(terms_of(options, rough_tree(), view, t.key).sum);
      ASSERT_EQ(t.control, wanted);
      if (lod::is_full_grid(info, t.variant)) {
        ASSERT_GE(wanted, lod::level_count(t.key));
        ++finest;
      } else {
        ASSERT_EQ(t.variant, 0);
        ASSERT_LE(wanted, lod::level_count(t.key) - (info.has_children ? 0 : 1));
        ++reached;
      }
      if (t.key.level > 0) {
        const lod::TileKey above = lod::parent(t.key);
        ASSERT_GT(lod::wanted_level_count(terms_of(options, rough_tree(), view, above).sum),
                  lod::level_count(above));
      }
    }
  }
  EXPECT_GT(finest, 100);
  EXPECT_GT(reached, 100);
}

TEST(ControlSelection, FromAFarCameraTheNumbersAreThoseOfTheFormula) {
  // 10 radii up over the middle of +X all tiles are 34 000 to 38 000 km away: 1e8 / x is 2.6 to 2.9, so that
  // LOD number 2 + 2 = 4 is wanted everywhere, which is level 3.
  const TileTree ball = fake::tree(fake::uniform(5));
  const core::View view = view_at(0, 0, 10 * fake::kRadius_m, 0, -90);
  const Selection s = selected(by_distance({1e8, 2, 1, {}}), ball, view);
  ASSERT_FALSE(s.tiles.empty());
  EXPECT_EQ(s.tiles_by_level, (std::vector<int>{0, 0, 0, static_cast<int>(s.tiles.size())}));
  for (const lod::SelectedTile& t : s.tiles) EXPECT_EQ(t.control, 4);
  // Half the weight: int(0.5 * (2.6 .. 2.9 + 2)) = 2.
  EXPECT_EQ(selected(by_distance({1e8, 2, 0.5, {}}), ball, view).tiles_by_level.size(), 2U);
  // One level more in a region affects that region only.
  SelectOptions options = by_distance({1e8, 2, 1, {}});
  options.control.regions = {lod::control_region({0, 0, 1e5, 1}, fake::kRadius_m)};
  const Selection with = selected(options, ball, view);
  EXPECT_EQ(holder(with, {1, 0, 0})->key.level, 4);
  EXPECT_EQ(holder(with, {1, 0.5, 0})->key.level, 3);
}

TEST(ControlSelection, TheTriangleLimitHoldsWithBothMetrics) {
  Random random(63);
  int capped = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const core::View view = random_view(random);
    SelectOptions options = by_distance({1e6, 3, 1, {}}, {0.25, -1, random.integer(0, 1) * 1.0, {}});
    if (trial % 2 == 0) options.control.metric = core::LodMetric::kError;
    options.control.regions = {lod::control_region({0, 0, 2e6, random.integer(-2, 2)}, fake::kRadius_m)};
    const Selection free = selected(options, rough_tree(), view);
    std::int64_t before = 0;
    for (const std::int64_t cap : {1LL, 10'000LL, 50'000LL, 200'000LL}) {
      options.max_triangles = cap;
      const Selection s = selected(options, rough_tree(), view);
      expect_cover(s, view);
      if (HasFatalFailure()) return;
      std::int64_t triangles = 0;
      for (const auto& t : s.tiles)
        triangles += rough_tree()[t.index].variants[static_cast<std::size_t>(t.variant)].triangles;
      ASSERT_EQ(triangles, s.triangles);
      if (s.triangles > cap) {
        ASSERT_EQ(s.tiles_by_level.size(), 1U);  // roots alone
      }
      ASSERT_GE(s.visited, before);
      before = s.visited;
      if (!s.capped) {
        ASSERT_EQ(s.triangles, free.triangles);
        continue;
      }
      ++capped;
      if (options.control.metric == core::LodMetric::kDistance) {
        // Coarsest first: whatever was refined lacked as many levels as all that is left, or more.
        double most = 0;
        for (const auto& t : s.tiles) {
          const lod::TileInfo& info = rough_tree()[t.index];
          if (lod::is_full_grid(info, t.variant)) continue;
          most = std::max(
              most, t.control - lod::level_count(t.key, t.variant, static_cast<int>(info.variants.size())));
        }
        for (const auto& t : s.tiles) {
          if (t.key.level == 0) continue;
          const lod::TileKey above = lod::parent(t.key);
          ASSERT_GE(lod::wanted_level_count(terms_of(options, rough_tree(), view, above).sum) -
                        lod::level_count(above),
                    most);
        }
      }
    }
  }
  EXPECT_GT(capped, 100);
}

TEST(ControlSelection, MoreWeightOnTheCentreNeverCoarsensTheCentre) {
  int finer = 0;
  rc::check([&finer] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    core::View view = random_view(random);
    view.camera = mars::to_camera(
        mars::Pose{random.uniform(-180, 180), random.uniform(-90, 90), random.log_uniform(1e4, 2e6),
                   random.uniform(0, 360), random.uniform(-90, -50), 0},
        fake::kRadius_m);
    // About the point where the ray ahead meets the ground.
    const double b = glm::dot(view.camera.position_m, view.camera.axes.forward);
    const double root =
        b * b - glm::dot(view.camera.position_m, view.camera.position_m) + fake::kRadius_m * fake::kRadius_m;
    RC_PRE(root > 0);
    const glm::dvec3 place = view.camera.position_m + (-b - std::sqrt(root)) * view.camera.axes.forward;
    SelectOptions options = by_distance({1e6, 1, 1, {}}, {0.25, -1, 0, {}});
    if (random.integer(0, 1) == 0) options.control.metric = core::LodMetric::kError;
    static const TileTree ball = fake::tree(fake::uniform(7));
    int level = 0;
    int variant = 0;
    for (const double weight : {0.0, 0.5, 1.0, 3.0}) {
      options.control.centre.weight = weight;
      const Selection s = selected(options, ball, view);
      const lod::SelectedTile* t = holder(s, place);
      RC_ASSERT(t != nullptr);
      RC_ASSERT(t->key.level > level || (t->key.level == level && t->variant >= variant));
      finer += t->key.level > level ? 1 : 0;
      level = t->key.level;
      variant = t->variant;
    }
  });
  EXPECT_GT(finer, 50);
}

TEST(ControlSelection, MoreInterestNeverCoarsens) {
  int finer = 0;
  rc::check([&finer] {
    // A whole seed whatever the size: small ones repeat views, and few show the region.
    Random random(*rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint32_t>()));
    for (int round = 0; round < 4; ++round) {
      const core::View view = random_view(random);
      SelectOptions options = by_distance({1e6, 2, 1, {}});
      if (random.integer(0, 1) == 0) options.control.metric = core::LodMetric::kError;
      const mars::LonLat at = mars::lon_lat(view.camera.position_m);
      for (int n = random.integer(0, 2); n > 0; --n) {
        options.control.regions.push_back(
            lod::control_region({at.lon_deg + random.uniform(-5, 5), random.uniform(-90, 90),
                                 random.log_uniform(1e4, 1e7), random.integer(-3, 3)},
                                fake::kRadius_m));
      }
      const Selection before = selected(options, rough_tree(), view);
      options.control.regions.push_back(lod::control_region(
          {at.lon_deg, at.lat_deg, random.log_uniform(3e5, 5e6), random.integer(1, 2)}, fake::kRadius_m));
      const Selection after = selected(options, rough_tree(), view);
      finer += after.visited > before.visited ? 1 : 0;
      for (const lod::SelectedTile& t : after.tiles) {
        for (const lod::SelectedTile& old : before.tiles) {
          if (!lod::contains(t.key, old.key)) continue;
          RC_ASSERT(t.key == old.key);  // never an ancestor
          RC_ASSERT(t.variant >= old.variant);
        }
      }
    }
  });
  EXPECT_GT(finer, 10);
}

TEST(ControlSelection, CoarseningCountsOnTheToleranceOrOnDistances) {
  Random random(64);
  int fewer = 0;
  for (int trial = 0; trial < 100; ++trial) {
    core::DrawRequest request;
    request.view = random_view(random);
    request.settings.lod_tolerance_px = random.log_uniform(0.2, 4);
    request.coarsening = 4;
    core::DrawRequest same = request;
    same.coarsening = 1;
    same.settings.lod_tolerance_px *= 4;
    const auto drawn = [](const core::DrawRequest& r) {
      return selected(lod::select_options(r, fake::kRadius_m, 1'000'000'000), rough_tree(), r.view);
    };
    ASSERT_EQ(drawn(request).triangles, drawn(same).triangles);
    request.settings.lod_metric = core::LodMetric::kDistance;
    request.settings.lod_tolerance_px = 0;  // has no say
    same = request;
    same.coarsening = 1;
    same.settings.lod_distance_scale_m /= 4;
    const Selection coarse = drawn(request);
    ASSERT_EQ(coarse.triangles, drawn(same).triangles);
    same.settings.lod_distance_scale_m *= 4;
    ASSERT_LE(coarse.visited, drawn(same).visited);
    fewer += coarse.visited < drawn(same).visited ? 1 : 0;
  }
  EXPECT_GT(fewer, 30);
}

TEST(ControlSelection, TheErrorThatIsReportedIsTheTrueOne) {
  const core::View view = view_at(0, 0, 2e6, 0, -90);
  SelectOptions options;
  options.control.regions = {lod::control_region({0, 0, 1e8, -3}, fake::kRadius_m)};
  const Selection coarse = selected(options, rough_tree(), view);
  EXPECT_GT(coarse.max_screen_space_error_px, 1.0);
  EXPECT_LE(coarse.max_screen_space_error_px, 8.0);
  EXPECT_EQ(coarse.max_screen_space_error_px, [&] {
    SelectOptions eight;
    eight.tolerance_px = 8;
    return selected(eight, rough_tree(), view).max_screen_space_error_px;
  }());
}

TEST(ControlSelection, RefusesWhatIsNoNumber) {
  const TileTree ball = fake::tree(fake::uniform(1));
  const core::View view = view_at(0, 0, 1e6, 0, -90);
  const auto refuses = [&](const auto& spoil) {
    SelectOptions options;
    spoil(options.control);
    EXPECT_THROW(selected(options, ball, view), std::invalid_argument);
  };
  refuses([](auto& c) { c.distance.scale = -1; });
  refuses([](auto& c) { c.distance.offset = kInfinity; });
  refuses([](auto& c) { c.centre.weight = -1; });
  refuses([](auto& c) { c.centre.weight = std::nan(""); });
  refuses([](auto& c) { c.centre.x_factor = 0; });
  refuses([](auto& c) { c.interest_weight = std::nan(""); });
}

}  // namespace
