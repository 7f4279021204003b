// Patches of reliefs that are made in memory: they are sound planets, have the ground that the reliefs make, and are what a
// build makes.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <thread>

#include "paging/live/composed_change.h"
#include "paging/surface/query.h"
#include "tests/paging/live/live_fixture.h"
#include "tests/paging/patch_between.h"
#include "tests/relief/random_relief.h"

namespace {

using paging::MadePatch;
using paging::PatchOptions;
using paging::ReliefPatcher;
using relief::ReliefSpec;
using test_support::build_live;
using test_support::crater_at;
using test_support::expect_sound;
using test_support::kLiveQuantum_m;
using test_support::live_places;
using test_support::Planet;
using test_support::Random;
using test_support::TempDir;

class LivePatch : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<TempDir>();
    planet_ = build_live(*dir_ / "planet.vpe");
  }
  static void TearDownTestSuite() {
    planet_.reset();
    dir_.reset();
  }
  static std::unique_ptr<TempDir> dir_;
  static Planet planet_;
};
std::unique_ptr<TempDir> LivePatch::dir_;
Planet LivePatch::planet_;

// A row of the index without its checksum tells a tile apart from another one.
void expect_same_patches(const paging::TilePatch& a, const paging::TilePatch& b) {
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (std::size_t n = 0; n < a.tiles.size(); ++n)
    ASSERT_TRUE(test_support::same_stored(a.tiles[n], b.tiles[n])) << n;
  EXPECT_EQ(a.meta, b.meta);
}

TEST_F(LivePatch, WithoutReliefsThePlanetStays) {
  EXPECT_EQ(paging::with_reliefs(planet_, {}), planet_);
  const ReliefPatcher patcher(planet_);
  EXPECT_EQ(patcher.base(), planet_);
  EXPECT_EQ(patcher.with({}), planet_);
}

class LivePatchAt : public LivePatch, public ::testing::WithParamInterface<std::tuple<int, bool, double>> {};

// Craters with posts as coarse and four times as fine as the planet's, at all places, with either kind of meshes.
TEST_P(LivePatchAt, IsASoundPlanetWithTheGroundOfTheRelief) {
  const auto [at, full_grids, spacing_m] = GetParam();
  const mars::LonLat place = live_places()[static_cast<std::size_t>(at)];
  const std::vector<ReliefSpec> specs{crater_at(place, 30000, spacing_m)};
  const ReliefPatcher patcher(planet_);
  MadePatch made;
  const Planet patched = patcher.with(specs, {.full_grids = full_grids, .threads = 2}, &made);
  ASSERT_TRUE(patched->is_patched());
  EXPECT_FALSE(made.is_coarser);
  EXPECT_GT(made.finest_tiles, 0);
  EXPECT_EQ(patched->meta().finest_level > planet_->meta().finest_level, spacing_m < 9000);
  expect_sound(*patched);
  EXPECT_EQ(paging::query(paging::Surface(patched, 1 << 24), place).source, std::optional(1))
      << "the second source is that of the reliefs";

  const paging::PatchMaker maker(planet_);
  const relief::Relief relief =
      relief::place(specs, planet_->radius_m(), [&](const glm::dvec3& d) { return maker.ground_m(d); });
  const mars::Cap cap = relief.placed().front().cap();
  int changed = 0;
  double worst_m = 0;
  for (const auto& post : test_support::finest_posts(*patched, cap)) {
    const double ground_m = maker.ground_m(post.direction);
    const double expected_m = relief.height_m(post.direction, ground_m);
    worst_m = std::max(worst_m, std::abs(post.height_m - expected_m));
    changed += expected_m != ground_m ? 1 : 0;
  }
  EXPECT_LE(worst_m, 0.5 * kLiveQuantum_m + 1e-6);
  EXPECT_GT(changed, 100);
}

INSTANTIATE_TEST_SUITE_P(Places, LivePatchAt,
                         ::testing::Combine(::testing::Range(0, 6), ::testing::Bool(),
                                            ::testing::Values(9000.0, 2500.0)));

