// An image to paint, as the kernels take it: everything that is the same for all of its pixels.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "vpe/core/frame.h"
#include "vpe/voxel/paint/paint_tiles.h"
#include "vpe/voxel/paint/ray_rows.h"
#include "vpe/voxel/paint/scale_table.h"

namespace vpe::voxel {

struct PaintJob {
  const core::DrawRequest* request = nullptr;
  const paging::TerrainShader* painter = nullptr;
  const paging::ShadingParams* shading = nullptr;
  const ScaleTable* scale = nullptr;  // where the look has one
  RayRows rays;
  double radius_m = 0;
  double focal_px = 0;      // rays a radian
  double root_range_m = 0;  // at this range pixels are as wide as the posts of level 0 are apart
  int posts_side = 0;       // lines of a tile's grid
  bool by_point = false;    // ground is left to TerrainShader::colour_at
  bool one_colour = false;  // all ground has the same, and data: no tile is looked at
  glm::dvec3 up{0, 0, 1};   // at the camera
  double camera_radius_m = 0;

  int width = 0;
  int height = 0;
  const float* range_m = nullptr;
  base::Rgb* colour = nullptr;
  float* inverse_depth = nullptr;  // 1 / metres along the camera's axis, 0 = sky; null when not wanted
};

// Paints rows [begin, end) and returns how many of their pixels have no data. Any thread; one for each
// PaintTiles.
std::int64_t paint_rows(const PaintJob& job, PaintTiles& tiles, int begin, int end);

}  // namespace vpe::voxel
