// Which tiles to draw for a view, and with which mesh: one pure function of (options, tree, view).
//
// Starting from the six roots, whatever cannot be seen is dropped (horizon, frustum) and the tile with the
// worst projected error is refined, until the worst is within the tolerance or the triangles are spent. A tile
// with children is replaced by them, a finest tile by its next mesh. The projected error of a tile is
//   error bound (m) * focal length (px) / least distance from the camera to where the tile's surface can be (m)
//   * stretch of the tile's place in the image (lod/off_axis_magnification.h), where the tile may stand against the sky,
// an upper bound of the shift of every pixel that the tile covers, and of how far off in the image its
// outline lies against the sky.
//
// Level control (lod/control.h) shifts that: in rule error a tile's projected error counts 2^levels times when
// the worst tile is sought and compared with the tolerance. In rule hitchner the error decides nothing: the
// tile that lacks most levels is refined (of equals the one with the worst error) until none lacks any. In both
// rules what is reported is the true error.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "cull/frustum.h"
#include "lod/control.h"
#include "lod/off_axis_magnification.h"
#include "lod/tree/tree.h"

namespace lod {

struct SelectOptions {
  double tolerance_px = 1.0;  // >= 0; 0: only meshes without any error. Not used in rule hitchner
  double exaggeration = 1.0;  // > 0; heights are drawn times this
  // Hard cap on the triangles of the meshes, 0 = none. Refining stops before it would be passed; only roots in
  // view, which nothing can be coarser than, may pass it by themselves.
  std::int64_t max_triangles = 0;
  LevelControl control;
  bool cull_horizon = true;  // false: what the planet hides is selected too, to measure what this culler saves
};

struct SelectView {
  glm::dvec3 camera_m{0, 0, 0};
  double focal_px = 1.0;  // pixels of image for a tangent of 1
  cull::Frustum frustum;
  ImagePlane plane;
  CentreOfView centre;
};

// Panoramas: no frustum, no plane, pixels for a radian on the horizon.
SelectView select_view(const vpe::core::View& view);

struct SelectedTile {
  TileKey key;
  TileTree::Index index = 0;
  int variant = 0;
  double geometric_error_m = 0;       // bound at the exaggeration selected for
  double screen_space_error_px = 0;   // projected; infinite where the camera is within the error of the ground
  double min_distance_m = 0;          // lower bound
  double off_axis_magnification = 1;  // upper bound, >= 1; 1 for what cannot stand against the sky
  double control = 0;  // rule error: levels that its error counted more; hitchner: the LOD number wanted
};

struct Selection {
  std::vector<SelectedTile> tiles;  // disjoint; along the Z curve
  double exaggeration = 1;
  // Every visited tile was culled, drawn, or replaced by its children.
  int visited = 0;
  int culled_frustum = 0;  // seen over the horizon, but outside the image
  int culled_horizon = 0;
  int refined = 0;
  std::int64_t triangles = 0;
  double max_geometric_error_m = 0;
  double max_screen_space_error_px = 0;
  bool capped = false;              // the triangles were spent before the rule was met
  std::vector<int> tiles_by_level;  // drawn; index 0 = level 0, as long as the deepest level drawn
};

// Memory that select() uses again. What it held before never matters.
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
    TileTree::Index index;
    int variant;
    cull::PlaneMask mask;
  };
  std::vector<Candidate> heap_;
};

// The result depends on the first three arguments alone; ties are broken by the order of the tree. A tile is
// drawn only if it is in none of the others, and every place of S that is in the image and above the horizon
// of the lowest sphere is in one. Throws std::invalid_argument for a camera, focal length or option out of range.
// Thread rule: one scratch a thread.
void select(const SelectOptions& options, const TileTree& tree, const SelectView& view, SelectScratch& scratch,
            Selection& selection);

// A tile drawn with one of its meshes: errors and distance as select() finds them, whether it can be seen or not.
SelectedTile measure_tile(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                          TileTree::Index index, int variant);

// Sets triangles, max_geometric_error_m, max_screen_space_error_px and tiles_by_level from the tiles.
void update_totals(const TileTree& tree, Selection& selection);

// For every tile of a selection and each of its edges (by Edge) how far a skirt must reach down, radially from
// the vertices of the border, to leave no gap to what is drawn across: 0 where both meet exactly or nothing is
// drawn there. Both meet exactly when they are of one level and both have children, or are both full grids, or
// are both finest tiles with the same variant: meshes choose their border posts from the edge, the level and
// the variant alone. Else the two borders are at most both errors apart, and the skirt is that deep times
// highest over lowest radius, since it is straight between vertices. Rounding of vertices to float is not in
// it.
void skirt_depths(const Selection& selection, const TileTree& tree,
                  std::vector<std::array<float, 4>>& depths_m);

}  // namespace lod
