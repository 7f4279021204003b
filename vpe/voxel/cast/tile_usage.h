// The tiles that an image was cast with, and how far they are off.
#pragma once

#include <vector>

#include "lod/tree/tree.h"

namespace vpe::voxel {

// Describes the use of one tile, or of quarters of it.
struct TileUse {
  lod::TileTree::Index tile = 0;
  lod::TileTree::Index source = 0;   // whose posts were cast: the tile itself, or an ancestor in its place
  double min_distance_m = 0;         // lower bound of the distance from the camera to the posts that were cast
  double geometric_error_m = 0;      // bound for what was cast; 0 for the reference surface itself
  double screen_space_error_px = 0;  // the same in the image
};

// Describes all tiles of an image. Tiles are in the order of their indices, each once.
struct TileUsage {
  std::vector<TileUse> tiles;
  std::vector<int> tiles_by_level;  // sources; index 0 = level 0
  // Bound of the distance between what is cast and the reference surface, in the image; 0 if all tiles were
  // the finest.
  double screen_space_error_px = 0;
  double geometric_error_m = 0;  // largest of the tiles
  double steepest_slope = 0;     // bound of the tangent of the slope of the reference surface in the tiles
  int tiles_replaced = 0;        // cast with the posts of an ancestor

  // Merges the usage of another image of nearly the same view. Of a tile in both the larger error counts.
  void add(const TileUsage& other, const lod::TileTree& tree);

  // Multiplies the errors in the image, for an image of other pixels.
  void scale_px(double factor);
};

// Counts the sources and the replaced tiles, and takes the largest errors, of `usage.tiles`.
void update_totals(const lod::TileTree& tree, TileUsage& usage);

}  // namespace vpe::voxel
