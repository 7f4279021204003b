#include "lod/tree/tree.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

namespace {

using lod::TileInfo;
using lod::TileKey;
using lod::TileTree;

TEST(Tree, HoldsEveryTileInOrderWhateverTheOrderGiven) {
  test_support::Random random(31);
  std::vector<TileInfo> tiles = fake::tiles(fake::rough(3, 6));
  const std::size_t count = tiles.size();
  std::shuffle(tiles.begin(), tiles.end(), random.engine());
  const std::vector<TileInfo> given = tiles;
  const TileTree tree(std::move(tiles), {7}, fake::kRadius_m);
  ASSERT_EQ(tree.size(), count);
  for (const TileInfo& tile : given) {
    const TileInfo* found = tree.find(tile.key);
    ASSERT_NE(found, nullptr) << lod::to_string(tile.key);
    EXPECT_EQ(found->key, tile.key);
    EXPECT_EQ(found->min_height_m, tile.min_height_m);
    EXPECT_EQ(found->variants.size(), tile.variants.size());
    EXPECT_EQ(&tree.deepest(tile.key), found);
  }
  for (TileTree::Index n = 0; n < tree.size(); ++n) {
    if (n < 6) {
      EXPECT_EQ(tree[n].key, (TileKey{static_cast<mars::Face>(n), 0, 0, 0}));
    }
    if (!tree[n].has_children) continue;
    for (int c = 0; c < 4; ++c) {
      EXPECT_EQ(tree[tree.first_child(n) + static_cast<TileTree::Index>(c)].key, lod::child(tree[n].key, c));
    }
  }
}

TEST(Tree, FindsNothingWhereNothingIs) {
  const TileTree tree = fake::tree(fake::uniform(2));
  EXPECT_EQ(tree.size(), 6U * (1 + 4 + 16));
  const TileKey below{mars::Face::kMinusY, 5, 17, 30};
  EXPECT_EQ(tree.find(below), nullptr);
  EXPECT_EQ(tree.deepest(below).key, lod::ancestor(below, 2));
  EXPECT_EQ(tree.find({mars::Face::kPlusX, 1, 2, 0}), nullptr);
  EXPECT_EQ(tree.find({static_cast<mars::Face>(7), 0, 0, 0}), nullptr);
}

// Returns the message with which a damaged list of tiles is refused.
template <typename Damage>
std::string refusal(const Damage& damage) {
  std::vector<TileInfo> tiles = fake::tiles(fake::uniform(2));
  damage(tiles);
  try {
    const TileTree tree(std::move(tiles), {7}, fake::kRadius_m);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TileInfo& at(std::vector<TileInfo>& tiles, const TileKey& key) {
  return *std::find_if(tiles.begin(), tiles.end(), [&](const TileInfo& t) { return t.key == key; });
}

const TileKey kFinest{mars::Face::kPlusY, 2, 1, 3};
const TileKey kInner{mars::Face::kPlusY, 1, 0, 1};

TEST(Tree, RefusesGapsAndStraysByName) {
  EXPECT_EQ(refusal([](auto&) {}), "accepted");
  EXPECT_EQ(refusal([](auto& t) { t.clear(); }), "tile +x/0/0/0: missing");
  EXPECT_EQ(refusal([](auto& t) { std::erase_if(t, [](const TileInfo& i) { return i.key == kFinest; }); }),
            "tile +y/2/1/3: missing");
  EXPECT_EQ(refusal([](auto& t) { std::erase_if(t, [](const TileInfo& i) { return i.key.level == 0; }); }),
            "tile +x/0/0/0: missing");
  EXPECT_EQ(refusal([](auto& t) { t.push_back(at(t, kFinest)); }), "tile +y/2/1/3: there twice");
  EXPECT_EQ(refusal([](auto& t) {
              t.push_back(t[0]);
              t.back().key = {mars::Face::kMinusZ, 0, 0, 0};
            }),
            "tile -z/0/0/0: there twice");
  EXPECT_EQ(refusal([](auto& t) {
              t.push_back(at(t, kFinest));
              t.back().key = lod::child(kFinest, 2);
            }),
            "tile +y/3/2/7: child of no tile that has children");
  EXPECT_EQ(refusal([](auto& t) {
              t.push_back(at(t, kFinest));
              t.back().key = {mars::Face::kPlusX, 3, 0, 9};
            }),
            "tile +x/3/0/9: no such tile");
  EXPECT_EQ(refusal([](auto& t) {
              at(t, kInner).has_children = false;
              at(t, kInner).variants.push_back({});
            }),
            "tile +y/2/0/2: child of no tile that has children");
}

TEST(Tree, RefusesErrorsAndHeightsThatDoNotNest) {
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).variants[0].terms.height_error_m = 1e6; }),
            "tile +y/2/1/3: error larger than its parent's");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).variants[0].terms.sagitta_m = 1e6; }),
            "tile +y/2/1/3: error larger than its parent's");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).variants[0].terms.total_m = 0; }), "accepted");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).variants[1].terms.total_m = 1; }),
            "tile +y/2/1/3: finest tile whose last mesh has an error");
  EXPECT_EQ(refusal([](auto& t) {
              auto& v = at(t, kFinest).variants;
              v.insert(v.begin(), v.back());
            }),
            "tile +y/2/1/3: error grows with finer meshes");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).variants.clear(); }), "tile +y/2/1/3: no mesh");
  EXPECT_EQ(refusal([](auto& t) { at(t, kInner).variants.push_back(at(t, kInner).variants[0]); }),
            "tile +y/1/0/1: more than one mesh above children");
  EXPECT_EQ(refusal([](auto& t) { at(t, kInner).variants[0].terms.height_error_m = std::nan(""); }),
            "tile +y/1/0/1: error not finite or negative");
  EXPECT_EQ(refusal([](auto& t) { at(t, kInner).variants[0].terms.sagitta_m = -1; }),
            "tile +y/1/0/1: error not finite or negative");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).max_height_m = 1; }),
            "tile +y/2/1/3: heights beyond its parent's");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).min_height_m = -1; }),
            "tile +y/2/1/3: heights beyond its parent's");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).min_height_m = 1; }),
            "tile +y/2/1/3: lowest height above the highest");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).max_height_m = std::nan(""); }),
            "tile +y/2/1/3: heights not finite");
  EXPECT_EQ(refusal([](auto& t) { at(t, kFinest).min_height_m = -fake::kRadius_m; }),
            "tile +y/2/1/3: lowest height below the planet's centre");
}

