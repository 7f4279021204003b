// The geometric error of a frame from what is known of its tiles. Pure; no OpenGL.
#pragma once

#include <cstdint>
#include <span>

#include "lod/select.h"
#include "vpe/core/certificate.h"

namespace vpe::gl {

struct CertifiedTile {
  const lod::SelectedTile* tile = nullptr;
  double quantisation_m = 0;  // of its vertices
  double longest_edge_m = 0;
  double camera_to_centre_m = 0;  // from what its positions are relative to
  double deepest_skirt_m = 0;
};

struct FrameOptics {
  double focal_px = 1;
  double near_m = 1;   // nothing is drawn nearer
  double snap_px = 0;  // TileDrawer::snap_px()
  double exaggeration = 1;
};

// Fills the terms of error, exaggeration, tiles_drawn and share_at_data_limit. The bound of a pixel's shift is
// the sum of three terms.
//
// The error of its tile, projected.
//
// Float storage: a vertex v relative to a centre c is off by 2^-24 |v - c| or less, c - camera by 2^-24 of itself,
// and the vertex stage's arithmetic adds a part of |v - camera|. The vertices of the triangle at a point p are
// within its longest edge of p.
//
// snap_px / cos(slope), with the steepest slope of S in the drawn tiles: a point of the meshes, within its
// tile's error of S, that is moved by s pixels in the image, s r / f metres across the ray at range r, has S
// at most s r / f / cos(slope) farther above or below it.
core::Certificate certify(std::span<const CertifiedTile> tiles, const lod::TileTree& tree, int intervals,
                          const FrameOptics& optics);

// Of every pixel of an image: the number of what is drawn there (tile_id.h) and its range, whose relative
// error is at most range_error * (1 + range / nearest range).
struct DrawnPixels {
  std::span<const std::uint32_t> number;
  std::span<const float> range_m;
  double range_error = 0;
};

// Certificate::image_bound_px: the bound above with the ranges at which tiles appear, each of a tile's parts
// by itself. What is seen of a skirt is at most the skirt's depth below the border of its tile.
double bound_in_image(std::span<const CertifiedTile> tiles, const lod::TileTree& tree,
                      const DrawnPixels& pixels, const FrameOptics& optics);

}  // namespace vpe::gl
