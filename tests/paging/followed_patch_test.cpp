// Planets that follow each other, as in an animation: numbers stay where content stays, and one number never names two pages.
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "paging/shading/terrain_shader.h"
#include "tests/paging/patch_between.h"
#include "vpe/core/appearance/settings.h"

namespace {

using paging::MadeOf;
using paging::PlanetFile;
using paging::ShadingParams;
using paging::TerrainShader;
using paging::TilePatch;
using test_support::build_changed;
using test_support::kPatched;
using test_support::kPatchedReach_rad;
using test_support::patch_between;
using test_support::PlanetChange;
using test_support::Random;
using Planet = std::shared_ptr<const PlanetFile>;
using Patch = std::shared_ptr<const TilePatch>;

constexpr std::size_t kBudget = std::size_t{64} << 20;

ShadingParams lit(bool shadows) {
  vpe::core::Appearance appearance;
  appearance.mode = vpe::core::Mode::kTextured;
  appearance.shadows = shadows;
  // Low, so that raised ground darkens tiles beside it.
  const glm::dvec3 across = glm::normalize(glm::dvec3(1, -1, 0) - kPatched * glm::dot(kPatched, {1, -1, 0}));
  return paging::shading_params(appearance, glm::normalize(across + 0.05 * kPatched), true, nullptr);
}

// The planets are read alone, and made once.
class FollowedPatch : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    states_ = std::make_unique<States>();
    States& s = *states_;
    s.base = build_changed(s.dir / "base.vpe", {.has_image = true});
    const glm::dvec3 beside = glm::normalize(kPatched + glm::dvec3(0, 2 * kPatchedReach_rad, 0));
    int n = 0;
    for (
        const PlanetChange& change :
        {PlanetChange{.raised_m = 900, .is_finer = true}, PlanetChange{.raised_m = 700, .is_finer = true},
         PlanetChange{.raised_m = -500}, PlanetChange{.has_nodata = true},
         PlanetChange{.raised_m = 900, .is_painted = true},
         PlanetChange{.tower = mars::Cap{beside, 0.2 * kPatchedReach_rad}},
         // The second and the last together: from it to the second, tiles are the file's again beside tiles that stay.
         PlanetChange{
             .raised_m = 700, .is_finer = true, .tower = mars::Cap{beside, 0.2 * kPatchedReach_rad}}}) {
      PlanetChange all = change;
      all.has_image = true;
      s.patches.push_back(patch_between(*s.base, *build_changed(s.dir / (std::to_string(n++) + ".vpe"), all)));
    }
  }
  static void TearDownTestSuite() { states_.reset(); }

  static const paging::PatchTile* find(const TilePatch& patch, std::int64_t row) {
    const auto at =
        std::ranges::find_if(patch.tiles, [&](const paging::PatchTile& tile) { return tile.row.key == row; });
    return at == patch.tiles.end() ? nullptr : &*at;
  }

  struct States {
    test_support::TempDir dir;
    Planet base;
    std::vector<Patch> patches;
  };
  static std::unique_ptr<States> states_;
  const Planet& base_ = states_->base;
  const std::vector<Patch>& patches_ = states_->patches;
};
std::unique_ptr<FollowedPatch::States> FollowedPatch::states_;

TEST_F(FollowedPatch, KeepsTheNumbersOfTilesThatStayTheSame) {
  const Planet first = base_->with(patches_[0]);
  const Planet second = base_->with(patches_[1], first);
  int kept = 0;
  int changed = 0;
  for (const lod::TileInfo& tile : second->tree().tiles()) {
    SCOPED_TRACE(lod::to_string(tile.key));
    const paging::PatchTile* before = find(*patches_[0], lod::pack(tile.key));
    const paging::PatchTile* after = find(*patches_[1], lod::pack(tile.key));
    const bool is_same = before == after ||
                         (before != nullptr && after != nullptr && test_support::same_stored(*before, *after));
    EXPECT_EQ(second->version(tile.key), is_same ? first->version(tile.key) : second->version());
    kept += after != nullptr && is_same ? 1 : 0;
    changed += is_same ? 0 : 1;
  }
  EXPECT_GT(kept, 0) << "the patches shall have equal tiles";
  EXPECT_GT(changed, 10);
}

TEST_F(FollowedPatch, TheSamePatchAgainChangesNothing) {
  const Planet first = base_->with(patches_[4]);
  const Planet again = base_->with(std::make_shared<TilePatch>(*patches_[4]), first);
  EXPECT_GT(again->version(), first->version());
  for (const lod::TileInfo& tile : again->tree().tiles()) {
    for (const MadeOf made_of : {MadeOf::kTile, MadeOf::kBorders, MadeOf::kArea})
      EXPECT_EQ(again->version(tile.key, made_of), first->version(tile.key, made_of));
    EXPECT_EQ(again->shadow_version(tile.key, 1), first->shadow_version(tile.key, 1));
  }
  for (const lod::TileKey& key : again->image_keys())
    EXPECT_EQ(again->version(key, MadeOf::kImage), first->version(key, MadeOf::kImage));
}