// Where tiles keep their level the patch is, bit for bit, what a build of the same ground has otherwise.
TEST_F(LivePatch, IsWhatABuildMakes) {
  using test_support::FakeElevation;
  for (const std::size_t at : {0U, 2U, 5U}) {
    SCOPED_TRACE(at);
    const mars::LonLat place = live_places()[at];
    const std::vector<ReliefSpec> specs{crater_at(place, 9000, 9000), crater_at(place, 4000, 9000, 500)};
    const auto source =
        std::make_shared<const FakeElevation>(test_support::whole_quanta, test_support::fine_at_places(9000));
    const paging::PatchMaker maker(planet_);
    const auto placed = [&] {
      return relief::place(specs, planet_->radius_m(), [&](const glm::dvec3& d) { return maker.ground_m(d); });
    };
    const auto changed = relief::with_relief(source, placed(), relief::relief_info("r.relief.toml", 2));
    const paging::BuildOptions options = test_support::live_options(*dir_ / "built.vpe");
    paging::build_planet(options, *changed, nullptr);
    const Planet built = paging::PlanetFile::open(options.output);
    const MadePatch made = maker.make(*paging::relief_change(placed()), {.threads = 2});
    const Planet patched = planet_->with(made.patch);
    ASSERT_EQ(patched->tree().size(), built->tree().size());
    for (const lod::TileInfo& tile : built->tree().tiles()) {
      SCOPED_TRACE(lod::to_string(tile.key));
      const lod::TileInfo& own = *patched->tree().find(tile.key);
      EXPECT_EQ(own.has_children, tile.has_children);
      EXPECT_EQ(own.min_height_m, tile.min_height_m);
      EXPECT_EQ(own.max_height_m, tile.max_height_m);
      EXPECT_EQ(own.steepest_slope, tile.steepest_slope);
      EXPECT_EQ(own.posts_terms.known(), tile.posts_terms.known());
      if (own.posts_terms.known()) {
        EXPECT_EQ(own.posts_terms.terms().total_m, tile.posts_terms.terms().total_m);
      }
      EXPECT_EQ(patched->heights(tile.key).posts.height_m, built->heights(tile.key).posts.height_m);
      EXPECT_EQ(patched->sources(tile.key).of_post, built->sources(tile.key).of_post);
      ASSERT_EQ(own.variants.size(), tile.variants.size());
      for (std::size_t v = 0; v < own.variants.size(); ++v) {
        EXPECT_EQ(own.variants[v].triangles, tile.variants[v].triangles);
        EXPECT_EQ(own.variants[v].terms.total_m, tile.variants[v].terms.total_m);
        EXPECT_EQ(own.variants[v].terms.height_error_m, tile.variants[v].terms.height_error_m);
        if (v + (tile.has_children ? 0U : 1U) >= own.variants.size()) continue;
        EXPECT_EQ(patched->mesh(tile.key, static_cast<int>(v)).mesh.triangles,
                  built->mesh(tile.key, static_cast<int>(v)).mesh.triangles);
      }
    }
    EXPECT_EQ(patched->meta().lowest_radius_m, built->meta().lowest_radius_m);
    EXPECT_EQ(patched->meta().highest_radius_m, built->meta().highest_radius_m);
    EXPECT_EQ(patched->meta().leaf_tiles, built->meta().leaf_tiles);
    // It holds little more than what differs.
    const auto between = test_support::patch_between(*planet_, *built);
    EXPECT_GE(made.patch->tiles.size(), between->tiles.size());
    EXPECT_LT(made.patch->tiles.size(), planet_->tree().size() / 2);
  }
}

