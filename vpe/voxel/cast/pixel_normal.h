// Says how the ground in a pixel is lit, where that is finer than the posts tell.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): cast_smooth() and VolumeTerrain::light() write it, ImagePainter takes it.
#pragma once

namespace vpe::voxel {

struct PixelNormal {
  float x = 0;  // unit, outward, body-fixed
  float y = 0;
  float z = 0;
  // The share that it has beside the normals between posts: 0 where posts are narrower than a pixel, 1 where they are two
  // pixels apart or more.
  float share = 0;
  // The share of the sun that is visible, and the share that this has beside that of the posts. With shadows alone.
  float sun = 1;
  float sun_share = 0;
};

}  // namespace vpe::voxel
