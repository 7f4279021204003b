// The tiles that a planet file will have: an adaptive quadtree whose depth follows a wanted post spacing.
#pragma once

#include <functional>
#include <span>
#include <unordered_set>
#include <vector>

#include "lod/tree/posts.h"
#include "lod/tree/tile_key.h"

namespace paging {

// Returns the wanted post spacing of a tile in metres: the finest that is wanted anywhere in its cap.
using WantedSpacing = std::function<double(const lod::TileKey&, const mars::Cap&)>;

// Limits guard against a spacing typed wrong: larger values allow trees that exceed memory and disk.
struct PlanLimits {
  int max_level = 20;
  std::size_t max_leaves = 4'000'000;
};

// Holds a restricted quadtree: every inner tile has its four children, and finest tiles that share an edge
// differ by at most one level, so that the spacing of the reference surface changes by a factor of two at
// most.
//
// Typical usage:
//   const BuildPlan plan(meta.tile, meta.radius_m, wanted_elevation(options, source));
//   for (const lod::TileKey& key : plan.leaves()) sample(key, plan.edge_step(key, lod::Edge::kWest));
class BuildPlan {
 public:
  // Throws std::runtime_error when the tree would exceed the limits; the message names the spacing that is too
  // fine.
  BuildPlan(const lod::TileShape& shape, double radius_m, const WantedSpacing& wanted,
            const PlanLimits& limits = {});

  // Makes the tree that has these finest tiles, in any order. Throws std::runtime_error when they do not cover
  // each place of the planet exactly once.
  explicit BuildPlan(std::vector<lod::TileKey> leaves);

  // Makes the tree of another one in which these tiles have children, and all that then must have them too.
  BuildPlan(const BuildPlan& coarser, std::span<const lod::TileKey> divided);

  const std::vector<lod::TileKey>& leaves() const { return leaves_; }  // face by face, in Morton order
  const std::vector<lod::TileKey>& inner() const { return inner_; }    // deepest first, else as leaves()

  bool is_inner(const lod::TileKey& key) const { return inner_set_.contains(key); }
  bool exists(const lod::TileKey& key) const { return key.level == 0 || is_inner(lod::parent(key)); }
  bool is_leaf(const lod::TileKey& key) const { return exists(key) && !is_inner(key); }

  // Returns the level of the finest tile at a chart point (see lod::tile_at for points on borders).
  int leaf_level(const mars::ChartPoint& point) const;

  // Return the coarsest level among the finest tiles that touch a corner of a tile, or a chart point of a face
  // that lies on a post. The post is sampled at the spacing of this level, whichever tile needs it.
  int coarsest_level_at_corner(const lod::TileKey& key, bool east, bool north) const;
  int coarsest_level_at(mars::Face face, double u, double v) const;

  // Returns by how many levels the finest tile across an edge of a leaf is coarser: 0 or 1 (0 also when it is
  // finer).
  int edge_step(const lod::TileKey& leaf, lod::Edge edge) const;

 private:
  void split(const lod::TileKey& key);
  void balance();
  void sort();
  int coarsest_level_about(mars::Face face, double u, double v, double du, double dv) const;

  std::unordered_set<lod::TileKey, lod::TileKeyHash> inner_set_;
  std::vector<lod::TileKey> pending_;  // inner tiles whose neighbours are still to be checked
  std::vector<lod::TileKey> leaves_;
  std::vector<lod::TileKey> inner_;
  int finest_level_ = 0;
};

// Orders tiles by face, then in Morton order; an inner tile comes before the tiles below it.
bool morton_less(const lod::TileKey& a, const lod::TileKey& b);

}  // namespace paging