TEST(Tree, RefusesAPlanetWithoutRadius) {
  for (const double radius : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(TileTree(fake::tiles(fake::uniform(1)), {7}, radius), std::runtime_error);
  }
}

// Samples S over finest tiles, flat facets over random posts, at several exaggerations.
TEST(Tree, RegionsAndTheLowestRadiusContainTheFacets) {
  test_support::Random random(32);
  constexpr lod::TileShape kShape{2};
  fake::Planet planet = fake::rough(1, 3);
  const TileTree tree(fake::tiles(planet), kShape, fake::kRadius_m);
  for (TileTree::Index n = 0; n < tree.size(); ++n) {
    const TileInfo& tile = tree[n];
    if (tile.has_children) continue;
    for (const double exaggeration : {0.1, 1.0, 7.0}) {
      lod::Posts posts{tile.key, kShape.intervals(), {}};
      for (int k = 0; k < kShape.post_count(); ++k) {
        // Mostly the lowest: the facets sagitta most there.
        const double h = random.integer(0, 3) == 0 ? random.uniform(tile.min_height_m, tile.max_height_m)
                                                   : tile.min_height_m;
        posts.height_m.push_back(h);
      }
      const lod::GridLines lines = lod::grid_lines(tile.key, posts.intervals);
      const auto constrain = [&](double x) {
        for (const lod::Edge edge : lod::kEdges) {
          const TileKey beside = tree.deepest(lod::neighbour(tile.key, edge).key).key;
          if (beside.level + 1 == tile.key.level)
            lod::constrain_edge(posts, lines, edge, 2, fake::kRadius_m, x);
        }
      };
      // A file states the heights of posts as they are at exaggeration 1.
      constrain(1.0);
      const double low = *std::min_element(posts.height_m.begin(), posts.height_m.end());
      for (double& h : posts.height_m) h += tile.min_height_m + 1.0 - low;
      const double top = *std::max_element(posts.height_m.begin(), posts.height_m.end());
      constrain(exaggeration);
      for (double& h : posts.height_m) h *= exaggeration;
      for (int sample = 0; sample < 50; ++sample) {
        const double u = random.uniform(lines.u.front(), lines.u.back());
        const double v = random.uniform(lines.v.front(), lines.v.back());
        const double radius = fake::kRadius_m + lod::surface_height(posts, lines, u, v, fake::kRadius_m);
        ASSERT_GE(radius, tree.lowest_radius_m(exaggeration));
        for (int level = tile.key.level; level >= 0; --level) {
          const TileKey key = lod::ancestor(tile.key, level);
          const auto index = static_cast<TileTree::Index>(tree.find(key) - &tree[0]);
          const cull::BoundingRegion region = tree.region(index, exaggeration, 0.0);
          ASSERT_GE(radius, region.min_radius_m);
          if (top <= tile.max_height_m) {
            ASSERT_LE(radius, region.max_radius_m + 1e-8);
          }
          ASSERT_LE(region.rect.u0, u);
          ASSERT_GE(region.rect.v1, v);
        }
      }
    }
  }
  // Not lazily low: a uniform ball of cells 1/32 of a right angle has the sagitta by that chord, times at most
  // 2.8.
  const TileTree ball(fake::tiles(fake::uniform(3)), kShape, 1.0e6);
  const double half_diagonal = mars::kPi / 2 / 32 * std::sqrt(0.5);
  const double sagitta = 1.0e6 * (1 - std::cos(half_diagonal));
  EXPECT_LE(ball.lowest_radius_m(1.0), 1.0e6 - sagitta);
  EXPECT_GE(ball.lowest_radius_m(1.0), 1.0e6 - 2.8 * sagitta);
}

TEST(Tree, ABetterKnownLowestRadiusIsTakenAtExaggerationOne) {
  const double known = fake::kRadius_m - 1.0;
  const TileTree tree(fake::tiles(fake::uniform(1)), {7}, fake::kRadius_m, known);
  EXPECT_EQ(tree.lowest_radius_m(1.0), known);
  EXPECT_LT(tree.lowest_radius_m(2.0), known);
}

TEST(Tree, GroundThroughTheCentreLeavesNoNegativeRadius) {
  const TileTree tree = fake::tree(fake::rough(1, 2));
  EXPECT_EQ(tree.lowest_radius_m(1e6), 0.0);
  EXPECT_EQ(tree.region(0, 1e6, 0.0).min_radius_m, 0.0);
  EXPECT_EQ(tree.region(0, 1.0, 1e9).min_radius_m, 0.0);
}

TEST(Tree, ATileCostsAboutAHundredBytes) {
  const TileTree tree = fake::tree(fake::uniform(5));
  EXPECT_LE(tree.bytes(), 160 * tree.size());
  EXPECT_GE(tree.bytes(), 64 * tree.size());
}

}  // namespace
