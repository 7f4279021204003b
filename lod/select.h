// Selects the tiles to draw for a view, and the mesh of each: one pure function of (options, tree, view).
//
// Selection starts at the six roots. Tiles that cannot be seen are dropped (horizon, frustum). The tile with
// the largest screen-space error is refined until the largest is within the tolerance or the triangles are
// spent. A tile with children is replaced by them, a finest tile by its next mesh. The screen-space error of a
// tile is
//   geometric error (m) * focal length (px)
//   / least distance (m) from the camera to where the tile's surface can be
//   * off-axis magnification (lod/off_axis_magnification.h), if the tile may stand against the sky.
// It is an upper bound of the shift of every pixel that the tile covers, and of the displacement of its outline
// against the sky.
//
// Level control (lod/control.h) changes that. With the metric kError a tile's screen-space error counts
// 2^levels times when the largest is sought and compared with the tolerance. With the metric kDistance the
// error decides nothing: the tile that lacks most levels is refined (of equals the one with the largest error)
// until none lacks any. With both metrics the reported error is the true one. Weights of what a budget takes
// (DegradeWeights) change which tile is refined first, and how far: a tile of weight w is accepted at an error of the
// tolerance times coarsening^w.
//
// Typical usage:
//   SelectOptions options;
//   options.tolerance_px = 1;
//   SelectScratch scratch;
//   Selection selection;
//   select(options, tree, select_view(view), scratch, selection);
//   for (const SelectedTile& tile : selection.tiles) draw(tile.key, tile.variant);
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "cull/frustum.h"
#include "lod/control.h"
#include "lod/off_axis_magnification.h"
#include "lod/tree/tree.h"

namespace lod {

struct SelectOptions {
  // >= 0. Smaller: finer, more triangles; 0: only meshes without any error. Not used with the metric kDistance.
  double tolerance_px = 1.0;
  // A tile beyond this is drawn in place of its children only if those that can be seen are within it. With the
  // tolerance of another, finer selection here, no tile is more than one level coarser than there, unless
  // max_triangles is reached. Infinite: `tolerance_px` alone decides. Not used with the metric kDistance.
  double child_tolerance_px = std::numeric_limits<double>::infinity();
  double exaggeration = 1.0;  // > 0, factor on heights
  // Upper limit of the triangles of the meshes; 0: none. Refining stops before it would be exceeded. Only
  // visible roots, which are the coarsest tiles, may exceed it by themselves.
  std::int64_t max_triangles = 0;
  LevelControl control;
  bool cull_horizon = true;  // false: selects ground behind the planet too, to measure what this test saves
};

// A view as selection needs it.
struct SelectView {
  glm::dvec3 camera_m{0, 0, 0};
  double focal_px = 1.0;  // pixels in the image for a tangent of 1
  cull::Frustum frustum;
  ImagePlane plane;
  CentreOfView centre;
};

// Converts a view. Panoramas have no frustum and no plane; their focal length is the pixels per radian on the
// horizon.
SelectView select_view(const vpe::core::View& view);

struct SelectedTile {
  TileKey key;
  TileTree::Index index = 0;
  int variant = 0;
  double geometric_error_m = 0;       // bound at the selection's exaggeration
  double screen_space_error_px = 0;   // bound; infinite if the camera is within the error of the ground
  double min_distance_m = 0;          // lower bound
  double off_axis_magnification = 1;  // upper bound, >= 1; 1 for tiles that cannot stand against the sky
  // Metric kError: levels by which its error counted more. Metric kDistance: the wanted LOD number
  // (lod/control.h).
  double control = 0;
};

struct Selection {
  std::vector<SelectedTile> tiles;  // disjoint; in Morton order
  double exaggeration = 1;
  // Every visited tile was culled, selected, or replaced by its children.
  int visited = 0;
  int culled_frustum = 0;  // above the horizon, but outside the image
  int culled_horizon = 0;
  int refined = 0;
  std::int64_t triangles = 0;
  double max_geometric_error_m = 0;
  double max_screen_space_error_px = 0;
  bool capped = false;              // the triangles were spent before the metric was satisfied
  std::vector<int> tiles_by_level;  // selected tiles; index 0 = level 0, up to the deepest level selected
};

// Memory that select() reuses. Its former content does not matter.
class SelectScratch {
 private:
  friend class Selector;
  struct Candidate {
    double urgency;
    double geometric_error_m;
    double screen_space_error_px;
    double min_distance_m;
    double off_axis_magnification;
    double chord2;
    double control;
    double degrade_weight = 1;
    TileTree::Index index;
    int variant;
    cull::PlaneMask mask;
  };
  std::vector<Candidate> heap_;
};

// Populates `selection`. The result depends only on the first three arguments; ties are broken by the order of
// the tree. Tiles are disjoint. Every point of the reference surface that is in the image and above the horizon
// of the lowest sphere is in one of them. Throws std::invalid_argument for a camera, focal length or option out
// of range. Use one scratch for each thread.
void select(const SelectOptions& options, const TileTree& tree, const SelectView& view, SelectScratch& scratch,
            Selection& selection);

// Returns a tile drawn with one of its meshes: errors and distance as select() computes them, whether the tile
// is visible or not.
SelectedTile measure_tile(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                          TileTree::Index index, int variant);

// Returns false for a tile that select() would drop because its mesh cannot be seen. Requires arguments that
// select() accepts.
bool may_be_seen(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                 TileTree::Index index);

// Sets triangles, max_geometric_error_m, max_screen_space_error_px and tiles_by_level from the tiles.
void update_totals(const TileTree& tree, Selection& selection);

// Computes the depths of the skirts of a selection: for every tile and each of its edges (by Edge) the distance
// by which a skirt must reach down, radially from the vertices of the border, to leave no gap to the tiles
// across. The depth is 0 where both borders meet exactly or nothing is drawn across.
//
// Borders meet exactly if both tiles are of one level and both have children, or both are full grids, or both
// are finest tiles with the same variant: meshes choose their border posts from the edge, the level and the
// variant alone. Else the two borders are at most the sum of both errors apart. The skirt is that deep times
// highest over lowest radius, since it is straight between vertices. It does not include the rounding of
// vertices to float.
void skirt_depths(const Selection& selection, const TileTree& tree,
                  std::vector<std::array<float, 4>>& depths_m);

}  // namespace lod