// Beyond the tiles that are made nothing differs; in them the surface differs by the rounding of posts where no relief
// reaches.
TEST_F(LivePatch, NothingElseChanges) {
  const std::vector<ReliefSpec> specs{crater_at(live_places()[1], 20000, 2000)};
  for (const bool full_grids : {false, true}) {
    const ReliefPatcher patcher(planet_);
    const Planet patched = patcher.with(specs, {.full_grids = full_grids, .threads = 2});
    const mars::Cap cap =
        relief::place(specs, planet_->radius_m(), [](const glm::dvec3&) { return 0.0; }).placed().front().cap();
    const paging::Surface before(planet_, std::size_t{1} << 26);
    const paging::Surface after(patched, std::size_t{1} << 26);
    Random random(4);
    int same = 0;
    for (int n = 0; n < 40000; ++n) {
      const glm::dvec3 d = n % 4 == 0 ? random.direction()
                                      : glm::normalize(cap.centre + 5 * cap.radius_rad * random.direction());
      const paging::SurfacePoint a = before.at(d);
      const paging::SurfacePoint b = after.at(d);
      const double away_rad = mars::angle_between_rad(d, cap.centre) - cap.radius_rad;
      // A facet has posts within two of the planet's intervals.
      if (away_rad < 2.5 * lod::post_spacing_m(a.tile.level, 16, 1.0)) continue;
      EXPECT_NEAR(a.height_m, b.height_m, 0.5 * kLiveQuantum_m + 1e-6);
      if (patched->version(b.tile) == planet_->version()) {
        ASSERT_EQ(a.height_m, b.height_m);
        ++same;
      }
    }
    EXPECT_GT(same, 5000);
  }
}

TEST_F(LivePatch, DependsNeitherOnThreadsNorOnEarlierPatches) {
  for (const bool full_grids : {false, true}) {
    const auto state = [&](double depth_m) {
      return relief::place({crater_at(live_places()[0], 25000, 3000, depth_m)}, planet_->radius_m(),
                           [](const glm::dvec3&) { return 0.0; });
    };
    const paging::PatchMaker used(planet_);
    for (const double depth_m : {500.0, 1500.0, 2500.0})
      used.make(*paging::relief_change(state(depth_m)), {.full_grids = full_grids, .threads = 3});
    used.make(*paging::relief_change(relief::place({crater_at(live_places()[3], 9000, 2000)},
                                                   planet_->radius_m(), [](const glm::dvec3&) { return 0.0; })),
              {.full_grids = full_grids, .threads = 3});
    const auto again = used.make(*paging::relief_change(state(1500)), {.full_grids = full_grids, .threads = 3});
    const auto fresh = paging::PatchMaker(planet_, std::size_t{1} << 16)
                           .make(*paging::relief_change(state(1500)), {.full_grids = full_grids, .threads = 1});
    expect_same_patches(*again.patch, *fresh.patch);
  }
}

