// Describes an image to paint for the kernel: everything that is the same for all of its pixels.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): ImagePainter (image_painter.h) fills a PaintJob, and its
// threads call paint_rows() (paint_kernel.cpp) for bands of rows.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "vpe/core/frame.h"
#include "vpe/voxel/cast/pixel_normal.h"
#include "vpe/voxel/paint/paint_tiles.h"
#include "vpe/voxel/paint/ray_rows.h"
#include "vpe/voxel/paint/scale_table.h"

namespace vpe::voxel {

// The pointers belong to ImagePainter and its caller.
struct PaintJob {
  const core::DrawRequest* request = nullptr;
  const paging::TerrainShader* shader = nullptr;
  const paging::ShadingParams* shading = nullptr;
  const ScaleTable* scale = nullptr;  // null without a colour scale
  RayRows rays;
  double radius_m = 0;
  double focal_px = 0;      // rays per radian
  double root_range_m = 0;  // at this range pixels are as wide as the posts of level 0 are apart
  int posts_side = 0;       // lines of a tile's grid
  PaintNeeds needs;         // none with one_colour
  bool one_colour = false;  // all ground has one colour and data: no tile is needed
  glm::dvec3 up{0, 0, 1};   // at the camera
  double camera_radius_m = 0;

  int width = 0;
  int height = 0;
  const float* range_m = nullptr;
  base::Rgb* colour = nullptr;
  const std::uint8_t* wanted = nullptr;  // pixels to paint: those that are not 0; null: all
  const PixelNormal* normals = nullptr;  // null: those of the posts everywhere
};

// Paints rows [begin, end) and returns the number of their nodata pixels. Any thread may call it, with a
// PaintTiles of its own. Throws paging::PlanetError for unreadable tiles.
std::int64_t paint_rows(const PaintJob& job, PaintTiles& tiles, int begin, int end);

}  // namespace vpe::voxel
