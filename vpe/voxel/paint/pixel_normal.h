// The normal of the ground in a pixel, where it is finer than the posts tell.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): cast_smooth() writes them, ImagePainter takes them.
#pragma once

namespace vpe::voxel {

struct PixelNormal {
  float x = 0;  // unit, outward, body-fixed
  float y = 0;
  float z = 0;
  // The share that it has beside the normals between posts: 0 where posts are narrower than a pixel, 1 where they are two
  // pixels apart or more.
  float share = 0;
};

}  // namespace vpe::voxel