TEST_F(FollowedPatch, TilesThatAreTheFilesAgainHaveChanged) {
  const Planet towered = base_->with(patches_[5]);
  const Planet holed = base_->with(patches_[3], towered);
  int returned = 0;
  for (const paging::PatchTile& tile : patches_[5]->tiles) {
    const lod::TileKey key = *lod::unpack(tile.row.key);
    if (find(*patches_[3], tile.row.key) != nullptr) continue;
    ++returned;
    EXPECT_EQ(holed->version(key), holed->version());
    EXPECT_EQ(holed->heights(key).posts.height_m, base_->heights(key).posts.height_m);
    // And stay so.
    EXPECT_EQ(base_->with(patches_[3], holed)->version(key), holed->version());
  }
  EXPECT_GT(returned, 3);
}

TEST_F(FollowedPatch, PlanetsOfOtherFilesShareNoNumbers) {
  const Planet other = PlanetFile::open(base_->path());
  const Planet first = other->with(patches_[0]);
  const Planet second = base_->with(patches_[0], first);
  const Planet compared = base_->with(patches_[0])->compared_with(base_);
  const Planet third = base_->with(patches_[0], compared);
  const Planet fourth = base_->with(patches_[0], base_);
  for (const paging::PatchTile& tile : patches_[0]->tiles)
    for (const Planet& planet : {second, third, fourth})
      EXPECT_EQ(planet->version(*lod::unpack(tile.row.key)), planet->version());
}

TEST_F(FollowedPatch, TellsWhatAPatchHasChanged) {
  const Planet patched = base_->with(patches_[0]);
  const lod::TileKey far =
      patched->tree().deepest(lod::tile_at(mars::chart_point(-kPatched), lod::kMaxLevel)).key;
  const lod::TileKey near =
      patched->tree().deepest(lod::tile_at(mars::chart_point(kPatched), lod::kMaxLevel)).key;
  for (const MadeOf made_of : {MadeOf::kTile, MadeOf::kBorders, MadeOf::kArea}) {
    EXPECT_FALSE(patched->is_patched(far, made_of));
    EXPECT_TRUE(patched->is_patched(near, made_of));
    EXPECT_FALSE(base_->is_patched(near, made_of));
  }
}

// A tile beside a coarse one changes the texture of that only if it lies at their border.
TEST_F(FollowedPatch, TexturesChangeAcrossABorderAlone) {
  // One tile, within one two levels above it.
  const auto tiles = base_->tree().tiles();
  const auto alone = std::ranges::find_if(tiles, [&](const lod::TileInfo& tile) {
    return tile.key.level == base_->meta().finest_level && (tile.key.i + 1) % 4 > 1 && (tile.key.j + 1) % 4 > 1;
  });
  ASSERT_NE(alone, tiles.end());
  auto patch = std::make_shared<TilePatch>();
  patch->meta = base_->meta();
  patch->tiles.push_back(test_support::read_stored(*base_).tiles.at(lod::pack(alone->key)));
  const Planet patched = base_->with(patch);
  int inside = 0;
  for (const lod::TileInfo& tile : tiles) {
    bool is_changed = lod::contains(tile.key, alone->key);
    bool is_beside = false;
    for (const lod::Edge edge : lod::kEdges) {
      const lod::Neighbour next = lod::neighbour(tile.key, edge);
      is_changed = is_changed || alone->key == patched->tree().deepest(next.key).key;
      if (!lod::contains(next.key, alone->key)) continue;
      is_beside = true;
      // At the border the next tile is outside.
      is_changed = is_changed || !lod::contains(next.key, lod::neighbour(alone->key, next.edge).key);
    }
    EXPECT_EQ(patched->is_patched(tile.key, MadeOf::kArea), is_changed) << lod::to_string(tile.key);
    inside += is_beside && !is_changed ? 1 : 0;
  }
  EXPECT_GT(inside, 0) << "some tile shall lie beside one that changes inside alone";
}

