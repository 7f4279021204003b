// Patched planets are the same as planets that were built with the change, and keep what the patch leaves as it was.
#include "paging/planet/tile_patch.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <set>
#include <thread>

#include "paging/planet/planet_user.h"
#include "paging/planet/verify.h"
#include "paging/surface/profile.h"
#include "paging/surface/query.h"
#include "tests/paging/patch_between.h"

namespace {

using paging::MadeOf;
using paging::PatchTile;
using paging::PlanetError;
using paging::PlanetFile;
using paging::TilePatch;
using test_support::build_changed;
using test_support::kPatched;
using test_support::kPatchedReach_rad;
using test_support::patch_between;
using test_support::patches;
using test_support::PlanetChange;
using test_support::Random;
using test_support::TempDir;
using Planet = std::shared_ptr<const PlanetFile>;

void expect_same_tiles(const PlanetFile& a, const PlanetFile& b) {
  ASSERT_EQ(a.tree().size(), b.tree().size());
  for (std::size_t n = 0; n < a.tree().size(); ++n) {
    const lod::TileInfo& tile = a.tree().tiles()[n];
    const lod::TileInfo& other = b.tree().tiles()[n];
    SCOPED_TRACE(lod::to_string(tile.key));
    ASSERT_EQ(tile.key, other.key);
    EXPECT_EQ(tile.min_height_m, other.min_height_m);
    EXPECT_EQ(tile.max_height_m, other.max_height_m);
    EXPECT_EQ(tile.steepest_slope, other.steepest_slope);
    EXPECT_EQ(tile.has_children, other.has_children);
    EXPECT_EQ(tile.posts_terms.known(), other.posts_terms.known());
    if (tile.posts_terms.known()) {
      EXPECT_EQ(tile.posts_terms.terms().total_m, other.posts_terms.terms().total_m);
    }
    ASSERT_EQ(tile.variants.size(), other.variants.size());
    const paging::TileHeights heights = a.heights(tile.key, 2);
    const paging::TileHeights others = b.heights(tile.key, 2);
    EXPECT_EQ(heights.posts.height_m, others.posts.height_m);
    EXPECT_EQ(heights.nodata, others.nodata);
    EXPECT_EQ(heights.source, others.source);
    EXPECT_EQ(heights.coarser_neighbour_mask, others.coarser_neighbour_mask);
    EXPECT_EQ(a.has_nodata(tile.key), b.has_nodata(tile.key));
    EXPECT_EQ(a.sources(tile.key).of_post, b.sources(tile.key).of_post);
    EXPECT_EQ(a.sources(tile.key).resampling, b.sources(tile.key).resampling);
    for (int v = 0; v < static_cast<int>(tile.variants.size()); ++v) {
      EXPECT_EQ(tile.variants[static_cast<std::size_t>(v)].terms.total_m,
                other.variants[static_cast<std::size_t>(v)].terms.total_m);
      if (lod::is_full_grid(tile, v)) continue;
      const paging::PackedMesh mesh = a.mesh(tile.key, v);
      const paging::PackedMesh same = b.mesh(tile.key, v);
      EXPECT_EQ(mesh.height_q, same.height_q);
      EXPECT_EQ(mesh.mesh.vertices, same.mesh.vertices);
      EXPECT_EQ(mesh.mesh.triangles, same.mesh.triangles);
    }
  }
  ASSERT_EQ(a.image_keys(), b.image_keys());
  for (const lod::TileKey& key : a.image_keys()) EXPECT_TRUE(a.image(key).texels == b.image(key).texels);
  paging::PlanetMeta meta = a.meta();
  meta.identity = b.meta().identity;
  EXPECT_TRUE(meta == b.meta());
}

// The planets are read alone, and made once.
class PatchedPlanet : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<TempDir>();
    base_ = build_changed(*dir_ / "base.vpe", {});
    raised_ = build_changed(*dir_ / "raised.vpe", {.raised_m = 900, .is_finer = true});
    holed_ = build_changed(*dir_ / "holed.vpe", {.raised_m = -500, .has_nodata = true});
  }
  static void TearDownTestSuite() {
    for (Planet* planet : {&base_, &raised_, &holed_}) planet->reset();
    dir_.reset();
  }

  static std::unique_ptr<TempDir> dir_;
  static Planet base_, raised_, holed_;
};
std::unique_ptr<TempDir> PatchedPlanet::dir_;
Planet PatchedPlanet::base_;
Planet PatchedPlanet::raised_;
Planet PatchedPlanet::holed_;

