// The geometric error of a frame from what is known of its tiles. Pure; no OpenGL.
#pragma once

#include <span>

#include "lod/select.h"
#include "vpe/core/certificate.h"

namespace vpe::gl {

struct CertifiedTile {
  const lod::SelectedTile* tile = nullptr;
  double quantisation_m = 0;  // of its vertices
  double longest_edge_m = 0;
  double eye_to_centre_m = 0;  // from what its positions are relative to
  double steepness = 1;        // 1 / cos of its steepest triangle
};

struct FrameOptics {
  double focal_px = 1;
  double near_m = 1;   // nothing is drawn nearer
  double snap_px = 0;  // TileDrawer::snap_px()
};

// Fills the terms of error, tiles_drawn and share_at_data_limit. The bound of a pixel's shift is the sum of
//   the error of its tile, projected;
//   float storage: a vertex v relative to a centre c is off by 2^-24 |v - c| or less, c - eye by 2^-24 of
//   itself, and the vertex stage's arithmetic adds a part of |v - eye|. The vertices of the triangle at a point
//   p are within its longest edge of p; snap_px times the steepness of the steepest triangle: a point of the
//   meshes that is moved by s pixels in the picture, s r / f metres across the ray at range r, lies at most s r
//   / f / cos(slope) above or below the meshes.
core::Certificate certify(std::span<const CertifiedTile> tiles, const lod::TileTree& tree, int intervals,
                          const FrameOptics& optics);

}  // namespace vpe::gl
