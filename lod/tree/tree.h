// The tiles of a planet with what selection has to know of them, without any of their data.
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

// One mesh that a tile can be drawn with.
struct MeshVariant {
  ErrorTerms terms;  // against S
  std::uint32_t triangles = 0;
};

// Error terms that may be unknown, rounded up to floats: a planet in memory has millions of tiles.
class StatedTerms {
 public:
  StatedTerms() = default;
  StatedTerms(const ErrorTerms& terms)  // NOLINT(google-explicit-constructor): what is stated of them
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

struct TileInfo {
  TileKey key;
  double min_height_m = 0;  // the finest posts in the tile, borders included, lie in [min, max]
  double max_height_m = 0;
  bool has_children = false;
  // With children: its own posts drawn as a grid, against S. Unknown where the planet file does not say.
  StatedTerms posts_terms = {};
  // Coarser to finer. One for a tile with children; the last of a finest tile is its full grid, error 0.
  std::vector<MeshVariant> variants;
  double steepest_slope = 0;  // upper bound of the tangent of slope of S in the tile, not exaggerated
};

// Whether a variant is the finest tile's full grid: S itself, at any exaggeration.
inline bool is_full_grid(const TileInfo& tile, int variant) {
  return !tile.has_children && variant + 1 == static_cast<int>(tile.variants.size());
}

// Immutable index of a whole planet. Any number of threads may read it.
class TileTree {
 public:
  using Index = std::uint32_t;

  // Takes tiles in any order. Throws std::runtime_error that names the tile and what is wrong: six roots,
  // children all four or none and each below a tile that says so, no tile twice; heights finite, above the
  // planet's centre and within the parent's, slopes likewise; variants as told above, errors never growing from
  // a variant to the next nor from a tile to its children, neither those of posts. lowest_radius_m: a lower
  // bound of S's radius that is better known than from the tiles; 0 = none.
  TileTree(std::vector<TileInfo> tiles, const TileShape& shape, double radius_m, double lowest_radius_m = 0);

  double radius_m() const { return radius_m_; }
  const TileShape& shape() const { return shape_; }

  // By level, then along the Z curve: the six roots come first, the children of a tile are neighbours.
  std::size_t size() const { return tiles_.size(); }
  const TileInfo& operator[](Index tile) const { return tiles_[tile]; }
  std::span<const TileInfo> tiles() const { return tiles_; }

  // Child c of a tile that has children is first_child() + c.
  Index first_child(Index tile) const { return first_child_[tile]; }

  // The tile, or nullptr where the planet does not have it.
  const TileInfo* find(const TileKey& key) const;
  // The finest tile that is the key's or contains it.
  const TileInfo& deepest(const TileKey& key) const;

  // Where S lies over a tile at an exaggeration > 0, and everything that is within geometric_error_m of it and nowhere
  // above its highest post: all meshes of the tile and of those below it when geometric_error_m bounds the tile's own.
  cull::BoundingRegion region(Index tile, double exaggeration, double geometric_error_m) const;

  // Upper bound in metres of the radial distance between a mesh of the tile that has these terms and S, both
  // exaggerated: lod::error_bound, and where S is not what each post exaggerated by itself would make, as posts
  // on the edges of coarser neighbours stay on these edges. Never grows from a tile to its children.
  double geometric_error_m(const TileInfo& tile, const ErrorTerms& terms, double exaggeration) const;

  // That second part alone: 0 at exaggeration 1, and where all finest tiles are of one level.
  double edge_shift_m(const TileInfo& tile, double exaggeration) const;

  // No point of S is nearer to the planet's centre: the occluder for the horizon. Sag of the facets included.
  double lowest_radius_m(double exaggeration) const;

  // Memory held, all of it.
  std::size_t bytes() const { return bytes_; }

 private:
  // Level of the coarsest finest tiles that are in a tile and may lie beside coarser ones; nothing: there are none.
  std::optional<int> coarsest_beside_coarser(const TileInfo& tile) const;
  Index descend(const TileKey& key) const;

  std::vector<TileInfo> tiles_;
  std::vector<Index> first_child_;
  TileShape shape_;
  double radius_m_;
  std::size_t bytes_ = 0;
  double known_lowest_m_;
  double lowest_height_m_ = 0;
  int coarsest_facets_ = kMaxLevel;  // level of the coarsest finest tile
  int finest_facets_ = 0;            // and of the finest
};

}  // namespace lod