TEST_F(PatchedPlanet, IsThePlanetBuiltWithTheChange) {
  for (const Planet& changed : {raised_, holed_}) {
    const auto patch = patch_between(*base_, *changed);
    ASSERT_GT(patch->tiles.size(), 20U);
    ASSERT_LT(patch->tiles.size(), base_->tree().size() / 2) << "the patch shall be a small part";
    const Planet patched = base_->with(patch);
    expect_same_tiles(*patched, *changed);
    EXPECT_TRUE(patched->is_patched());
    EXPECT_FALSE(base_->is_patched());
    EXPECT_EQ(patched->path(), base_->path());
  }
  EXPECT_GT(raised_->meta().finest_level, base_->meta().finest_level)
      << "a finest tile shall become an inner one";
  EXPECT_FALSE(base_->has_nodata({mars::Face::kPlusX, 0, 0, 0}));
}

TEST_F(PatchedPlanet, ImagesArePatchedToo) {
  const TempDir dir;
  const Planet base = build_changed(dir / "a.vpe", {.has_image = true});
  const Planet painted = build_changed(dir / "b.vpe", {.raised_m = 100, .has_image = true, .is_painted = true});
  const auto patch = patch_between(*base, *painted);
  ASSERT_FALSE(patch->images.empty());
  ASSERT_LT(patch->images.size(), base->image_keys().size());
  const Planet patched = base->with(patch);
  expect_same_tiles(*patched, *painted);
  for (const lod::TileKey& key : base->image_keys()) {
    const bool is_same = base->image(key).texels == patched->image(key).texels;
    EXPECT_EQ(patched->version(key, MadeOf::kImage) == base->version(), is_same) << lod::to_string(key);
  }
}

TEST_F(PatchedPlanet, AnswersQueriesCastsAndProfilesAsThePlanetBuiltWithTheChange) {
  for (const Planet& changed : {raised_, holed_}) {
    const paging::Surface patched(base_->with(patch_between(*base_, *changed)), std::size_t{64} << 20);
    const paging::Surface built(changed, std::size_t{64} << 20);
    Random random(3);
    for (int n = 0; n < 10000; ++n) {
      const glm::dvec3 d =
          n % 2 == 0 ? random.direction() : glm::normalize(kPatched + 0.04 * random.direction());
      const paging::PlaceAnswer a = query(patched, mars::lon_lat(d));
      const paging::PlaceAnswer b = query(built, mars::lon_lat(d));
      ASSERT_EQ(a.elevation_m, b.elevation_m);
      ASSERT_EQ(a.nodata, b.nodata);
      ASSERT_EQ(a.slope_deg, b.slope_deg);
      ASSERT_EQ(a.level, b.level);
      ASSERT_EQ(a.geometric_error_m, b.geometric_error_m);
      ASSERT_EQ(a.source, b.source);
      ASSERT_EQ(a.resampling, b.resampling);
    }
    const mars::LonLat middle = mars::lon_lat(kPatched);
    const std::array places{mars::LonLat{middle.lon_deg - 4, middle.lat_deg},
                            mars::LonLat{middle.lon_deg + 4, middle.lat_deg}};
    const auto along = profile(patched, places, 2000);
    const auto same = profile(built, places, 2000);
    ASSERT_EQ(along.size(), same.size());
    for (std::size_t n = 0; n < along.size(); ++n) {
      EXPECT_EQ(along[n].height_m, same[n].height_m);
      EXPECT_EQ(along[n].ground_distance_m, same[n].ground_distance_m);
    }
    int hits = 0;
    for (int n = 0; n < 2000; ++n) {
      const glm::dvec3 eye = glm::normalize(kPatched + 0.1 * random.direction()) * (base_->radius_m() + 15000);
      const glm::dvec3 to = glm::normalize(kPatched + 0.03 * random.direction()) * base_->radius_m();
      const double range_m = patched.cast(eye, glm::normalize(to - eye), 1.5);
      ASSERT_EQ(range_m, built.cast(eye, glm::normalize(to - eye), 1.5));
      hits += std::isfinite(range_m) ? 1 : 0;
    }
    EXPECT_GT(hits, 1000);
  }
}

TEST_F(PatchedPlanet, IsSoundAllOver) {
  const Planet patched = base_->with(patch_between(*base_, *raised_));
  const paging::VerifyReport report = paging::verify(*patched, {.threads = 2, .deep_tiles = 40});
  for (const paging::Problem& problem : report.problems) ADD_FAILURE() << problem.where << ": " << problem.what;
  EXPECT_EQ(report.tiles, static_cast<std::int64_t>(patched->tree().size()));
  EXPECT_THROW(patched->connect(), PlanetError);
}