TEST_F(LivePatch, ManyThreadsMayUseOnePatcher) {
  const ReliefPatcher patcher(planet_);
  std::vector<std::string> identities(6);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < identities.size(); ++t)
    threads.emplace_back([&, t] {
      identities[t] = patcher
                          .with(std::vector<ReliefSpec>{crater_at(live_places()[t % 3], 20000, 3000)},
                                {.full_grids = true, .threads = 1})
                          ->meta()
                          .identity;
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(identities[t], identities[t + 3]);
  EXPECT_NE(identities[0], identities[1]);
}

TEST_F(LivePatch, RandomReliefsOfEveryKindAreSound) {
  Random random(77);
  int sound = 0;
  const ReliefPatcher patcher(planet_);
  for (int n = 0; n < 24; ++n) {
    std::vector<ReliefSpec> specs;
    while (specs.size() < 3) {
      ReliefSpec spec = relief::random_relief(random, relief::kEveryKind[n % 8]);
      const mars::LonLat near = live_places()[static_cast<std::size_t>(random.integer(0, 5))];
      spec.place = {near.lon_deg + random.uniform(-0.3, 0.3),
                    std::min(90.0, near.lat_deg + random.uniform(-0.3, 0.3))};
      spec.polygon.clear();
      spec.spacing_m = random.log_uniform(2000, 30000);
      if (relief::problem_of(spec).empty()) specs.push_back(std::move(spec));
    }
    try {
      const Planet patched =
          patcher.with(specs, {.full_grids = n % 2 == 0, .most_finest_tiles = 600, .threads = 2});
      expect_sound(*patched, 60);
      ++sound;
    } catch (const paging::PlanetError&) {  // it reaches too many tiles
    }
    if (HasFailure()) {
      for (const ReliefSpec& spec : specs) ADD_FAILURE() << relief::to_line(spec);
      break;
    }
  }
  EXPECT_GT(sound, 12);
}

TEST_F(LivePatch, TenThousandStackedReliefs) {
  Random random(5);
  std::vector<ReliefSpec> specs;
  const mars::LonLat middle = live_places()[5];
  for (int n = 0; n < 10000; ++n) {
    ReliefSpec spec =
        crater_at({middle.lon_deg + random.uniform(-0.3, 0.3), middle.lat_deg + random.uniform(-0.3, 0.3)},
                  random.uniform(1000, 9000), 4000, random.uniform(1, 50));
    specs.push_back(spec);
  }
  const Planet patched = paging::with_reliefs(planet_, specs, {.full_grids = true, .threads = 2});
  expect_sound(*patched, 100);
  const paging::PatchMaker maker(planet_);
  const relief::Relief relief =
      relief::place(specs, planet_->radius_m(), [&](const glm::dvec3& d) { return maker.ground_m(d); });
  int changed = 0;
  for (const auto& post : test_support::finest_posts(*patched, {mars::direction(middle), 0.001})) {
    const double expected_m = relief.height_m(post.direction, maker.ground_m(post.direction));
    ASSERT_NEAR(post.height_m, expected_m, 0.5 * kLiveQuantum_m + 1e-6);
    changed += std::abs(expected_m - maker.ground_m(post.direction)) > 10 ? 1 : 0;
  }
  EXPECT_GT(changed, 50);
}

TEST_F(LivePatch, NodataStaysNodata) {
  const mars::LonLat place = live_places()[5];
  const glm::dvec3 hole = mars::direction({place.lon_deg + 0.35, place.lat_deg});
  const auto height = [&](const glm::dvec3& d) {
    return glm::length(d - hole) < 0.003 ? std::numeric_limits<double>::quiet_NaN()
                                         : test_support::whole_quanta(d);
  };
  const Planet planet = build_live(*dir_ / "nodata.vpe", height);
  const paging::PatchMaker maker(planet);
  ASSERT_TRUE(std::isnan(maker.ground_m(hole)));
  for (const bool full_grids : {false, true}) {
    const std::vector<ReliefSpec> specs{crater_at(place, 20000, 2500)};
    const Planet patched = ReliefPatcher(planet).with(specs, {.full_grids = full_grids, .threads = 2});
    expect_sound(*patched);
    const paging::Surface before(planet, std::size_t{1} << 26);
    const paging::Surface after(patched, std::size_t{1} << 26);
    EXPECT_TRUE(after.at(hole).nodata);
    EXPECT_FALSE(after.at(mars::direction(place)).nodata);
    EXPECT_LT(after.at(mars::direction(place)).height_m, before.at(mars::direction(place)).height_m - 1000);
    Random random(8);
    int holes = 0;
    for (int n = 0; n < 20000; ++n) {
      const glm::dvec3 d = glm::normalize(hole + 0.006 * random.direction());
      // A finer facet with a nodata post lies in such a facet of the planet, and beside none.
      if (after.at(d).nodata) {
        ASSERT_TRUE(before.at(d).nodata);
      }
      holes += after.at(d).nodata ? 1 : 0;
    }
    EXPECT_GT(holes, 1000);
  }
}

TEST_F(LivePatch, PatchedPlanetsCanBePatched) {
  const std::vector<ReliefSpec> first{crater_at(live_places()[0], 25000, 4000)};
  const std::vector<ReliefSpec> second{crater_at(live_places()[0], 12000, 2000, 300)};
  for (const bool full_grids : {false, true}) {
    const PatchOptions options{.full_grids = full_grids, .threads = 2};
    const Planet once = paging::with_reliefs(planet_, first, options);
    const Planet twice = paging::with_reliefs(once, second, options);
    expect_sound(*twice);
    EXPECT_EQ(twice->meta().sources.size(), 3U);
    const paging::PatchMaker ground(once);
    const relief::Relief relief =
        relief::place(second, planet_->radius_m(), [](const glm::dvec3&) { return 0.0; });
    int changed = 0;
    for (const auto& post : test_support::finest_posts(*twice, {mars::direction(live_places()[0]), 0.003})) {
      const double before_m = ground.ground_m(post.direction);
      const double expected_m = relief.height_m(post.direction, before_m);
      ASSERT_NEAR(post.height_m, expected_m, 0.5 * kLiveQuantum_m + 1e-6);
      changed += expected_m != before_m ? 1 : 0;
    }
    EXPECT_GT(changed, 50);
  }
}

TEST_F(LivePatch, AChangeThatAsksForTooMuchIsCoarserAndSaysSo) {
  const std::vector<ReliefSpec> specs{crater_at(live_places()[5], 20000, 100)};
  MadePatch all;
  MadePatch few;
  const ReliefPatcher patcher(planet_);
  patcher.with(specs, {.full_grids = true, .finest_spacing_m = 1500, .threads = 2}, &all);
  EXPECT_FALSE(all.is_coarser);
  EXPECT_LE(all.spacing_m, 1500);
  EXPECT_GT(all.spacing_m, 700);
  const Planet patched =
      patcher.with(specs, {.full_grids = true, .most_finest_tiles = 100, .threads = 2}, &few);
  EXPECT_TRUE(few.is_coarser);
  EXPECT_LT(few.finest_tiles, 160);
  EXPECT_GT(few.spacing_m, all.spacing_m);
  expect_sound(*patched, 50);
  try {
    patcher.with(specs, {.most_finest_tiles = 1});
    FAIL();
  } catch (const paging::PlanetError& e) {
    EXPECT_NE(std::string(e.what()).find("a patch may have 1"), std::string::npos) << e.what();
  }
}

// Many tiles, few of them, finest tiles of the planet alone, and none.
TEST_F(LivePatch, APlanSaysWhatIsMade) {
  const paging::PatchMaker maker(planet_);
  const auto change_of = [](double radius_m, double spacing_m) {
    return paging::relief_change(relief::place({crater_at(live_places()[5], radius_m, spacing_m)},
                                               planet_->radius_m(), [](const glm::dvec3&) { return 0.0; }));
  };
  for (const double spacing_m : {9000.0, 2500.0}) {
    for (const std::size_t most : {std::size_t{20}, std::size_t{2048}}) {
      const auto change = change_of(20000, spacing_m);
      const PatchOptions options{.full_grids = true, .most_finest_tiles = most, .threads = 2};
      const MadePatch made = maker.make(*change, options);
      const MadePatch planned = maker.plan(*change, options);
      ASSERT_NE(made.patch, nullptr);
      EXPECT_EQ(planned.patch, nullptr);
      EXPECT_EQ(planned.spacing_m, made.spacing_m);
      EXPECT_EQ(planned.is_coarser, made.is_coarser);
      EXPECT_EQ(planned.finest_tiles, made.finest_tiles);
      EXPECT_EQ(planned.tiles, made.tiles);
    }
  }
  EXPECT_TRUE(maker.plan(*change_of(20000, 100), {.most_finest_tiles = 100}).is_coarser);
  const auto none = paging::changes_in_order({});
  EXPECT_EQ(maker.plan(*none).tiles, 0);
  EXPECT_THROW(maker.plan(*none, {.most_finest_tiles = 0}), std::invalid_argument);
}

TEST_F(LivePatch, ErrorsSayWhatIsWrong) {
  const ReliefPatcher patcher(planet_);
  const auto message = [&](const std::vector<ReliefSpec>& specs,
                           const PatchOptions& options = {}) -> std::string {
    try {
      patcher.with(specs, options);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  };
  ReliefSpec wrong = crater_at(live_places()[0], 1000, 9000);
  wrong.name = "hole";
  wrong.radius_m = -4;
  EXPECT_NE(message({wrong}).find("relief 1 \"hole\""), std::string::npos) << message({wrong});
  const std::vector<ReliefSpec> fine{crater_at(live_places()[0], 10000, 9000)};
  EXPECT_NE(message(fine, {.mesh_ratio = 0}).find("mesh_ratio"), std::string::npos);
  EXPECT_NE(message(fine, {.finest_spacing_m = -1}).find("finest_spacing_m"), std::string::npos);
  EXPECT_NE(message(fine, {.most_finest_tiles = 0}).find("most_finest_tiles"), std::string::npos);
  EXPECT_EQ(message(fine), "");
}

}  // namespace
