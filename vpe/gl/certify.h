// Bound of a frame's geometric error, from its tiles. Pure; no OpenGL.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>

#include "lod/mesh/block_errors.h"
#include "lod/select.h"
#include "vpe/core/certificate.h"
#include "vpe/core/view.h"

namespace vpe::gl {

struct CertifiedTile {
  const lod::SelectedTile* tile = nullptr;
  double quantisation_m = 0;      // TileGeometry::quantisation_m
  double longest_edge_m = 0;      // TileGeometry::longest_edge_m
  double camera_to_centre_m = 0;  // distance of the camera from the origin of its positions
  double deepest_skirt_m = 0;
};

struct FrameOptics {
  double focal_px = 1;
  double near_m = 1;   // near plane: nothing is drawn nearer
  double snap_px = 0;  // TileDrawer::snap_px()
  double exaggeration = 1;
  double surface_snap_px =
      std::numeric_limits<double>::infinity();  // the same of surfaces, if that is less: surface_snap_px()
};

// Returns a certificate with the terms of error, exaggeration, tiles_drawn and share_at_data_limit filled in.
//
// The bound of a pixel's shift is the sum of three terms, the last two divided by cos(slope):
// - The screen-space error of its tile.
// - Float storage. A vertex v relative to a centre c is off by 2^-24 |v - c| or less, c - camera by 2^-24 of
//   itself, and the vertex stage's arithmetic adds a part of |v - camera|. The vertices of the triangle at a
//   point p are within its longest edge of p.
// - snap_px.
// The slope is the steepest of the reference surface S in the drawn tiles. A point of the meshes lies within its
// tile's geometric error of S, measured along its radius. Moved by d metres in any direction (s pixels in the
// image are s r / f metres across the ray at range r) it has S at most d / cos(slope) farther above or below it.
//
// The meshes' errors hold everywhere, so the bound is also one for silhouettes: before the point that a pixel
// shows (sky: anywhere) its ray passes no deeper below S, in pixels at that range, than shift_bound_px. What
// stands higher is never missed; what does not may be, and ground far behind it shown in its place.
//
// intervals: of a tile's finest grid.
core::Certificate certify(std::span<const CertifiedTile> tiles, const lod::TileTree& tree, int intervals,
                          const FrameOptics& optics);

// Describes every pixel of an image: the packed ID of what is drawn there (tile_id.h) and its range, whose
// relative error is at most range_error * (1 + range / nearest range).
struct DrawnPixels {
  std::span<const std::uint32_t> id;
  std::span<const float> range_m;
  double range_error = 0;
};

// Returns Certificate::image_bound_px: the bound above with the ranges at which tiles appear, for each of a
// tile's parts separately. Visible parts of a skirt are at most the skirt's depth below the border of its tile. Surfaces are
// moved by no more than surface_snap_px.
double bound_in_image(std::span<const CertifiedTile> tiles, const lod::TileTree& tree,
                      const DrawnPixels& pixels, const FrameOptics& optics);

// Returns the same, closer: what a pixel shows is a point of a mesh moved as above, and by the error of its range. So its
// geometric error is that of the blocks within this reach. A point of a skirt in sight lies between its own border and
// that of the tile across, so the larger of both errors holds for it; the tile across has at most what the skirt is deeper than
// its own tile's error. Looks at the tiles with the largest bounds first, and at no tile that cannot change the result.
//
// errors: of a tile's mesh by block; null: its bound holds everywhere. view: of the image, perspective.
using BlockErrorsOf = std::function<std::shared_ptr<const lod::BlockErrors>(const lod::SelectedTile& tile)>;
double bound_in_image(std::span<const CertifiedTile> tiles, const lod::TileTree& tree,
                      const DrawnPixels& pixels, const FrameOptics& optics, const core::View& view,
                      const BlockErrorsOf& errors);

}  // namespace vpe::gl