TEST_F(PatchedPlanet, CanBePatchedAgainAndBack) {
  const Planet raised = base_->with(patch_between(*base_, *raised_));
  // No patch removes a tile, so the way back from finer tiles does not exist.
  const Planet holed = base_->with(patch_between(*base_, *holed_));
  const Planet both = holed->with(patch_between(*holed_, *raised_));
  expect_same_tiles(*both, *raised_);
  const Planet back = holed->with(patch_between(*holed_, *base_));
  expect_same_tiles(*back, *base_);
  expect_same_tiles(*holed, *holed_);
  std::set<std::string> identities;
  for (const Planet& planet : {base_, raised, holed, both, back}) identities.insert(planet->meta().identity);
  EXPECT_EQ(identities.size(), 5U);
  EXPECT_EQ(base_->with(patch_between(*base_, *raised_))->meta().identity, raised->meta().identity);
  auto turned = patch_between(*base_, *raised_);
  std::reverse(turned->tiles.begin(), turned->tiles.end());
  EXPECT_EQ(base_->with(turned)->meta().identity, raised->meta().identity);
}

TEST_F(PatchedPlanet, OutlivesThePlanetUnderIt) {
  Planet under = PlanetFile::open(base_->path());
  const Planet patched = under->with(patch_between(*base_, *raised_));
  under.reset();
  expect_same_tiles(*patched, *raised_);
}

// The versions of pages say what must be made again: normals also across borders, textures also for finer tiles.
TEST_F(PatchedPlanet, VersionsDifferWherePagesDiffer) {
  const auto patch = patch_between(*base_, *raised_);
  const Planet patched = base_->with(patch);
  EXPECT_GT(patched->version(), base_->version());
  int kept = 0;
  for (const lod::TileInfo& tile : patched->tree().tiles()) {
    SCOPED_TRACE(lod::to_string(tile.key));
    const bool is_patched = patches(*patch, tile.key);
    EXPECT_EQ(patched->version(tile.key), is_patched ? patched->version() : base_->version());
    bool beside = is_patched;
    for (const lod::Edge edge : lod::kEdges)
      beside = beside || patches(*patch, patched->tree().deepest(lod::neighbour(tile.key, edge).key).key);
    EXPECT_EQ(patched->version(tile.key, MadeOf::kBorders), beside ? patched->version() : base_->version());
    EXPECT_GE(patched->version(tile.key, MadeOf::kArea), patched->version(tile.key, MadeOf::kBorders));
    kept += patched->version(tile.key, MadeOf::kArea) == base_->version() ? 1 : 0;
  }
  EXPECT_GT(kept, static_cast<int>(base_->tree().size()) / 2);
  EXPECT_EQ(base_->version({mars::Face::kPlusX, 0, 0, 0}), base_->version());
  // A second patch, of one tile elsewhere, leaves what the first one has made.
  const lod::TileKey alone =
      base_->tree().deepest(lod::tile_at(mars::chart_point(-kPatched), lod::kMaxLevel)).key;
  auto one = std::make_shared<TilePatch>();
  one->meta = patched->meta();
  one->tiles.push_back(test_support::read_stored(*base_).tiles.at(lod::pack(alone)));
  const Planet again = patched->with(one);
  for (const PatchTile& tile : patch->tiles)
    EXPECT_EQ(again->version(*lod::unpack(tile.row.key)), patched->version());
  EXPECT_EQ(again->version(alone), again->version());
  ASSERT_GT(alone.level, 0);
  for (lod::TileKey above = alone; above.level > 0;) {
    above = lod::parent(above);
    EXPECT_EQ(again->version(above), base_->version());
    EXPECT_EQ(again->version(above, MadeOf::kArea), again->version())
        << "textures may be finer than a tile's posts";
  }
  // So may those of a tile beside a patched one that is coarser or finer.
  for (const lod::Edge edge : lod::kEdges) {
    const lod::TileKey beside = lod::neighbour(alone, edge).key;
    EXPECT_EQ(again->version(beside, MadeOf::kArea), again->version());
    EXPECT_EQ(again->version(lod::child(beside, 0)), base_->version());
  }
}

