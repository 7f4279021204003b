// Sources of a patched planet: tiles that the patch leaves name them by their numbers in the whole.
#include <gtest/gtest.h>

#include "paging/surface/query.h"
#include "tests/paging/patch_between.h"

namespace {

using paging::PlanetError;
using paging::TilePatch;
using test_support::build_changed;
using Planet = std::shared_ptr<const paging::PlanetFile>;

class PatchedSources : public testing::Test {
 protected:
  // Returns a patch that puts a source before those of a planet, and changes nothing else.
  static std::shared_ptr<TilePatch> source_before(const paging::PlanetFile& planet) {
    auto patch = std::make_shared<TilePatch>();
    patch->meta = planet.meta();
    patch->meta.sources.insert(patch->meta.sources.begin(), planet.meta().sources.front());
    patch->meta.sources.front().name = "new";
    for (int n = 0; n < static_cast<int>(planet.meta().sources.size()); ++n)
      patch->source_numbers.push_back(n + 1);
    return patch;
  }

  test_support::TempDir dir_;
  Planet base_ = build_changed(dir_ / "base.vpe", {});
};

TEST_F(PatchedSources, HaveTheNumbersOfTheWhole) {
  const lod::TileKey tile =
      base_->tree().deepest(lod::tile_at(mars::chart_point({1, 0.1, 0.2}), lod::kMaxLevel)).key;
  ASSERT_EQ(base_->heights(tile).source, std::vector<int>{0});
  ASSERT_FALSE(base_->sources(tile).resampling.empty());
  const Planet once = base_->with(source_before(*base_));
  EXPECT_EQ(once->heights(tile).source, std::vector<int>{1});
  EXPECT_EQ(once->sources(tile).of_tile, std::vector<int>{1});
  EXPECT_EQ(once->sources(tile).resampling.front().source, 1);
  EXPECT_EQ(once->version(tile), base_->version()) << "the tile's pages shall stay";
  EXPECT_NE(once->meta().identity, base_->meta().identity);

  // A tile of a patch is numbered anew by the next one, too.
  auto of_new_source = std::make_shared<TilePatch>();
  of_new_source->meta = once->meta();
  of_new_source->tiles.push_back(test_support::read_stored(*base_).tiles.at(lod::pack(tile)));
  ASSERT_EQ(of_new_source->tiles.front().row.sources, "0");
  const Planet patched = once->with(of_new_source);
  EXPECT_EQ(patched->heights(tile).source, std::vector<int>{0});
  const Planet twice = patched->with(source_before(*patched));
  const lod::TileKey other =
      base_->tree().deepest(lod::tile_at(mars::chart_point({-1, 0.1, 0.2}), lod::kMaxLevel)).key;
  EXPECT_EQ(twice->heights(tile).source, std::vector<int>{1});
  EXPECT_EQ(twice->heights(other).source, std::vector<int>{2});
  EXPECT_EQ(twice->sources(other).of_tile, std::vector<int>{2});

  // Also where the surface has asked before.
  paging::Surface surface(base_, std::size_t{8} << 20);
  const mars::LonLat place = mars::lon_lat({-1, 0.1, 0.2});
  EXPECT_EQ(query(surface, place).source, 0);
  surface.change_planet(twice);
  EXPECT_EQ(query(surface, place).source, 2);
}

TEST_F(PatchedSources, NeedANumberEach) {
  const auto good = source_before(*base_);
  EXPECT_NO_THROW(base_->with(good));
  const Planet two = base_->with(good);
  for (const std::vector<int>& numbers : {std::vector<int>{2}, {-1}, {0, 1}}) {
    TilePatch wrong = *good;
    wrong.source_numbers = numbers;
    EXPECT_THROW(base_->with(std::make_shared<const TilePatch>(wrong)), PlanetError);
  }
  TilePatch turned = *source_before(*two);
  for (const std::vector<int>& numbers : {std::vector<int>{2, 1}, {1, 1}, {1}}) {
    turned.source_numbers = numbers;
    EXPECT_THROW(two->with(std::make_shared<const TilePatch>(turned)), PlanetError);
  }
}

}  // namespace
