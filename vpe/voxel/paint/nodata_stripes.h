// Tone of the stripes that nodata ground under an image is drawn in.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): the kernel (paint_kernel.cpp) asks for pixels of nodata
// ground, if the image shows imagery.
#pragma once

#include "vpe/voxel/paint/paint_job.h"

namespace vpe::voxel {

// Returns the factor on the image's colour at a pixel of the ground: core::nodata_grey() of its place, over
// core::kMissingImagery. The width of a pixel is taken from the ranges of its neighbours. Compiled once, so
// equal on all instruction sets.
float nodata_tone(const PaintJob& job, int x, int y);

}  // namespace vpe::voxel