// Every post whose sun differs has another shadow version.
TEST_F(PatchedPlanet, ShadowVersionsDifferWhereShadowsMay) {
  const Planet patched = base_->with(patch_between(*base_, *raised_));
  const paging::Surface before(base_, std::size_t{64} << 20);
  const paging::Surface after(patched, std::size_t{64} << 20);
  Random random(5);
  int differ = 0;
  for (int n = 0; n < 60000; ++n) {
    const glm::dvec3 up = glm::normalize(kPatched + random.uniform(0.02, 0.06) * random.direction());
    const glm::dvec3 across = glm::normalize(kPatched - up * glm::dot(kPatched, up));
    const double elevation = random.uniform(0, 0.03);
    const glm::dvec3 sun = std::cos(elevation) * across + std::sin(elevation) * up;
    const paging::SurfacePoint here = before.at(up);
    if (here.radius_m != after.at(up).radius_m) continue;
    const glm::dvec3 place_m = up * (here.radius_m + 9);
    if (std::isinf(before.cast(place_m, sun)) == std::isinf(after.cast(place_m, sun))) continue;
    ++differ;
    EXPECT_EQ(patched->shadow_version(here.tile, 1), patched->version()) << lod::to_string(here.tile);
  }
  EXPECT_GT(differ, 20);
  const lod::TileKey far = after.at(-kPatched).tile;
  EXPECT_EQ(patched->shadow_version(far, 1), base_->version());
  EXPECT_EQ(patched->shadow_version(far, 2), patched->version());
  EXPECT_EQ(base_->shadow_version(far, 2), base_->version());
}

TEST_F(PatchedPlanet, ASurfaceKeepsTheTilesThatStayTheSame) {
  std::set<std::int64_t> read;
  const Planet base =
      PlanetFile::open(base_->path(), [&](const lod::TileKey& key) { read.insert(lod::pack(key)); });
  const auto patch = patch_between(*base_, *raised_);
  const Planet patched = base->with(patch);
  paging::Surface surface(base, std::size_t{64} << 20);
  const paging::Surface fresh(raised_, std::size_t{64} << 20);
  const auto visit = [&](const auto& check) {
    Random random(9);
    for (int n = 0; n < 4000; ++n)
      check(n % 2 == 0 ? random.direction() : kPatched + 0.05 * random.direction());
  };
  visit([&](const glm::dvec3& d) { surface.at(d); });
  const std::size_t first = read.size();
  read.clear();
  surface.change_planet(patched);
  visit([&](const glm::dvec3& d) { EXPECT_EQ(surface.at(d).height_m, fresh.at(d).height_m); });
  EXPECT_GT(read.size(), 0U);
  EXPECT_LT(read.size(), first / 2);
  for (const std::int64_t key : read) EXPECT_TRUE(patches(*patch, *lod::unpack(key))) << key;
  // The tiles of before are still there.
  read.clear();
  surface.change_planet(base);
  visit([&](const glm::dvec3& d) { surface.at(d); });
  EXPECT_EQ(read.size(), 0U);
}

TEST_F(PatchedPlanet, AUserStaysWithItsGrid) {
  const TempDir dir;
  const Planet other = test_support::build_fake(
      dir / "k5.vpe", test_support::FakeElevation(test_support::bumpy_height), 300000);  // tile_k 5
  EXPECT_THROW(paging::require_same_grid(*base_, *other), std::invalid_argument);
  EXPECT_NO_THROW(paging::require_same_grid(*base_, *raised_));
  paging::Surface surface(base_, 1 << 20);
  EXPECT_THROW(surface.change_planet(other), std::invalid_argument);
}

TEST_F(PatchedPlanet, AnyThreadMayReadAndPatch) {
  const auto patch = patch_between(*base_, *raised_);
  const Planet patched = base_->with(patch);
  const Planet planets[] = {base_, patched};
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      Random random(static_cast<std::uint64_t>(100 + t));
      for (int n = 0; n < 400; ++n) {
        const Planet& planet = planets[random.integer(0, 1)];
        const PlanetFile& same = planet == base_ ? *base_ : *raised_;
        const lod::TileInfo& tile = planet->tree().tiles()[static_cast<std::size_t>(
            random.integer(0, static_cast<int>(planet->tree().size()) - 1))];
        if (planet->heights(tile.key).posts.height_m != same.heights(tile.key).posts.height_m) ++wrong;
        if (tile.has_children && planet->mesh(tile.key, 0).height_q != same.mesh(tile.key, 0).height_q) ++wrong;
        if (n % 100 == 0 && base_->with(patch)->meta().identity != patched->meta().identity) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
