// Which tiles a planet file will have: an adaptive quadtree whose depth follows a wanted post spacing.
#pragma once

#include <functional>
#include <unordered_set>
#include <vector>

#include "lod/tree/posts.h"
#include "lod/tree/tile_key.h"

namespace paging {

// Wanted post spacing in metres for a tile (the finest wanted anywhere in its cap).
using WantedSpacing = std::function<double(const lod::TileKey&, const mars::Cap&)>;

struct PlanLimits {
  int max_level = 20;
  std::size_t max_leaves = 4'000'000;
};

// A restricted quadtree: every inner tile has its four children, and finest tiles that share an edge differ by
// at most one level, so that S changes its spacing by steps of two.
class BuildPlan {
 public:
  // Throws std::runtime_error when the tree would pass the limits; names the spacing that asks for it.
  BuildPlan(const lod::TileShape& shape, double radius_m, const WantedSpacing& wanted,
            const PlanLimits& limits = {});

  // The tree that has these finest tiles, in any order. Throws std::runtime_error when they do not cover the
  // planet, each place once.
  explicit BuildPlan(std::vector<lod::TileKey> leaves);

  const std::vector<lod::TileKey>& leaves() const { return leaves_; }  // along the Morton curve, face by face
  const std::vector<lod::TileKey>& inner() const { return inner_; }    // deepest first, else as leaves()

  bool is_inner(const lod::TileKey& key) const { return inner_set_.contains(key); }
  bool exists(const lod::TileKey& key) const { return key.level == 0 || is_inner(lod::parent(key)); }
  bool is_leaf(const lod::TileKey& key) const { return exists(key) && !is_inner(key); }

  // Level of the finest tile at a chart point (see lod::tile_at for points on borders).
  int leaf_level(const mars::ChartPoint& point) const;

  // Coarsest level among the finest tiles that touch a corner of a tile, or a chart point of a face that lies
  // on a post: the spacing at which the post is sampled, whichever tile asks.
  int coarsest_level_at_corner(const lod::TileKey& key, bool east, bool north) const;
  int coarsest_level_at(mars::Face face, double u, double v) const;

  // How many levels the finest tile across an edge of a leaf is coarser than it: 0 or 1 (0 also when finer).
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

// Orders tiles along the Morton curve of their face; an inner tile comes before what it contains.
bool curve_less(const lod::TileKey& a, const lod::TileKey& b);

}  // namespace paging
