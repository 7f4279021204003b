// Decoded tiles of all rasters share one budget.
#include "mars/raster/raster_memory.h"

#include <gtest/gtest.h>

#include "mars/raster/gdal_tiles.h"

namespace {

using mars::TileId;
using mars::TileStore;

TileStore::Pointer some(int value) { return std::make_shared<const int>(value); }

TEST(RasterMemory, UnusedTilesMakeRoomForOthers) {
  TileStore store(10'000);
  for (int n = 0; n < 9; ++n) store.insert({1, {0, n, 0}}, some(n), 800);
  EXPECT_LE(store.bytes(), 10'000u);
  EXPECT_NE(store.find({1, {0, 0, 0}}), nullptr);  // used: stays longer than its neighbours
  for (int n = 0; n < 9; ++n) {
    store.insert({2, {0, n, 0}}, some(n), 800);
    EXPECT_LE(store.bytes(), 10'000u);
    EXPECT_NE(store.find({1, {0, 0, 0}}), nullptr);  // used again and again
  }
  for (int n = 1; n < 9; ++n) EXPECT_EQ(store.find({1, {0, n, 0}}), nullptr) << n;
  EXPECT_NE(store.find({2, {0, 8, 0}}), nullptr);
}

TEST(RasterMemory, TheFirstOfTwoWinsAndTheNewestStays) {
  TileStore store(1000);
  const TileStore::Key key{7, {3, 2, 1}};
  const auto first = store.insert(key, some(1), 100);
  EXPECT_EQ(store.insert(key, some(2), 100), first);
  store.insert({7, {3, 2, 2}}, some(3), 50'000);
  EXPECT_NE(store.find({7, {3, 2, 2}}), nullptr);
  EXPECT_EQ(store.find(key), nullptr);
  store.set_limit(1);
  store.insert(key, some(4), 10);
  EXPECT_EQ(store.find({7, {3, 2, 2}}), nullptr);
  store.forget(7);
  EXPECT_EQ(store.bytes(), 0u);
}

TEST(RasterMemory, AClosedRasterLeavesNothing) {
  struct Tile {
    std::size_t bytes() const { return 1000; }
  };
  const std::size_t before = TileStore::common().bytes();
  {
    mars::TileCache<Tile> cache;
    const auto tile = cache.get({0, 1, 2}, [](const TileId&) { return std::make_shared<const Tile>(); });
    EXPECT_EQ(cache.get({0, 1, 2}, [](const TileId&) { return std::make_shared<const Tile>(); }), tile);
    EXPECT_GT(TileStore::common().bytes(), before);
  }
  EXPECT_EQ(TileStore::common().bytes(), before);
}

// Caches of different types of tiles must never return each other's.
TEST(RasterMemory, EveryCacheHasItsOwnTiles) {
  struct Heights {
    int value;
    std::size_t bytes() const { return 1000; }
  };
  struct Colours {
    int value;
    std::size_t bytes() const { return 1000; }
  };
  mars::TileCache<Heights> heights;
  mars::TileCache<Colours> colours;
  mars::TileCache<Heights> others;
  for (int round = 0; round < 2; ++round) {
    const auto make = [](int value) {
      return [value](const TileId&) { return std::make_shared<const Heights>(Heights{value}); };
    };
    const auto paint = [](const TileId&) { return std::make_shared<const Colours>(Colours{2}); };
    EXPECT_EQ(heights.get({0, 0, 0}, make(1))->value, 1);
    EXPECT_EQ(colours.get({0, 0, 0}, paint)->value, 2);
    EXPECT_EQ(others.get({0, 0, 0}, make(3))->value, 3);
  }
}

}  // namespace
