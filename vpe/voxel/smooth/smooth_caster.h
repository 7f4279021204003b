// Casts images of the smooth ground of a planet (rays.mode=perturbation).
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): takes RangeCaster's place. The method is that of Vyatkin and Dolgovesov
// 2002 (section 2), with patches in the place of single posts: the screen is divided into squares of 8 x 8 pixels, each goes
// down the tree of tiles and of their blocks, the near half of each first, with a mask of finished pixels, and what it leaves
// are roots on smooth patches. All rays begin in the camera, so that one order of the tree serves all of them.
//
// Typical usage:
//   const SmoothGround ground(caster.surface(), budget_bytes);
//   const SmoothUsage usage = cast_smooth(ground, view, {}, pool, {range_m, normals});
#pragma once

#include <cstdint>
#include <span>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/pixel_normal.h"
#include "vpe/voxel/cast/tile_usage.h"
#include "vpe/voxel/smooth/smooth_ground.h"

namespace vpe::voxel {

// Holds one entry for each pixel of the drawn part, row by row from the top. Those of pixels that are not cast stay.
struct SmoothPixels {
  std::span<float> range_m;                      // core::kSkyRange for the sky
  std::span<PixelNormal> normals = {};           // or empty
  std::span<const std::uint8_t> is_wanted = {};  // pixels to cast: those that are not 0; empty: all
};

// Describes what an image was cast with.
struct SmoothUsage {
  TileUsage tiles;          // those that a ray came near, without errors
  double smoothing_m = 0;   // bound of the distance between the patches and the reference surface over them
  double smoothing_px = 0;  // the same in the image, at the ranges at which the tiles are seen

  void add(const SmoothUsage& other, const lod::TileTree& tree);
};

// Writes the ranges of a view in any projection: of the first point of the ground on each pixel's ray, as
// SmoothGround::cast() has it, rounded to float. Expects a view that check() accepts. Results do not depend on the pool nor
// on earlier images. Throws paging::PlanetError for tiles that cannot be read.
SmoothUsage cast_smooth(const SmoothGround& ground, const core::View& view, const SmoothForm& form,
                        base::ThreadPool& pool, const SmoothPixels& pixels);

}  // namespace vpe::voxel
