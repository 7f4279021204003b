// Patches that are no patches of a planet are refused, with what is wrong and what to do.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/paging/patch_between.h"

namespace {

using paging::PatchTile;
using paging::PlanetError;
using paging::PlanetFile;
using paging::TilePatch;
using test_support::build_changed;
using test_support::patch_between;
using test_support::TempDir;
using Planet = std::shared_ptr<const PlanetFile>;

class WrongPatch : public testing::Test {
 protected:
  TempDir dir_;
  Planet base_ = build_changed(dir_ / "base.vpe", {});
};

// Each entry spoils a good patch; the message must have the words.
TEST_F(WrongPatch, IsRefused) {
  const auto good =
      patch_between(*base_, *build_changed(dir_ / "raised.vpe", {.raised_m = 900, .is_finer = true}));
  const auto inner_made_finest = [](PatchTile& tile) {
    tile.row.inner = false;
    tile.row.posts_terms.reset();
    tile.row.variants.push_back({});
  };
  const auto tile_of = [&](const auto& condition) {
    const auto at = std::ranges::find_if(good->tiles, condition);
    EXPECT_NE(at, good->tiles.end());
    return static_cast<std::size_t>(at - good->tiles.begin());
  };
  const auto is_new = [&](const PatchTile& t) {
    return base_->tree().find(*lod::unpack(t.row.key)) == nullptr;
  };
  const std::size_t fresh = tile_of(is_new);
  const std::size_t inner = tile_of([](const PatchTile& t) { return t.row.inner && t.row.key != 0; });
  const std::size_t leaf = tile_of([&](const PatchTile& t) { return !t.row.inner && !is_new(t); });
  struct Case {
    std::string words;
    std::function<void(TilePatch&)> spoil;
  };
  const std::vector<Case> cases{
      {"missing", [&](TilePatch& p) { p.tiles.erase(p.tiles.begin() + static_cast<std::ptrdiff_t>(fresh)); }},
      {"child of no tile",
       [&](TilePatch& p) {
         std::erase_if(p.tiles, [&](const PatchTile& t) {
           return t.row.key == lod::pack(lod::parent(*lod::unpack(good->tiles[fresh].row.key)));
         });
       }},
      {"there twice", [&](TilePatch& p) { p.tiles.push_back(p.tiles[leaf]); }},
      {"a finest tile in place of one with children", [&](TilePatch& p) { inner_made_finest(p.tiles[inner]); }},
      {"no tile has", [&](TilePatch& p) { p.tiles[leaf].row.key = -3; }},
      {"larger than its parent's",
       [&](TilePatch& p) {
         for (lod::MeshVariant& v : p.tiles[fresh].row.variants) v.terms.total_m = v.terms.height_error_m = 1e6;
         p.tiles[fresh].row.variants.back().terms = {};
       }},
      {"not finite", [&](TilePatch& p) { p.tiles[leaf].row.max_m = std::numeric_limits<double>::quiet_NaN(); }},
      {"beyond its parent's", [&](TilePatch& p) { p.tiles[fresh].row.max_m += 1e5; }},
      {"heights",
       [&](TilePatch& p) {
         p.tiles[leaf].payload.heights = paging::encode_heights(std::vector<std::int32_t>(81), 9);
       }},
      {"",
       [&](TilePatch& p) { p.tiles[leaf].payload.heights.resize(p.tiles[leaf].payload.heights.size() / 2); }},
      {"", [&](TilePatch& p) { p.tiles[leaf].payload.heights.clear(); }},
      {"", [&](TilePatch& p) { p.tiles[leaf].payload.nodata = paging::encode_mask(std::vector<bool>(80)); }},
      {"",
       [&](TilePatch& p) {
         p.tiles[leaf].payload.origin = paging::encode_numbers(std::vector<std::uint16_t>(7));
       }},
      {"meshes instead of", [&](TilePatch& p) { p.tiles[leaf].payload.meshes.pop_back(); }},
      {"", [&](TilePatch& p) { std::swap(p.tiles[leaf].payload.meshes[0], p.tiles[inner].payload.meshes[0]); }},
      {"number of triangles", [&](TilePatch& p) { ++p.tiles[inner].row.variants[0].triangles; }},
      {"list of sources", [&](TilePatch& p) { p.tiles[leaf].row.sources = "7"; }},
      {"list of sources", [&](TilePatch& p) { p.tiles[leaf].row.sources = "0,x"; }},
      {"resampling error of no source",
       [&](TilePatch& p) {
         p.tiles[leaf].resampling = {{9, {}}};
       }},
      {"edges", [&](TilePatch& p) { p.tiles[leaf].row.coarser_neighbour_mask = 16; }},
      {"tiles, and there are", [&](TilePatch& p) { ++p.meta.tiles; }},
      {"image tiles, and there are", [&](TilePatch& p) { ++p.meta.image_tiles; }},
      {"leaf_tiles", [&](TilePatch& p) { --p.meta.leaf_tiles; }},
      {"finest_level", [&](TilePatch& p) { ++p.meta.finest_level; }},
      {"lowest_radius_m", [&](TilePatch& p) { p.meta.lowest_radius_m += 1e5; }},
      {"highest_radius_m", [&](TilePatch& p) { p.meta.highest_radius_m -= 1e5; }},
      {"not finite", [&](TilePatch& p) { p.meta.highest_radius_m = std::numeric_limits<double>::infinity(); }},
      {"another body", [&](TilePatch& p) { p.meta.radius_m *= 2; }},
      {"another body", [&](TilePatch& p) { p.meta.body = "Moon"; }},
      {"shape or quantum", [&](TilePatch& p) { p.meta.quantum_m /= 2; }},
      {"shape or quantum", [&](TilePatch& p) { p.meta.tile.k = 5; }},
      {"lacks sources", [&](TilePatch& p) { p.meta.sources.clear(); }},
      {"part of a planet", [&](TilePatch& p) { p.meta.shard.emplace(); }},
      {"JPEG",
       [&](TilePatch& p) {
         p.images.push_back({0, {1, 2, 3}});
       }},
  };
  for (const Case& c : cases) {
    TilePatch spoilt = *good;
    c.spoil(spoilt);
    SCOPED_TRACE(&c - cases.data());
    try {
      base_->with(std::make_shared<const TilePatch>(std::move(spoilt)));
      ADD_FAILURE() << "not refused: " << c.words;
    } catch (const PlanetError& e) {
      const std::string what = e.what();
      EXPECT_NE(what.find(c.words), std::string::npos) << what;
      EXPECT_EQ(what.find(base_->path()), 0U) << what;
      EXPECT_NE(what.find("make the patch again"), std::string::npos) << what;
    }
  }
  EXPECT_THROW(base_->with(nullptr), PlanetError);
  EXPECT_NO_THROW(base_->with(good));
}

TEST_F(WrongPatch, HasImagesWithoutParents) {
  const Planet base = build_changed(dir_ / "a.vpe", {.has_image = true});
  const Planet painted = build_changed(dir_ / "b.vpe", {.has_image = true, .is_painted = true});
  const auto good = patch_between(*base, *painted);
  const auto refused = [&](const Planet& planet, TilePatch patch) {
    try {
      planet->with(std::make_shared<const TilePatch>(std::move(patch)));
    } catch (const PlanetError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(base, *good), "");
  TilePatch twice = *good;
  twice.images.push_back(twice.images.front());
  EXPECT_NE(refused(base, twice).find("twice"), std::string::npos);
  // The planet without an image has no parents for them.
  TilePatch alone = *patch_between(*base_, *base_);
  alone.images = good->images;
  std::erase_if(alone.images, [](const auto& image) { return lod::unpack(image.key)->level == 0; });
  EXPECT_NE(refused(base_, alone).find("image of its parent"), std::string::npos) << refused(base_, alone);
}

}  // namespace
