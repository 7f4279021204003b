// The index of a planet's tiles: the bounds and errors that selection needs, without heights or meshes.
//
// Typical usage:
//   const TileTree& tree = planet.tree();
//   const TileInfo& tile = tree.deepest(key);
//   if (tile.has_children) ...
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cull/bounding_region.h"
#include "lod/tree/error_terms.h"
#include "lod/tree/posts.h"
#include "lod/tree/tile_key.h"

namespace lod {

// Describes one mesh with which a tile can be drawn.
struct MeshVariant {
  ErrorTerms terms;  // against the reference surface
  std::uint32_t triangles = 0;
};

// Holds error terms that may be unknown, rounded up to floats to save memory: a planet has millions of tiles.
class StatedTerms {
 public:
  StatedTerms() = default;
  StatedTerms(const ErrorTerms& terms)  // NOLINT(google-explicit-constructor): a plain conversion
      : height_error_m_(up(terms.height_error_m)),
        sagitta_m_(up(terms.sagitta_m)),
        total_m_(up(terms.total_m)) {}

  bool known() const { return total_m_ == total_m_; }
  ErrorTerms terms() const {
    return {static_cast<double>(height_error_m_), static_cast<double>(sagitta_m_),
            static_cast<double>(total_m_)};
  }

 private:
  static float up(double x) {
    const auto rounded = static_cast<float>(x);
    return static_cast<double>(rounded) >= x ? rounded
                                             : std::nextafter(rounded, std::numeric_limits<float>::infinity());
  }
  float height_error_m_ = std::numeric_limits<float>::quiet_NaN();
  float sagitta_m_ = height_error_m_;
  float total_m_ = height_error_m_;
};

// Describes one tile.
struct TileInfo {
  TileKey key;
  double min_height_m = 0;  // the heights of the finest posts in the tile, with its borders, lie in [min, max]
  double max_height_m = 0;
  bool has_children = false;
  // For tiles with children: errors of its own posts drawn as a grid. Unknown if the planet file does not state
  // them.
  StatedTerms posts_terms = {};
  // Meshes from coarser to finer. A tile with children has one; the last of a finest tile is its full grid,
  // error 0.
  std::vector<MeshVariant> variants;
  double steepest_slope = 0;  // upper bound of the tangent of the slope in the tile, without exaggeration
};

// Returns true if a variant is a finest tile's full grid, which is the reference surface at any exaggeration.
inline bool is_full_grid(const TileInfo& tile, int variant) {
  return !tile.has_children && variant + 1 == static_cast<int>(tile.variants.size());
}

// Holds the tiles of a whole planet. Immutable: any number of threads may read it.
class TileTree {
 public:
  using Index = std::uint32_t;

  // Takes tiles in any order and checks them. There must be six roots; each tile has four children or none,
  // each child lies below a tile that states children, and no tile occurs twice. Heights must be finite, above
  // the planet's centre and within the parent's; slopes likewise. Variants must be as in TileInfo. Errors, also
  // those of posts, must not grow from a variant to the next, nor from a tile to its children. Throws
  // std::runtime_error that names the tile and what is wrong. `lowest_radius_m` is a lower bound of the
  // surface's radius that is tighter than that of the tiles; 0: none.
  TileTree(std::vector<TileInfo> tiles, const TileShape& shape, double radius_m, double lowest_radius_m = 0);

  double radius_m() const { return radius_m_; }
  const TileShape& shape() const { return shape_; }

  // The tiles are sorted by level, then in Morton order: the six roots come first, the children of a tile
  // follow each other.
  std::size_t size() const { return tiles_.size(); }
  const TileInfo& operator[](Index tile) const { return tiles_[tile]; }
  std::span<const TileInfo> tiles() const { return tiles_; }

  // Returns the index of the first child; child c is first_child() + c. Expects a tile with children.
  Index first_child(Index tile) const { return first_child_[tile]; }

  // Returns the tile, or nullptr if the planet does not have it.
  const TileInfo* find(const TileKey& key) const;
  // Returns the finest tile that has this key or contains it.
  const TileInfo& deepest(const TileKey& key) const;

  // Returns a region that contains the reference surface over a tile at an exaggeration > 0, and everything
  // within geometric_error_m of it that is not above its highest post. If geometric_error_m bounds the tile's
  // own error, the region contains all meshes of the tile and of the tiles below it.
  cull::BoundingRegion region(Index tile, double exaggeration, double geometric_error_m) const;

  // Returns an upper bound in metres of the radial distance between a mesh of the tile that has these terms and
  // the reference surface, both exaggerated. It is the sum of lod::error_bound() and edge_shift_m(). Never
  // grows from a tile to its children.
  double geometric_error_m(const TileInfo& tile, const ErrorTerms& terms, double exaggeration) const;

  // Returns a bound of how far the exaggerated reference surface differs from the surface over posts that are
  // exaggerated one by one: posts on the edges of coarser neighbours stay on these edges. 0 at exaggeration 1,
  // and if all finest tiles have one level.
  double edge_shift_m(const TileInfo& tile, double exaggeration) const;

  // Returns an upper bound of the tangent of the slope of the reference surface in the tile at an exaggeration.
  // Never grows from a tile to its children, but for edge_shift_m() at finest tiles.
  double steepest_slope(const TileInfo& tile, double exaggeration) const;
  // Returns the same over the whole planet.
  double steepest_slope(double exaggeration) const;

  // Returns the exaggeration at which the lowest post reaches the planet's centre: ground can be drawn at smaller
  // ones only. Infinite if no post lies below the sphere.
  double exaggeration_limit() const;
  // Throws std::invalid_argument for an exaggeration that cannot be drawn. The message names the limit.
  void require_drawable(double exaggeration) const;

  // Returns a lower bound of the radius of the reference surface, with the sagitta of its facets: the occluder
  // for the horizon.
  double lowest_radius_m(double exaggeration) const;

  // Returns the memory that the index holds.
  std::size_t bytes() const { return bytes_; }

 private:
  // Returns the coarsest level of the finest tiles in `tile` that may lie beside coarser ones, or nullopt if
  // there are none.
  std::optional<int> coarsest_beside_coarser(const TileInfo& tile) const;
  Index descend(const TileKey& key) const;

  std::vector<TileInfo> tiles_;
  std::vector<Index> first_child_;
  TileShape shape_;
  double radius_m_;
  std::size_t bytes_ = 0;
  double known_lowest_m_;
  double lowest_height_m_ = 0;
  int coarsest_facets_ = kMaxLevel;  // levels of the coarsest and the finest of the finest tiles
  int finest_facets_ = 0;
};

}  // namespace lod