// Planets that follow one another in any order: pages of one tile and one number are equal to the bit.
TEST_F(FollowedPatch, OneNumberNamesOnePage) {
  using Page = std::tuple<lod::TileKey, int, std::uint64_t>;  // a tile, what is made of it, its number
  std::map<Page, std::vector<std::uint8_t>> pages;
  int found_again = 0;
  const auto check = [&](const lod::TileKey& key, int kind, std::uint64_t version,
                         std::vector<std::uint8_t> content) {
    const auto [at, is_new] = pages.try_emplace({key, kind, version}, content);
    found_again += is_new ? 0 : 1;
    EXPECT_TRUE(at->second == content) << lod::to_string(key) << ", kind " << kind << ", number " << version;
  };
  const auto bytes_of = [](const auto& values) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
    return std::vector<std::uint8_t>(first, first + values.size() * sizeof(values[0]));
  };
  Random random(7);
  std::vector<Planet> planets{base_};
  for (const std::size_t state : {0U, 6U, 1U, 6U, 5U, 3U, 4U}) {
    // Mostly the last one, as in an animation.
    const std::size_t last = planets.size() - 1;
    const std::size_t former =
        last % 4 == 3 ? static_cast<std::size_t>(random.integer(0, static_cast<int>(last))) : last;
    planets.push_back(base_->with(patches_[state], planets[former]));
  }
  for (const Planet& planet : planets) {
    const TerrainShader shader(planet, kBudget);
    const int n = planet->meta().tile.intervals();
    for (const lod::TileInfo& tile : planet->tree().tiles()) {
      const lod::TileKey& key = tile.key;
      if (glm::length(lod::bounding_cap(key).centre - kPatched) > 0.2 + lod::bounding_cap(key).radius_rad)
        continue;
      const paging::TileHeights heights = planet->heights(key);
      std::vector<std::uint8_t> content = bytes_of(heights.posts.height_m);
      content.push_back(static_cast<std::uint8_t>(heights.coarser_neighbour_mask));
      content.push_back(tile.has_children ? 1 : 0);
      content.push_back(static_cast<std::uint8_t>(tile.variants.size()));
      check(key, 0, planet->version(key), content);
      int kind = 1;
      for (const ShadingParams& params : {lit(false), lit(true)}) {
        check(key, kind++, paging::shading_version(*planet, key, MadeOf::kBorders, params),
              bytes_of(shader.normals(key, params)->posts));
        check(key, kind++, paging::shading_version(*planet, key, MadeOf::kBorders, params),
              bytes_of(shader.normals(key, params)->sees_sun));
        check(key, kind++, paging::shading_version(*planet, key, MadeOf::kArea, params),
              shader.shade(key, 2 * n, params).texels);
      }
    }
  }
  EXPECT_GT(found_again, 1000);
}

// A shader that keeps textures and goes over from planet to planet makes the texels of a new one.
TEST_F(FollowedPatch, TexturesThatAreMadeAgainInPartAreThoseOfANewShader) {
  for (const bool shadows : {false, true}) {
    const ShadingParams params = lit(shadows);
    TerrainShader keeps(base_, kBudget, {.textures = 1});
    Planet planet = base_;
    for (int step = 0; step < 6; ++step) {
      planet = base_->with(patches_[static_cast<std::size_t>(step) % patches_.size()], planet);
      keeps.change_planet(planet, kBudget);
      const TerrainShader fresh(planet, kBudget);
      const int n = planet->meta().tile.intervals();
      int textures = 0;
      for (const lod::TileInfo& tile : planet->tree().tiles()) {
        if (!planet->is_patched(tile.key, MadeOf::kArea)) continue;
        const int intervals = n << std::min(2, planet->meta().finest_level - tile.key.level + 1);
        const paging::ShadedTile a = keeps.shade(tile.key, intervals, params);
        const paging::ShadedTile b = fresh.shade(tile.key, intervals, params);
        ++textures;
        EXPECT_TRUE(a.texels == b.texels) << lod::to_string(tile.key) << ", step " << step;
        EXPECT_EQ(a.nodata, b.nodata);
        EXPECT_EQ(a.channels, b.channels);
        EXPECT_EQ(a.brightest, b.brightest);
        EXPECT_EQ(a.nodata_image, b.nodata_image);
      }
      EXPECT_GT(textures, 20);
    }
  }
}

TEST_F(FollowedPatch, TexturesAreMadeAgainInPart) {
  std::map<std::int64_t, int> reads;
  const Planet base =
      PlanetFile::open(base_->path(), [&](const lod::TileKey& key) { ++reads[lod::pack(key)]; });
  const ShadingParams params = lit(false);
  // No room for inputs, so that each block reads its own.
  TerrainShader keeps(base, 1 << 12, {.textures = 10000});
  const lod::TileKey root = lod::ancestor(lod::tile_at(mars::chart_point(kPatched), lod::kMaxLevel), 0);
  const int intervals = 16 * base->meta().tile.intervals();
  const Planet first = base->with(patches_[0]);
  keeps.change_planet(first, 1 << 12);
  reads.clear();
  keeps.shade(root, intervals, params);
  const std::size_t at_first = reads.size();
  const Planet second = base->with(patches_[1], first);
  keeps.change_planet(second, 1 << 12);
  reads.clear();
  EXPECT_TRUE(keeps.shade(root, intervals, params).texels ==
              TerrainShader(base_->with(patches_[1]), kBudget).shade(root, intervals, params).texels);
  EXPECT_GT(reads.size(), 0U);
  EXPECT_LT(reads.size(), at_first / 2);
  EXPECT_GT(keeps.bytes_resident(), std::size_t{1} << 12);
}

}  // namespace
