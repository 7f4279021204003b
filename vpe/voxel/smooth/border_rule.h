// The borders of smooth tiles: heights and slopes that both sides of an edge have alike.
//
// Stage of the pipeline (vpe/voxel/smooth/smooth_caster.h): under SmoothTile, which asks for its four edges. An edge belongs
// to the coarser of the tiles beside it. Its heights and slopes follow from posts that every tile beside it has, so that
// patches on both sides end in the same curve: there is no crack.
//
//   height   of a post; within the edge of a coarser tile, that of its curve there
//   along    the slope of the parabola through three posts of the edge. At an end the third post lies in the next tile if
//            all tiles about the corner have one level; else it is the edge's own third one.
//   across   the mean of the slopes on both sides, as of a parabola; over an edge of the cube one of both is turned into
//            the other face's chart
//
// Within the edge of a coarser tile all three are those of its cubic curves. Slopes are metres for each unit of the chart.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lod/tree/tree.h"
#include "paging/surface/surface.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::voxel {

// Describes the ground at a point of a tile's edge, without exaggeration.
struct BorderNode {
  double height_m = 0;  // above the sphere
  double along = 0;     // slope in the direction in which the edge's chart coordinate grows
  double across = 0;    // slope outwards
  double twist = 0;     // slope of `across` along the edge
};

// Derives the edges of tiles. Results depend on the tree and the posts alone. Not synchronised.
class BorderRule {
 public:
  // Provides the posts of a finest tile; throws paging::PlanetError if it cannot be read.
  using Fetch = std::function<std::shared_ptr<const paging::SurfaceTile>(const lod::TileKey&)>;

  // `tree` must outlive this. kBilinear edges have heights alone.
  BorderRule(const lod::TileTree& tree, Fetch fetch, core::RayPatch patch);

  // Returns the nodes of an edge of a finest tile, one for each post, from west to east or from south to north. Reads
  // the tile and those beside the edge. Throws what the provider throws.
  std::vector<BorderNode> edge(const lod::TileKey& key, lod::Edge edge) const;

  // Returns the mixed second derivative by u and v at a corner; 0 where tiles of several levels or faces meet.
  // `column` and `row` are 0 or 1.
  double corner_twist(const lod::TileKey& key, int column, int row) const;

 private:
  // The coarser tile across an edge, and where a tile's edge lies along the edge of that one.
  struct Coarser {
    lod::TileKey key;
    lod::Edge edge;
    bool reversed = false;
    double first = 0;  // position of the tile's post 0, in cells of the coarser one
    double step = 0;   // from post to post, negative if reversed
  };

  const paging::SurfaceTile& tile(const lod::TileKey& key) const;
  // Returns a post of a tile of the tree, or of what lies below it, by its place in the grid of the tile.
  double post(lod::TileKey key, int i, int j) const;
  bool is_finest(const lod::TileKey& key) const;
  bool coarser(const lod::TileKey& key, lod::Edge edge, Coarser& found) const;
  // Returns true if four finest tiles of one level meet at the corner, on at most two faces.
  bool is_regular(const lod::TileKey& key, int column, int row) const;
  double corner_height_m(const lod::TileKey& key, int column, int row) const;
  double end_slope(const lod::TileKey& key, lod::Edge edge, int end) const;
  std::vector<BorderNode> own_edge(const lod::TileKey& key, lod::Edge edge) const;
  BorderNode on_curve(const std::vector<BorderNode>& nodes, const std::vector<double>& lines, double at) const;

  const lod::TileTree& tree_;
  Fetch fetch_;
  bool is_bicubic_;
  mutable std::shared_ptr<const paging::SurfaceTile> last_;
  mutable std::vector<std::shared_ptr<const paging::SurfaceTile>> held_;  // those that were fetched, a few
};

}  // namespace vpe::voxel
