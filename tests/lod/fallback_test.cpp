#include "lod/fallback.h"

#include <set>

#include "mars/geodesy/sphere.h"
#include "paging/pager.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

namespace {

using lod::Selection;
using lod::TileInfo;
using lod::TileKey;
using lod::TileTree;
using test_support::Random;
namespace core = vpe::core;

const TileTree& tree() {
  static const TileTree tree = fake::tree(fake::rough(3, 8));
  return tree;
}

core::View random_view(Random& random) {
  core::View view;
  view.camera =
      mars::to_camera(mars::Pose{random.uniform(-180, 180), random.uniform(-90, 90),
                                 random.log_uniform(8000, 3 * fake::kRadius_m), random.uniform(-180, 180),
                                 random.uniform(-90, 10), random.uniform(-180, 180)},
                      fake::kRadius_m);
  view.fov_deg = random.uniform(20, 100);
  return view;
}

using Page = std::pair<TileKey, int>;
struct PageHash {
  std::size_t operator()(const Page& page) const {
    return lod::TileKeyHash()(page.first) + static_cast<std::size_t>(page.second);
  }
};
using Resident = std::set<Page>;

lod::IsResident is_resident(const Resident& resident) {
  return {[](const void* set, const TileInfo& tile, int variant) {
            return static_cast<const Resident*>(set)->count({tile.key, variant}) != 0;
          },
          &resident};
}

Selection selected(const core::View& view) {
  lod::SelectScratch scratch;
  Selection selection;
  lod::select({}, tree(), lod::select_view(view), scratch, selection);
  return selection;
}

lod::FallbackSelection substituted(const core::View& view, const Selection& selection,
                                   const Resident& resident) {
  lod::FallbackSelection out;
  lod::select_fallbacks({}, tree(), lod::select_view(view), selection, is_resident(resident), out);
  return out;
}

// Returns how much of a tile can be seen and is not covered by `drawn`, as a part of its Morton range.
std::int64_t uncovered(const core::View& view, const std::vector<lod::SelectedTile>& drawn,
                       TileTree::Index index, int levels_down = 2) {
  const TileKey& key = tree()[index].key;
  bool any_inside = false;
  for (const lod::SelectedTile& d : drawn) {
    if (lod::contains(d.key, key)) return 0;
    any_inside = any_inside || lod::contains(key, d.key);
  }
  if (!lod::may_be_seen({}, tree(), lod::select_view(view), index)) return 0;
  if (!any_inside && (levels_down == 0 || !tree()[index].has_children)) return lod::morton_extent(key.level);
  std::int64_t sum = 0;
  for (TileTree::Index c = 0; c < 4; ++c)
    sum += uncovered(view, drawn, tree().first_child(index) + c, levels_down - 1);
  return sum;
}

// Expects drawn tiles that are resident, disjoint and ascending, and that cover each selected tile: by one
// ancestor, or by several tiles inside, but for what cannot be seen.
void expect_cover(const core::View& view, const Selection& selection, const lod::FallbackSelection& s,
                  const Resident& resident) {
  const auto& drawn = s.drawn.tiles;
  std::int64_t end = 0;
  std::int64_t triangles = 0;
  for (const lod::SelectedTile& t : drawn) {
    ASSERT_EQ(resident.count({t.key, t.variant}), 1U) << to_string(t.key);
    ASSERT_GE(lod::morton_position(t.key), end) << to_string(t.key) << " overlaps";
    end = lod::morton_position(t.key) + lod::morton_extent(t.key.level);
    triangles += tree()[t.index].variants[static_cast<std::size_t>(t.variant)].triangles;
    ASSERT_EQ(tree()[t.index].key, t.key);
  }
  EXPECT_EQ(triangles, s.drawn.triangles);
  std::size_t as_selected = 0;
  for (const lod::SelectedTile& t : selection.tiles) {
    const std::int64_t begin = lod::morton_position(t.key);
    for (const lod::SelectedTile& d : drawn) {
      if (d.key == t.key && d.variant == t.variant) {
        ++as_selected;
        EXPECT_EQ(d.geometric_error_m, t.geometric_error_m);
        EXPECT_EQ(d.screen_space_error_px, t.screen_space_error_px);
        EXPECT_EQ(d.min_distance_m, t.min_distance_m);
      }
    }
    ASSERT_EQ(uncovered(view, drawn, t.index), 0) << to_string(t.key) << " at " << begin;
  }
  EXPECT_EQ(selection.tiles.size() - as_selected, s.missing.size());
  EXPECT_EQ(drawn.size() - as_selected, static_cast<std::size_t>(s.substituted));
}

Resident roots() {
  Resident resident;
  for (TileTree::Index root = 0; root < mars::kFaces; ++root) resident.insert({tree()[root].key, 0});
  return resident;
}

TEST(Fallback, AllResidentIsTheSelectionItself) {
  Random random(1);
  for (int n = 0; n < 20; ++n) {
    const core::View view = random_view(random);
    const Selection selection = selected(view);
    Resident resident;
    for (const lod::SelectedTile& t : selection.tiles) resident.insert({t.key, t.variant});
    const lod::FallbackSelection s = substituted(view, selection, resident);
    EXPECT_TRUE(s.missing.empty());
    EXPECT_EQ(s.substituted, 0);
    ASSERT_EQ(s.drawn.tiles.size(), selection.tiles.size());
    expect_cover(view, selection, s, resident);
  }
}

TEST(Fallback, OnlyRootsResidentDrawsRoots) {
  Random random(2);
  const core::View view = random_view(random);
  const Selection selection = selected(view);
  const lod::FallbackSelection s = substituted(view, selection, roots());
  for (const lod::SelectedTile& t : s.drawn.tiles) EXPECT_EQ(t.key.level, 0);
  expect_cover(view, selection, s, roots());
}

TEST(Fallback, NothingResidentIsReported) {
  Random random(3);
  const core::View view = random_view(random);
  const Selection selection = selected(view);
  const lod::FallbackSelection s = substituted(view, selection, {});
  EXPECT_TRUE(s.drawn.tiles.empty());
  EXPECT_EQ(static_cast<std::size_t>(s.uncovered), selection.tiles.size());
}

TEST(Fallback, CoversWithWhateverIsResident) {
  Random random(4);
  for (int n = 0; n < 150; ++n) {
    const core::View view = random_view(random);
    const Selection selection = selected(view);
    Resident resident = roots();
    const double share = random.uniform(0, 1);
    for (const TileInfo& tile : tree().tiles()) {
      for (int v = 0; v < static_cast<int>(tile.variants.size()); ++v) {
        if (random.uniform(0, 1) < share) resident.insert({tile.key, v});
      }
    }
    for (const lod::SelectedTile& t : selection.tiles) {
      if (random.uniform(0, 1) < 0.7) resident.insert({t.key, t.variant});
    }
    expect_cover(view, selection, substituted(view, selection, resident), resident);
    if (testing::Test::HasFatalFailure()) FAIL() << "view " << n;
  }
}

// Zooming out: the selected tile is not resident, but the tiles drawn before are.
TEST(Fallback, ChildrenReplaceTheirParent) {
  core::View view;
  view.camera = mars::to_camera(mars::Pose{10, 20, 3e6, 0, -90, 0}, fake::kRadius_m);
  const Selection selection = selected(view);
  const auto wanted = std::find_if(selection.tiles.begin(), selection.tiles.end(), [](const auto& t) {
    return tree()[t.index].has_children && t.key.level > 0;
  });
  ASSERT_NE(wanted, selection.tiles.end());
  Resident resident = roots();
  for (const lod::SelectedTile& t : selection.tiles) {
    if (t.key != wanted->key) resident.insert({t.key, t.variant});
  }
  for (int c = 0; c < 4; ++c) resident.insert({lod::child(wanted->key, c), 0});
  const lod::FallbackSelection s = substituted(view, selection, resident);
  expect_cover(view, selection, s, resident);
  EXPECT_EQ(s.substituted, 4);
  // Without one of the children the root replaces all.
  resident.erase({lod::child(wanted->key, 2), 0});
  const lod::FallbackSelection without = substituted(view, selection, resident);
  expect_cover(view, selection, without, resident);
  EXPECT_EQ(without.substituted, 1);
}

// Counted frames with a source that loads one page now and then, pages that are lost again, a camera that
// jumps: every frame covers its view, and at rest the selection itself is drawn in the end.
TEST(Fallback, FramesAreNeverWithoutCover) {
  Random random(5);
  using Pager = paging::Pager<Page, int, PageHash>;
  Pager pager([](const Page&) { return std::pair(0, std::size_t{1}); }, 0, 1000);
  Resident resident = roots();
  core::View view = random_view(random);
  const auto frame = [&](int loads) {
    for (int k = 0; k < loads; ++k) {
      for (const Pager::Loaded& page : pager.take(10)) resident.insert(page.key);
    }
    const Selection selection = selected(view);
    const lod::FallbackSelection s = substituted(view, selection, resident);
    expect_cover(view, selection, s, resident);
    std::vector<Pager::Want> wants;
    for (const std::size_t n : s.missing) {
      wants.push_back({{selection.tiles[n].key, selection.tiles[n].variant}, random.uniform(0, 1)});
    }
    pager.want(std::move(wants));
    return s.missing.size();
  };
  for (int n = 0; n < 200 && !testing::Test::HasFatalFailure(); ++n) {
    if (random.integer(0, 3) == 0) view = random_view(random);
    frame(random.integer(0, 20));
    if (random.integer(0, 20) == 0) {
      std::erase_if(resident, [&](const Page& p) { return p.first.level > 0 && random.integer(0, 2) == 0; });
    }
  }
  std::size_t missing = 1;
  for (int n = 0; n < 2000 && missing > 0; ++n) missing = frame(5);
  EXPECT_EQ(missing, 0U);
}

}  // namespace
